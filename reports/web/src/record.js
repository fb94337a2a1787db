// How the runs ended, and where the figures come from.
import { el } from "./dom.js";
import { formatRange } from "./format.js";
import { range } from "./stats.js";

/** Runs that ended alike, told once: [{estimator, status, message, seeds, logs}]. */
export function groupFailures(runs) {
  const groups = new Map();
  for (const run of runs.filter((entry) => entry.status !== "ok")) {
    const key = JSON.stringify([run.estimator, run.status, run.message]);
    if (!groups.has(key)) groups.set(key, { ...run, seeds: [], logs: [] });
    groups.get(key).seeds.push(run.seed);
    groups.get(key).logs.push(run.log);
  }
  return [...groups.values()];
}

function failure(group, manySeeds) {
  const who = manySeeds ? `${group.estimator}, seed${group.seeds.length > 1 ? "s" : ""} ${group.seeds.join(", ")}` : group.estimator;
  return el("li", {}, el("span", { class: "chip bad" }, group.status), el("strong", {}, who),
    el("span", {}, group.message || "no message"),
    el("span", { class: "muted" }, "log: ", el("code", {}, group.logs[0]), group.logs.length > 1 ? ` and ${group.logs.length - 1} more` : ""));
}

export function outcome(state) {
  const { runs, seeds, estimators } = state.data;
  const finished = runs.filter((run) => run.status === "ok");
  const content = [];
  const groups = groupFailures(runs);
  if (groups.length) content.push(el("ul", { class: "outcomes" }, ...groups.map((group) => failure(group, seeds.length > 1))));
  content.push(el("p", {}, finished.length === runs.length ? (runs.length === 1 ? "The run finished." : `All ${runs.length} runs finished.`)
    : `${finished.length} of ${runs.length} runs finished.`));
  const partial = estimators.map((name) => [name, range(finished.filter((run) => run.estimator === name).map((run) => 100 * run.coverage))])
    .filter(([, shares]) => shares && shares[0] < 99.95);
  if (partial.length) {
    content.push(el("p", { class: "muted" }, "Not every sweep is scored: ", partial.map(([name, shares]) => `${name} ${formatRange(shares)} %`).join("; "),
      ". The rest are sweeps that the method itself calls initialising or lost, or that the truth does not cover."));
  }
  return content;
}

function flatten(value, path, out) {
  if (value !== null && typeof value === "object" && !Array.isArray(value)) {
    for (const [key, inner] of Object.entries(value)) flatten(inner, path ? `${path}.${key}` : key, out);
  } else if (Array.isArray(value) && value.some((entry) => entry !== null && typeof entry === "object")) {
    value.forEach((inner, i) => flatten(inner, `${path}[${i}]`, out));
  } else out.push([path, Array.isArray(value) ? value.join(", ") : String(value)]);
  return out;
}

/** The text keeps the order in which it was written; what is no JSON is shown as it is. */
function parsed(text) {
  try {
    const content = JSON.parse(text);
    return content !== null && typeof content === "object" ? content : null;
  } catch {
    return null;
  }
}

function copyButton(text) {
  const button = el("button", { type: "button", onclick: async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(button.parentElement.querySelector("code"));
      button.textContent = "Press Ctrl+C";
    }
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  } }, "Copy");
  return button;
}

/** "{a: {b: 1}}" as rows [path, value]; a value of several lines (options) gives a row a line. */
function lines(text) {
  const rows = flatten(parsed(text) ?? {}, "", []);
  return rows.flatMap(([key, value]) => {
    if (!value.includes("\n")) return [[key, value]];
    let block = "";  // "kiss-icp:" and the indented lines below it
    return value.split("\n").filter((line) => line.trim()).map((line) => {
      if (!/^\s/.test(line)) block = line.replace(/:.*$/, "");
      const [name, ...rest] = line.trim().split(":");
      return [[key, block === name ? "" : block, name].filter(Boolean).join(" "), rest.join(":").trim()];
    });
  });
}

/** What two provenances do not share: [[name, in A, in B]]; times and the commands apart, which always differ. */
export function differing(textA, textB) {
  const [a, b] = [new Map(lines(textA)), new Map(lines(textB))];
  const skipped = /^(made_at|command|simulate\.|recording$|truth$)/;
  return [...new Set([...a.keys(), ...b.keys()])].filter((key) => !skipped.test(key) && a.get(key) !== b.get(key))
    .map((key) => [key, a.get(key) ?? "", b.get(key) ?? ""]);
}

/** A table of what differs between the first runs of two folders; null when a side has no provenance. */
export function differences(provenances) {
  const [a, b] = provenances;
  if (!parsed(a.text) || !parsed(b.text) || a.text === b.text) return null;
  const rows = differing(a.text, b.text);
  if (rows.length === 0) return el("p", {}, "Build, options and machine of the first runs are the same.");
  return [el("p", { class: "reading" }, "What differs between the first runs of the two:"),
    el("div", { class: "table-wrap" }, el("table", { class: "differing" }, el("thead", {}, el("tr", {}, ...["Field", "A", "B"].map((name) => el("th", { scope: "col" }, name)))),
      el("tbody", {}, ...rows.map(([key, of_a, of_b]) => el("tr", {}, el("th", { scope: "row" }, key.replaceAll("_", " ")), el("td", {}, of_a || "–"), el("td", {}, of_b || "–"))))))];
}

export function provenance(state, { folded = false } = {}) {
  const blocks = state.data.provenance.filter(({ text }) => text).map(({ folder, text }, i) => {
    const content = parsed(text);
    if (content === null) return el("pre", {}, text);
    const rows = flatten(content, "", []).filter(([key, value]) => key !== "command" && value !== "");
    const table = el("table", { class: "facts" }, el("tbody", {}, ...rows.map(([key, value]) =>
      el("tr", {}, el("th", { scope: "row" }, key.replaceAll("_", " ")), el("td", {}, value)))));
    if (i === 0 && !folded) return table;
    return el("details", {}, el("summary", {}, folder || `run ${i + 1}`), table);
  });
  const { command } = state.data;
  return [
    command && el("p", { class: "reading" }, "This command makes the same figures again (timing differs from machine to machine)."),
    command && el("div", { class: "command" }, el("code", {}, command), copyButton(command)),
    ...blocks,
  ];
}
