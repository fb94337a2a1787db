// Builds the page of a comparison from the data that the program wrote into it.
import "uplot/dist/uPlot.min.css";
import "./page.css";
import "./compare.css";
import { forest, largestChanges, RowTable } from "./changes.js";
import { el, installTooltip } from "./dom.js";
import { figure } from "./figures.js";
import { contents } from "./legend.js";
import { differences, provenance } from "./record.js";
import { applyTheme, themeSwitch } from "./theme.js";
import { whereOnTheDrive } from "./where.js";

applyTheme();
const data = JSON.parse(document.getElementById("tarmac-data").textContent);
const listeners = [];
const state = { data, listen: (listener) => listeners.push(listener), changed: (what) => listeners.forEach((listener) => listener(what)) };
const sections = [];

function section(id, title, short, ...content) {
  const filled = content.flat().filter(Boolean);
  if (filled.length === 0) return;
  document.getElementById(id).append(el("h2", {}, title), ...filled);
  sections.push({ id, title: short });
}

function sides() {
  const side = (letter, color, one) => el("div", { class: "side" },
    el("span", { class: "engraved" }, el("i", { class: "dot", style: { background: `var(${color})` } }), letter),
    el("strong", {}, one.label),
    el("span", { class: "muted" }, [one.estimator, one.build, `${one.runs} runs`].filter(Boolean).join(" · ")),
    el("code", { class: "muted" }, one.folder));
  document.getElementById("sides").append(el("div", { class: "sides" }, side("A", "--c0", data.a), side("B", "--c1", data.b)));
}

function legend() {
  const key = (letter, color, label) => el("span", { class: "key fixed" }, el("i", { class: "dot", style: { background: `var(${color})` } }), el("strong", {}, letter), ` ${label}`);
  document.querySelector("#legend .bar").append(el("div", { class: "keys" }, key("A", "--c0", data.a.label), key("B", "--c1", data.b.label)));
}

function changes() {
  const shown = largestChanges(data.rows, 24, 8);
  if (shown.significant.length + shown.others.length === 0) return;
  section("changes", "What changed most", "Changes", figure(
    shown.significant.length ? `${data.b.label} against ${data.a.label}` : "Nothing is more than chance",
    "Each line is one metric of one method on one case: B's value over A's on the same seeds, with its 95 % interval, on a logarithmic axis; at the line at 1 nothing changed. Filled and coloured is what is more than chance once all rows are counted (green: B is better, red: worse, yellow: neither way is better); grey and hollow is what is not, however far from 1 its dot lies."
    + (shown.more ? ` ${shown.more} more are in the table below.` : ""),
    forest(data, shown)));
}

function tables() {
  const own = data.rows.filter((row) => !row.cost);
  const costs = data.rows.filter((row) => row.cost);
  if (own.length) section("rows", "All comparisons", "All rows", new RowTable(data, own, { label: "All comparisons" }).element);
  if (costs.length) {
    section("cost", "Cost", "Cost",
      el("p", { class: "note" }, "Times and memory depend on the machine and on what else it did: a difference here may be the machine's. They are judged among themselves."),
      new RowTable(data, costs, { label: "Cost", filter: costs.length > 12 }).element);
  }
}

function missing() {
  if (data.missing.length === 0) return;
  const rows = data.missing.map((line) => el("tr", {}, el("th", { scope: "row" }, el("span", { class: `chip ${/^no result/.test(line.kind) ? "bad" : "plain"}` }, line.kind)),
    el("td", {}, line.what), el("td", {}, line.detail), el("td", { class: "count" }, String(line.count))));
  section("missing", "Not compared", "Not compared", el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": "Not compared" },
    el("table", { class: "missing" }, el("thead", {}, el("tr", {}, ...["Why", "What", "Which", "Runs"].map((name) => el("th", { scope: "col" }, name)))), el("tbody", {}, ...rows))));
}

document.getElementById("theme").append(themeSwitch(() => state.changed("theme")));
sides();
legend();
changes();
section("drive", "Where on the drive", "Drive", whereOnTheDrive(state));
tables();
missing();
section("provenance", "Provenance", "Provenance", el("p", {}, data.recordings.words), differences(data.provenance), provenance(state, { folded: true }));
contents(sections);
installTooltip();
document.documentElement.classList.add("ready");
