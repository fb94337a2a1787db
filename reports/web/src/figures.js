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
function truthLines(state, name) {
  const seeds = state.seed === "all" ? state.data.seeds : [state.seed];
  const series = combine(seeds.map((seed) => state.data.truth[String(seed)]?.[name]));
  return series ? [{ ...series, name: "truth", color: "--ink", low: undefined, high: undefined }] : [];
}

export function labelsOf(data, name) {
  const owner = data.runs.map((run) => run.series[name]).find(Boolean)
    ?? Object.values(data.truth).map((series) => series[name]).find(Boolean);
  return owner ? [owner.x_label, owner.y_label] : null;
}

export function chart(state, name, options = {}) {
  const labels = labelsOf(state.data, name);
  if (!labels) return null;
  const made = new Chart({ xLabel: labels[0], yLabel: labels[1], height: 250, ...options });
  const fill = () => made.setLines(options.truth ? truthLines(state, name) : linesOf(state, name, options.band));
  state.listen(fill);
  made.ready = fill;
  return made;
}

let count = 0;
export function figure(title, reading, ...content) {
  count += 1;
  return el("figure", {}, el("h3", {}, el("span", { class: "fig" }, `Fig. ${count}`), title), ...content,
    el("figcaption", {}, el("span", {}, reading)));
}
