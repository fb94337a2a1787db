// Rows of a comparison: what changed most, and tables of all. Pure functions first: tested by node.
import { placeOnAxis, ratioAxis } from "./comparison.js";
import { el } from "./dom.js";
import { formatNumber } from "./format.js";
import { isNumber, sortRows } from "./stats.js";
import { metricTip, sortButton } from "./tables.js";

/** The farthest that an axis of ratios reaches: beyond it a mark points outwards. */
const kReach = 1000;

export const isSignificant = (row) => ["better", "worse", "different"].includes(row.verdict);

/** How far a ratio is from 1, either way; null where there is none. */
export const change = (row) => (isNumber(row.ratio) && row.ratio > 0 ? Math.abs(Math.log(row.ratio)) : null);

/** Colour of a row: only what is more than chance has one. */
export function tone(row) {
  return { better: "good", worse: "bad", different: "mixed" }[row.verdict] ?? "plain";
}

/** Significant rows with the largest change first, then the largest of the rest; costs apart. */
export function largestChanges(rows, most, mostOthers) {
  const own = rows.filter((row) => !row.cost);
  const significant = sortRows(own.filter(isSignificant), change, false);
  const others = sortRows(own.filter((row) => row.verdict === "no_difference"), change, false);
  return { significant: significant.slice(0, most), others: others.slice(0, mostOthers), more: Math.max(0, significant.length - most) };
}

/** "slalom · kiss-icp"; of two methods the case alone, which is all that differs from row to row. */
export const whereOf = (row) => (row.a === row.b ? `${row.case} · ${row.a}` : row.case);

/** "+12 %", "× 25" */
export function changeText(ratio) {
  if (!isNumber(ratio)) return "n/a";
  if (ratio >= 10 || ratio <= 0.01) return `× ${formatNumber(ratio)}`;
  const percent = 100 * (ratio - 1);
  const digits = Math.abs(percent) < 0.1 ? 2 : Math.abs(percent) < 10 ? 1 : 0;
  const text = Math.abs(percent).toFixed(digits);
  return `${Number(text) === 0 ? "±" : percent < 0 ? "−" : "+"}${text} %`;
}

/** p as people read it: nobody needs the digits of a small one. */
export function formatP(p) {
  if (!isNumber(p)) return "n/a";
  return p < 1e-4 ? "< 0.0001" : formatNumber(p, 2);
}

