// The summary and the table of everything. Headers are buttons: click or Enter sorts.
import { el } from "./dom.js";
import { formatNumber, formatRange } from "./format.js";
import { isNumber, median, range, sortRows } from "./stats.js";

/** Columns of the summary, as far as any run has a value: without truth the errors make room for what is left. */
const kSummary = [
  ["end_error_percent", "End error"],
  ["ate_se3_rmse_m", "Path error"],
  ["rpe_1sweep_trans_rmse_m", "Step error"],
  ["point_error_rms_m", "Point error"],
  ["deskew_error_rms_m", "Deskew error"],
  ["sweep_time_p50_ms", "Time a sweep"],
  ["iterations_mean", "Iterations"],
  ["coverage_percent", "Coverage"],
];

/** What a method says of a metric over its runs: values, median, range, and why there are none. */
export function gather(runs, metric, estimate) {
  const rows = runs.map((run) => {
    const row = run.rows.find((r) => r.metric === metric && (!estimate || r.estimate === estimate));
    return { seed: run.seed, run, row, value: row?.value ?? null };
  });
  const values = rows.map((entry) => entry.value).filter(isNumber);
  const reason = rows.map(({ run, row }) => row?.status ?? (run.status === "ok" ? "n/a: not reported" : `n/a: ${run.status}`))
    .find((status) => status !== "ok");
  return { rows, values, median: median(values), range: range(values), reason: reason ?? "" };
}

export function metricTip(metric) {
  if (!metric) return "";
  const better = metric.lower_is_better ? "Lower is better." : "";
  const alignment = metric.alignment && metric.alignment !== "none needed" ? ` Alignment: ${metric.alignment}.` : "";
  return `${metric.name}\n${metric.meaning}${alignment} ${better}`.trim();
}

function cell(gathered, best, of) {
  if (gathered.median === null) {
    const failed = /^failed/.test(gathered.reason);
    return el("td", { class: "na" }, el("span", { tabindex: "0", "data-tip": gathered.reason || "no value" }, failed ? "failed" : "n/a"));
  }
  const several = gathered.values.length > 1;
  const missing = gathered.rows.length - gathered.values.length;
  const single = gathered.rows.length === 1 ? gathered.rows[0].row : null;
  const interval = several ? gathered.range : isNumber(single?.low) && isNumber(single?.high) ? [single.low, single.high] : null;
  const note = missing > 0 ? `${missing} of ${gathered.rows.length} runs have no value: ${gathered.reason}`
    : gathered.reason.startsWith("ok:") ? gathered.reason.slice(3).trim() : "";
  return el("td", { class: best ? "best" : "" },
    el("span", { class: "number", tabindex: note || best ? "0" : null, "data-tip": [best ? `Best of ${of}.` : "", note].filter(Boolean).join(" ") || null },
      best ? el("i", { class: "lamp", "aria-label": "best" }) : null, formatNumber(gathered.median), missing > 0 ? "*" : ""),
    interval ? el("span", { class: "range" }, formatRange(interval)) : null);
}

function statusCell(runs) {
  const failed = runs.filter((run) => run.status !== "ok");
  const text = failed.length === 0 ? "ok" : failed.length === runs.length ? failed[0].status : `${runs.length - failed.length} of ${runs.length} ok`;
  const why = failed.map((run) => `seed ${run.seed}: ${run.status}${run.message ? ` (${run.message})` : ""}`).join("\n");
  return el("td", { class: "status" },
    el("span", { class: `chip ${failed.length === 0 ? "good" : failed.length === runs.length ? "bad" : "mixed"}`, tabindex: why ? "0" : null, "data-tip": why || null }, text));
}

export function sortButton(label, unit, tip, current, onclick) {
  const arrow = current === null ? "" : current ? " ▲" : " ▼";
  return el("th", { scope: "col", "aria-sort": current === null ? "none" : current ? "ascending" : "descending" },
    el("button", { type: "button", class: "sort", "data-tip": tip || null, onclick }, el("span", {}, label, el("span", { class: "arrow" }, arrow)),
      unit === undefined ? null : el("span", { class: "unit" }, unit || "\u00a0")));
}

/** Columns of `wanted` in which some run has a value, and the others with the reason why none has. */
export function filledColumns(runs, wanted) {
  const shown = [];
  const missing = [];
  for (const [metric, label] of wanted) {
    const rows = runs.flatMap((run) => run.rows.filter((row) => row.metric === metric));
    if (rows.some((row) => isNumber(row.value))) shown.push([metric, label]);
    else if (rows.length) missing.push({ metric, label, reason: rows[0].status });
  }
  return { shown, missing };
}

