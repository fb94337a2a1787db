// Light, dark, or as the system says. "#theme=dark" in the address fixes it for pictures and prints.
import { el } from "./dom.js";

const kKey = "tarmac-report-theme";

function remembered() {
  const fromAddress = /theme=(light|dark)/.exec(location.hash)?.[1];
  if (fromAddress) return fromAddress;
  try {
    return localStorage.getItem(kKey) ?? "auto";
  } catch {
    return "auto";  // storage may be closed to files
  }
}

export function applyTheme(choice = remembered()) {
  if (choice === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = choice;
  return choice;
}

export function themeSwitch(onChange) {
  const choices = [["auto", "Auto"], ["light", "Light"], ["dark", "Dark"]];
  const group = el("div", { class: "segments", role: "group", "aria-label": "Colours of the page" });
  const mark = (chosen) => {
    for (const button of group.children) button.setAttribute("aria-pressed", button.dataset.value === chosen);
  };
  for (const [value, label] of choices) {
    group.append(el("button", {
      type: "button", "data-value": value,
      onclick: () => {
        try {
          localStorage.setItem(kKey, value);
        } catch { /* the choice then lasts as long as the page */ }
        mark(applyTheme(value));
        onChange();
      },
    }, label));
  }
  mark(remembered());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", onChange);
  return group;
}