/** Rows that hold all of the words. */
export function matching(rows, filter, metrics = {}) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  return rows.filter((row) => {
    const text = `${row.metric} ${row.case} ${row.a} ${row.b} ${row.words} ${metrics[row.metric]?.meaning ?? ""}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
}

export function bar(axis, row) {
  const at = (ratio) => `${placeOnAxis(axis, ratio)}%`;
  const known = isNumber(row.low) && isNumber(row.high);
  const beyond = row.ratio > axis.high || row.ratio < axis.low;
  return el("span", { class: `interval ${tone(row)}`, role: "img",
    "aria-label": isNumber(row.ratio) ? `ratio ${formatNumber(row.ratio)}${known ? `, 95 % interval ${formatNumber(row.low)} to ${formatNumber(row.high)}` : ", no interval"}` : "no ratio" },
  el("i", { class: "one", style: { left: at(1) } }),
  known ? el("i", { class: "span", style: { left: at(row.low), right: `${100 - placeOnAxis(axis, row.high)}%` } }) : null,
  isNumber(row.ratio) ? el("i", { class: `mid${beyond ? ` beyond ${row.ratio > 1 ? "right" : "left"}` : ""}`, style: { left: at(row.ratio) } }) : null);
}

/** Ticks with room between them (in percent of the axis), 1 first. */
export function sparseTicks(axis, room) {
  const kept = [];
  for (const tick of sortRows(axis.ticks, (value) => Math.abs(Math.log(value)), true).sort((a, b) => (a === 1 ? -1 : b === 1 ? 1 : 0))) {
    if (kept.every((other) => Math.abs(placeOnAxis(axis, other) - placeOnAxis(axis, tick)) >= room)) kept.push(tick);
  }
  return kept.sort((a, b) => a - b);
}

function ticks(axis, room = 0) {
  return el("span", { class: "interval ticks", "aria-hidden": "true" },
    ...sparseTicks(axis, room).map((tick) => el("span", { style: { left: `${placeOnAxis(axis, tick)}%` } }, String(tick))));
}

/** Ratios with their intervals, one under the other. */
export function forest(data, shown) {
  const all = [...shown.significant, ...shown.others];
  const axis = ratioAxis(all, kReach);
  const line = (row) => el("div", { class: "forest-row" },
    el("span", { class: "forest-name" },
      el("span", { class: "metric", tabindex: "0", "data-tip": metricTip(data.metrics[row.metric]) || null }, row.metric),
      el("span", { class: "muted where" }, whereOf(row))),
    bar(axis, row),
    el("span", { class: "forest-value" },
      el("strong", { class: `tone ${tone(row)}` }, changeText(row.ratio)),
      el("span", { class: "range" }, `${formatNumber(row.low)} to ${formatNumber(row.high)}`)));
  return el("div", { class: "forest" },
    el("div", { class: "forest-row head" }, el("span", {}), ticks(axis), el("span", { class: "muted" }, "B against A")),
    ...shown.significant.map(line),
    shown.others.length ? el("p", { class: "forest-rest muted" }, shown.significant.length ? "Not more than chance, the largest of them:" : "None of these is more than chance:") : null,
    ...shown.others.map(line));
}

const kVerdicts = ["worse", "better", "different", "no_difference", "too_few", "no_ratio", "identical"];

/** All rows of a kind: sorted by any column, filtered by words. */
export class RowTable {
  constructor(data, rows, { label, filter = true } = {}) {
    this.data = data;
    this.rows = rows;
    this.words = "";
    this.onlySignificant = false;
    this.sort = { column: "verdict", ascending: true };
    this.withWhere = new Set(rows.map(whereOf)).size > 1;
    this.body = el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": label });
    this.count = el("span", { class: "muted" });
    const significant = rows.filter(isSignificant).length;
    this.element = el("div", {}, filter ? el("div", { class: "filter" },
      el("label", {}, "Filter ", el("input", { type: "search", placeholder: "deskew, kiss, worse, …",
        oninput: (event) => { this.words = event.target.value; this.draw(); } })),
      significant ? el("label", {}, el("input", { type: "checkbox", onchange: (event) => { this.onlySignificant = event.target.checked; this.draw(); } }), "only what is more than chance") : null,
      this.count) : null, this.body);
    this.draw();
  }

  draw(focus) {
    const { data } = this;
    const found = matching(this.rows, this.words, data.metrics).filter((row) => !this.onlySignificant || isSignificant(row));
    this.count.textContent = `${found.length} of ${this.rows.length}`;
    const axis = ratioAxis(found.filter((row) => isNumber(row.low)), kReach);
    const keys = {
      metric: (row) => row.metric, where: (row) => whereOf(row), a: (row) => row.a_median, b: (row) => row.b_median, ratio: (row) => row.ratio,
      better: (row) => row.b_better / row.seeds, p: (row) => row.p_adjusted, verdict: (row) => kVerdicts.indexOf(row.verdict) - Math.min(0.99, change(row) ?? 0) ,
    };
    const columns = ["metric", ...(this.withWhere ? ["where"] : []), "a", "b", "ratio", "better", "p", "verdict"];
    const { column, ascending } = this.sort;
    const header = (id, label, unit, tip) => sortButton(label, unit, tip, column === id ? ascending : null, () => {
      this.sort = { column: id, ascending: column === id ? !ascending : true };
      this.draw(id);
    });
    const head = el("tr", {}, header("metric", "Metric", undefined, "Sort by metric"),
      this.withWhere ? header("where", "Where", undefined, "Sort by case and method") : null,
      header("a", "A", undefined, `${data.a.label}: median over the seeds that both have`),
      header("b", "B", undefined, `${data.b.label}: median over the seeds that both have`),
      header("ratio", "B / A", undefined, "Geometric mean over the seeds of B's value over A's; beside it the 95 % interval (Student's, of the logarithm)"),
      el("th", { scope: "col", class: "interval-head" }, ticks(axis, 22)),
      header("better", "B better on", undefined, "On how many of the seeds B's value is the better one (the lower one, where neither way is better)"),
      header("p", "Adjusted p", undefined, "By Holm's rule over all rows that are judged together: below 0.05 is called a difference"),
      header("verdict", "Difference", undefined, "Sort by verdict"));
    const body = sortRows(found, keys[column], ascending).map((row) => this.rowOf(row, axis));
    this.body.replaceChildren(el("table", { class: `comparison changes${this.withWhere ? " with-where" : ""}` }, el("thead", {}, head), el("tbody", {}, ...body)));
    if (focus) this.body.querySelectorAll("th button")[columns.indexOf(focus)]?.focus();
  }

  rowOf(row, axis) {
    const unit = row.unit && row.unit !== "1" ? ` ${row.unit}` : "";
    const value = (number) => [formatNumber(number), el("span", { class: "unit-cell" }, unit)];
    const estimate = row.estimate === "causal" ? "" : ` (${row.estimate})`;
    return el("tr", {}, el("th", { scope: "row" }, el("code", { tabindex: "0", "data-tip": metricTip(this.data.metrics[row.metric]) || null }, row.metric),
      el("span", { class: "muted" }, estimate, row.magnitude ? " (size)" : "")),
    this.withWhere ? el("td", { class: "where-cell" }, whereOf(row)) : null,
    el("td", {}, ...value(row.a_median)), el("td", {}, ...value(row.b_median)),
    el("td", {}, formatNumber(row.ratio), isNumber(row.low) ? el("span", { class: "range" }, `${formatNumber(row.low)} to ${formatNumber(row.high)}`) : null),
    el("td", { class: "interval-cell" }, bar(axis, row)),
    el("td", {}, `${row.b_better} of ${row.seeds}`),
    el("td", {}, formatP(row.p_adjusted)),
    el("td", {}, el("span", { class: `chip ${tone(row)}`, tabindex: row.words === "not settled" ? "0" : null, "data-tip": row.words === "not settled"
      ? `By itself this row would be significant (p = ${formatP(row.p)}), but not among all rows that were looked at.` : null }, row.words)));
  }
}