/** "Path error" -> "path error", but "KITTI rotation" stays. */
const lowered = (label) => (/^.[A-Z]/.test(label) ? label : label[0].toLowerCase() + label.slice(1));

/** "No path error or step error: the recording has no truth." One sentence a reason. */
export function whyMissing(missing) {
  const reasons = new Map();
  for (const { label, reason } of missing) {
    const why = reason.replace(/^(n\/a|failed): /, "");
    reasons.set(why, [...(reasons.get(why) ?? []), lowered(label)]);
  }
  return [...reasons].map(([why, labels]) => `No ${labels.length > 1 ? `${labels.slice(0, -1).join(", ")} or ${labels.at(-1)}` : labels[0]}: ${why}.`).join(" ");
}

export class SummaryTable {
  /** `wanted`: columns as [metric, label]; the summary's, with how the runs ended, when nothing else is said. */
  constructor(state, wanted) {
    this.state = state;
    this.withStatus = !wanted;
    this.open = new Set();
    this.element = el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": "Summary" });
    const { shown, missing } = filledColumns(state.data.runs, wanted ?? kSummary);
    const iterations = wanted ? -1 : shown.findIndex(([metric]) => metric === "iterations_mean");
    if (state.hasTruth && iterations >= 0) shown.splice(iterations, 1);  // there is no room for it, and it is in the table below
    this.columns = shown;
    this.missing = whyMissing(missing);
    this.sort = { column: shown[0]?.[0] ?? "name", ascending: true };
    state.listen((what) => { if (what !== "theme") this.draw(); });
    this.draw();
  }

  draw(focus) {
    const metrics = this.state.data.metrics;
    const rows = this.state.data.estimators.map((name) => {
      const runs = this.state.runs(name);
      return { name, runs, cells: Object.fromEntries(this.columns.map(([metric]) => [metric, gather(runs, metric)])) };
    }).filter((row) => row.runs.length > 0
      && (this.withStatus || this.columns.some(([metric]) => row.cells[metric].median !== null)));
    const { column, ascending } = this.sort;
    const key = (row) => (column === "name" ? row.name : column === "status" ? row.runs.filter((r) => r.status !== "ok").length : row.cells[column]?.median);
    const header = (id, label, unit, tip) => sortButton(label, unit, tip, column === id ? ascending : null, () => {
      this.sort = { column: id, ascending: column === id ? !ascending : true };
      this.draw(id);
    });
    const head = el("tr", {}, header("name", "Estimator", "", "Sort by name"),
      ...this.columns.map(([metric, label]) => header(metric, label, metrics[metric]?.unit, metricTip(metrics[metric]) || metric)),
      this.withStatus ? header("status", "Status", "", "Sort by failed runs") : null);
    const best = Object.fromEntries(this.columns.map(([metric]) => [metric, this.best(rows, metric)]));
    const body = sortRows(rows, key, ascending).flatMap((row) => this.rowsOf(row, best, rows.length));
    this.element.replaceChildren(el("table", { class: "summary" }, el("thead", {}, head), el("tbody", {}, ...body)));
    if (focus) [...this.element.querySelectorAll("th")][["name", ...this.columns.map((c) => c[0]), "status"].indexOf(focus)]?.querySelector("button").focus();
  }

  best(rows, metric) {
    if (!(this.state.data.metrics[metric]?.lower_is_better)) return null;
    const finite = rows.filter((row) => isNumber(row.cells[metric].median));
    if (finite.length < 2) return null;
    return finite.reduce((a, b) => (b.cells[metric].median < a.cells[metric].median ? b : a)).name;
  }

  rowsOf(row, best, count) {
    const several = row.runs.length > 1;
    const open = this.open.has(row.name);
    const name = el("th", { scope: "row" },
      el("span", { class: "name" }, el("i", { class: "dot", style: { background: `var(${this.state.color(row.name)})` } }), row.name),
      several ? el("button", { type: "button", class: "expand", "aria-expanded": open, onclick: () => {
        if (!this.open.delete(row.name)) this.open.add(row.name);
        this.draw();
        [...this.element.querySelectorAll(".expand")].find((b) => b.dataset.name === row.name)?.focus();
      }, "data-name": row.name }, open ? "hide runs" : `${row.runs.length} runs`) : null);
    const main = el("tr", { class: this.state.isVisible(row.name) ? "" : "off" }, name,
      ...this.columns.map(([metric]) => cell(row.cells[metric], best[metric] === row.name, count)), this.withStatus ? statusCell(row.runs) : null);
    if (!several || !open) return [main];
    const seeds = row.runs.map((run) => el("tr", { class: "seed" }, el("th", { scope: "row" }, `seed ${run.seed}`),
      ...this.columns.map(([metric]) => cell(gather([run], metric), false, 0)), this.withStatus ? statusCell([run]) : null));
    return [main, ...seeds];
  }
}

