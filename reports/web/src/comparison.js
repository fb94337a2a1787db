// Two methods over the same seeds: ratio, interval, and whether the difference is more than chance.
import { el } from "./dom.js";
import { formatNumber } from "./format.js";
import { isNumber, sortRows } from "./stats.js";
import { gather, metricTip, sortButton } from "./tables.js";

const kLabels = {
  end_error_percent: "End error", ate_se3_rmse_m: "Path error", kitti_trans_percent: "KITTI error", rpe_1sweep_trans_rmse_m: "Step error",
  point_error_rms_m: "Point error", deskew_error_rms_m: "Deskew error", deskew_error_braking_rms_m: "Deskew error, braking", drift_50m_yaw_rms_deg: "Yaw drift over 50 m",
};

/** Whom to compare with at first: the method that ends nearest to the truth among those that are compared. */
export function bestReference(data) {
  const compared = data.estimators.filter((name) => data.comparisons.some((c) => c.b === name));
  const end = (name) => gather(data.runs.filter((run) => run.estimator === name), "end_error_percent").median;
  return sortRows(compared, end, true)[0];
}

/** Ends of a logarithmic axis that holds 1 and, as far as a factor of `most` goes, all intervals. */
export function ratioAxis(comparisons, most = 20) {
  const ends = comparisons.flatMap((c) => [c.low, c.high, c.ratio]).filter((value) => isNumber(value) && value > 0);
  const reach = Math.min(most, Math.max(1.25, ...ends.map((value) => Math.max(value, 1 / value)))) * 1.08;
  const steps = reach > 60 ? [1e-3, 1e-2, 0.1, 1, 10, 100, 1000] : reach > 6 ? [0.1, 0.2, 0.5, 1, 2, 5, 10] : reach > 2.4 ? [0.2, 0.5, 1, 2, 5] : [0.5, 0.8, 1, 1.25, 2];
  return { low: 1 / reach, high: reach, ticks: steps.filter((tick) => tick > 1 / reach && tick < reach) };
}

/** Place of a ratio on the axis, 0 to 100; beyond the ends it stays at them. */
export function placeOnAxis(axis, ratio) {
  const share = Math.log(ratio / axis.low) / Math.log(axis.high / axis.low);
  return 100 * Math.min(1, Math.max(0, share));
}

/** Words and tone of a comparison. What clears 1 by its own interval but not once all pairs are counted says so. */
export function judged(c) {
  if (c.difference === "not_significant" && c.p < 0.05) return ["not settled: several pairs", "plain"];
  if (c.difference === "too_few") return [`too few seeds (${c.pairs})`, "plain"];
  return kDifferences[c.difference];
}

export const kDifferences = {
  lower: ["lower", "good"], higher: ["higher", "bad"],
  not_significant: ["no significant difference", "plain"], too_few: ["too few seeds", "plain"],
};

function bar(axis, c) {
  const significant = c.difference === "lower" || c.difference === "higher";
  const at = (ratio) => `${placeOnAxis(axis, ratio)}%`;
  const known = isNumber(c.low) && isNumber(c.high);
  return el("span", { class: `interval ${significant ? kDifferences[c.difference][1] : "plain"}`, role: "img",
    "aria-label": known ? `ratio ${formatNumber(c.ratio)}, 95 % interval ${formatNumber(c.low)} to ${formatNumber(c.high)}` : `ratio ${formatNumber(c.ratio)}, no interval` },
  el("i", { class: "one", style: { left: at(1) } }),
  known ? el("i", { class: "span", style: { left: at(c.low), right: `${100 - placeOnAxis(axis, c.high)}%` } }) : null,
  el("i", { class: "mid", style: { left: at(c.ratio) } }));
}

export class ComparisonTable {
  constructor(state) {
    this.state = state;
    this.reference = bestReference(state.data);
    this.sort = { column: null, ascending: true };
    this.body = el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": "Comparison over seeds" });
    const names = state.data.estimators.filter((name) => state.data.comparisons.some((c) => c.b === name));
    this.element = el("div", {},
      el("div", { class: "filter" }, el("label", {}, "Compared with ",
        el("select", { onchange: (event) => { this.reference = event.target.value; this.draw(); } },
          ...names.map((name) => el("option", { value: name, selected: name === this.reference }, name))))),
      this.body);
    state.listen((what) => { if (what === "visible") this.draw(); });
    this.draw();
  }

  draw(focus) {
    const { data } = this.state;
    const all = data.comparisons.filter((c) => c.b === this.reference);
    const rows = all.filter((c) => this.state.isVisible(c.a));
    const axis = ratioAxis(all);
    const keys = { metric: (c) => data.metrics[c.metric] ? kLabels[c.metric] : c.metric, a: (c) => c.a, ratio: (c) => c.ratio,
      lower: (c) => c.a_lower / c.pairs, verdict: (c) => Object.keys(kDifferences).indexOf(c.difference) };
    const { column, ascending } = this.sort;
    const header = (id, label, tip) => sortButton(label, undefined, tip, column === id ? ascending : null, () => {
      this.sort = { column: id, ascending: column === id ? !ascending : true };
      this.draw(id);
    });
    const ticks = el("th", { scope: "col", class: "interval-head" }, el("span", { class: "interval ticks", "aria-hidden": "true" },
      ...axis.ticks.map((tick) => el("span", { style: { left: `${placeOnAxis(axis, tick)}%` } }, String(tick)))));
    const head = el("tr", {}, header("metric", "Metric", "Sort by metric"), header("a", "Method", "Sort by method"),
      header("ratio", `Times ${this.reference}'s`, "Geometric mean over the seeds of this method's value over the reference's; below it the 95 % interval (Student's, of the logarithm)"),
      ticks, header("lower", "Lower on", "On how many of the seeds that both finished the method's value is the lower one"),
      header("verdict", "Difference", "Significant at 5 %, shared out over all pairs of methods by Holm's rule"));
    const sorted = column === null ? rows : sortRows(rows, keys[column], ascending);
    const body = sorted.map((c) => {
      const [words, tone] = judged(c);
      return el("tr", {}, el("th", { scope: "row" }, el("span", { tabindex: "0", "data-tip": metricTip(data.metrics[c.metric]) || null }, kLabels[c.metric] ?? c.metric)),
        el("td", { class: "method" }, el("i", { class: "dot", style: { background: `var(${this.state.color(c.a)})` } }), c.a),
        el("td", {}, formatNumber(c.ratio), isNumber(c.low) ? el("span", { class: "range" }, `${formatNumber(c.low)} to ${formatNumber(c.high)}`) : null),
        el("td", { class: "interval-cell" }, bar(axis, c)),
        el("td", {}, `${c.a_lower} of ${c.pairs}`),
        el("td", {}, el("span", { class: `chip ${tone}` }, words)));
    });
    this.body.replaceChildren(el("table", { class: "comparison" }, el("thead", {}, head), el("tbody", {}, ...body)));
    if (focus) this.body.querySelectorAll("th button")[["metric", "a", "ratio", "lower", "verdict"].indexOf(focus)]?.focus();
  }
}

export function comparison(state) {
  if (!state.data.comparisons?.length) return null;
  return [new ComparisonTable(state).element,
    el("p", { class: "reading" }, "Each bar is the 95 % interval of a method's value over the reference's on the same seeds, on a logarithmic axis: left of the line at 1 the method's value is the lower one, and only coloured bars are more than chance.",
      " (Several pairs of methods are several chances to be wrong: by Holm's rule a bar has to clear the line by more than its own ends say.)")];
}
