// Which figure shows which series, and the one sentence on how to read it.
import { el } from "./dom.js";
import { combine } from "./stats.js";
import { Chart } from "./plot.js";

/** Lines of one series name over the visible estimators and the chosen seeds. */
export function linesOf(state, name, keepBand) {
  const lines = [];
  for (const estimator of state.data.estimators) {
    if (!state.isVisible(estimator)) continue;
    const series = combine(state.runs(estimator).map((run) => run.series[name]));
    if (!series) continue;
    const band = series.low && (keepBand || series.seeds > 1);
    lines.push({ ...series, name: estimator, color: state.color(estimator), low: band ? series.low : undefined, high: band ? series.high : undefined });
  }
  return lines;
}

/** Lines of a series of the truth, which all estimators share. */
export function truthLines(state, name) {
  const seeds = state.seed === "all" ? state.data.seeds : [state.seed];
  const series = combine(seeds.map((seed) => state.data.truth[String(seed)]?.[name]));
  return series ? [{ ...series, name: "truth", color: "--ink", low: undefined, high: undefined }] : [];
}

export function labelsOf(data, name) {
  const owner = data.runs.map((run) => run.series[name]).find(Boolean)
    ?? Object.values(data.truth).map((series) => series[name]).find(Boolean);
  return owner ? [owner.x_label, owner.y_label] : null;
}

/** A chart that fills itself when it comes near the window, and again when the reader chooses otherwise. */
export function filledChart(state, options, lines) {
  const made = new Chart({ height: 250, ...options });
  let near = false;
  const fill = () => { if (near) made.setLines(lines()); };
  state.listen(fill);
  made.fill = fill;
  whenNear(made.element, () => { near = true; fill(); });
  return made;
}

export function chart(state, name, options = {}) {
  const labels = labelsOf(state.data, name);
  if (!labels) return null;
  return filledChart(state, { xLabel: labels[0], yLabel: labels[1], ...options },
    () => (options.truth ? truthLines(state, name) : linesOf(state, name, options.band)));
}

/** Calls once when the element comes near the window, or before the page is printed. */
function whenNear(element, action) {
  const observer = new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) run(); }, { rootMargin: "900px 0px" });
  const run = () => {
    observer.disconnect();
    window.removeEventListener("beforeprint", run);
    action();
  };
  observer.observe(element);
  window.addEventListener("beforeprint", run);
}

let count = 0;
export function figure(title, reading, ...content) {
  count += 1;
  return el("figure", {}, el("h3", {}, el("span", { class: "fig" }, `Fig. ${count}`), title), ...content,
    el("figcaption", {}, el("span", {}, reading)));
}

/** Figures side by side where there is room; nothing where there are none. */
export function pair(...figures) {
  const filled = figures.filter(Boolean);
  return filled.length ? el("div", { class: "pair" }, ...filled) : null;
}

/** Buttons of which one is pressed. choices: [[value, label]]. */
export function segments(name, choices, chosen, choose) {
  const group = el("div", { class: "segments", role: "group", "aria-label": name });
  for (const [value, label] of choices) {
    group.append(el("button", { type: "button", "aria-pressed": value === chosen, onclick: (event) => {
      for (const other of group.children) other.setAttribute("aria-pressed", other === event.currentTarget);
      choose(value);
    } }, label));
  }
  return group;
}
