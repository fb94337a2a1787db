// A small way to write elements. Text always goes in as text, never as markup.

export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null) continue;
    if (name.startsWith("aria-")) node.setAttribute(name, value);
    else if (value === false) continue;
    else if (name === "class") node.className = value;
    else if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "style") for (const [key, text] of Object.entries(value)) node.style.setProperty(key, text);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

export const cssColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** One tooltip for the page: any element with data-tip shows it on hover and on keyboard focus. */
export function installTooltip() {
  const tip = el("div", { class: "tip", role: "tooltip", id: "tip", hidden: true });
  document.body.append(tip);
  const show = (target) => {
    tip.textContent = target.dataset.tip;
    tip.hidden = false;
    const box = target.getBoundingClientRect();
    const width = Math.min(300, window.innerWidth - 16);
    tip.style.maxWidth = `${width}px`;
    const left = Math.min(Math.max(8, box.left), window.innerWidth - tip.offsetWidth - 8);
    const above = box.bottom + tip.offsetHeight + 12 > window.innerHeight;
    tip.style.left = `${left}px`;
    tip.style.top = `${above ? box.top - tip.offsetHeight - 6 : box.bottom + 6}px`;
    target.setAttribute("aria-describedby", "tip");
  };
  const hide = (target) => {
    tip.hidden = true;
    target?.removeAttribute?.("aria-describedby");
  };
  const target = (event) => event.target.closest?.("[data-tip]");
  for (const [enter, leave] of [["mouseover", "mouseout"], ["focusin", "focusout"]]) {
    document.addEventListener(enter, (event) => { if (target(event)) show(target(event)); });
    document.addEventListener(leave, (event) => { if (target(event)) hide(target(event)); });
  }
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
  window.addEventListener("scroll", () => { tip.hidden = true; }, { passive: true });
}