/** Every metric of every estimator: metrics down, estimators across. */
export class FullTable {
  constructor(state) {
    this.state = state;
    this.sort = { column: null, ascending: true };
    this.filter = "";
    this.all = false;  // rows without any value too
    this.body = el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": "All metrics" });
    this.count = el("span", { class: "muted" });
    this.element = el("details", { class: "all" }, el("summary", {}, "All metrics"),
      el("div", { class: "filter" }, el("label", {}, "Filter ", el("input", { type: "search", placeholder: "rpe, deskew, …",
        oninput: (event) => { this.filter = event.target.value.toLowerCase(); this.draw(); } })),
        el("label", {}, el("input", { type: "checkbox", onchange: (event) => { this.all = event.target.checked; this.draw(); } }), "also those without a value"),
        this.count), this.body);
    state.listen((what) => { if (what !== "theme") this.draw(); });
    this.draw();
  }

  rows() {
    const seen = new Map();
    for (const run of this.state.data.runs) {
      for (const row of run.rows) {
        const key = `${row.metric} ${row.estimate}`;
        if (!seen.has(key)) seen.set(key, { metric: row.metric, estimate: row.estimate, unit: row.unit, order: seen.size });
      }
    }
    const twice = new Set([...seen.values()].map((r) => r.metric).filter((m, i, all) => all.indexOf(m) !== i));
    return [...seen.values()].map((row) => ({
      ...row, label: twice.has(row.metric) ? `${row.metric} (${row.estimate})` : row.metric,
      cells: Object.fromEntries(this.state.data.estimators.map((name) => [name, gather(this.state.runs(name), row.metric, row.estimate)])),
    }));
  }

  draw(focus) {
    const { column, ascending } = this.sort;
    const estimators = this.state.data.estimators.filter((name) => this.state.isVisible(name));
    const header = (id, label, unit, tip) => sortButton(label, unit, tip, column === id ? ascending : null, () => {
      this.sort = { column: id, ascending: column === id ? !ascending : true };
      this.draw(id);
    });
    const all = this.rows();
    const words = this.filter.split(/\s+/).filter(Boolean);
    const meaning = (row) => `${row.label} ${this.state.data.metrics[row.metric]?.meaning ?? ""}`.toLowerCase();
    const found = all.filter((row) => words.every((word) => meaning(row).includes(word)));
    const filled = found.filter((row) => estimators.some((name) => isNumber(row.cells[name].median)));
    const shown = this.all ? found : filled;
    const key = (row) => (column === null ? row.order : column === "metric" ? row.label : column === "unit" ? row.unit : row.cells[column]?.median);
    const best = (row) => {
      const finite = estimators.filter((name) => isNumber(row.cells[name].median));
      if (!this.state.data.metrics[row.metric]?.lower_is_better || finite.length < 2) return null;
      return finite.reduce((a, b) => (row.cells[b].median < row.cells[a].median ? b : a));
    };
    this.count.textContent = `${shown.length} of ${all.length}${found.length > shown.length ? `; ${found.length - shown.length} have no value` : ""}`;
    const body = sortRows(shown, key, ascending).map((row) => {
      const winner = best(row);
      return el("tr", {}, el("th", { scope: "row" }, el("code", { tabindex: "0", "data-tip": metricTip(this.state.data.metrics[row.metric]) || null }, row.label)),
        el("td", { class: "unit-cell" }, row.unit), ...estimators.map((name) => cell(row.cells[name], winner === name, estimators.length)));
    });
    const head = el("tr", {}, header("metric", "Metric", undefined, "Sort by name"), header("unit", "Unit", undefined, "Sort by unit"),
      ...estimators.map((name) => header(name, name, undefined, `Sort by ${name}`)));
    this.body.replaceChildren(el("table", { class: "full" }, el("thead", {}, head), el("tbody", {}, ...body)));
    if (focus) this.body.querySelectorAll("th button")[["metric", "unit", ...estimators].indexOf(focus)]?.focus();
  }
}
