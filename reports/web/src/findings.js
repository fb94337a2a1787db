// What was looked for, whether it was found, and by what evidence: a table of all topics, and a card for each that is found.
import { el } from "./dom.js";
import { figure } from "./figures.js";
import { gatherFinding, titleOf, topicsOf } from "./diagnosis.js";
import { formatNumber } from "./format.js";
import { isNumber } from "./stats.js";

const kTones = { "found": "bad", "nothing found": "good", "cannot be told": "plain" };
function evidence(numbers) {
  if (numbers.length === 0) return null;
  return el("table", { class: "evidence" }, el("tbody", {}, ...numbers.map((number) => el("tr", {},
    el("th", { scope: "row" }, number.name),
    el("td", {}, formatNumber(number.value), number.unit && number.unit !== "1" ? ` ${number.unit}` : "",
      isNumber(number.low) && isNumber(number.high) ? el("span", { class: "range" }, `${formatNumber(number.low)} to ${formatNumber(number.high)}`) : null,
      number.over > 1 ? el("span", { class: "range" }, `median of ${number.over} seeds`) : null)))));
}

/** Red where most runs have it, amber where some do. */
function tone(found) {
  return found.verdict === "found" && 2 * found.count <= found.of ? "mixed" : kTones[found.verdict] ?? "plain";
}

function card(state, name, found) {
  const seeds = found.of > 1 ? `${found.verdict} in ${found.count} of ${found.of} runs` : found.verdict;
  return el("article", { class: "finding" },
    el("div", { class: "finding-head" }, el("strong", {}, titleOf(found.topic)),
      el("span", { class: `chip ${tone(found)}` }, seeds)),
    el("div", { class: "finding-who" }, el("i", { class: "dot", style: { background: `var(${state.color(name)})` } }), name,
      found.of > 1 ? el("span", { class: "muted" }, ` in the words of seed ${found.seed}`) : null),
    el("p", {}, found.words),
    found.evidence.length ? el("details", { open: found.verdict === "found" }, el("summary", {}, "Evidence"), evidence(found.evidence)) : null);
}

export class Findings {
  constructor(state) {
    this.state = state;
    this.topics = topicsOf(state.data);
    this.chosen = null;  // [estimator, topic] whose card is shown beside those that are found
    this.table = el("div", { class: "table-wrap", tabindex: "0", role: "region", "aria-label": "Findings" });
    this.cards = el("div", { class: "findings" });
    this.element = el("div", {}, this.table, this.cards);
    state.listen((what) => { if (what !== "theme") this.draw(); });
    this.draw();
  }

  draw() {
    const names = this.state.data.estimators.filter((name) => this.state.isVisible(name));
    const cards = [];
    const body = this.topics.map((topic) => el("tr", {}, el("th", { scope: "row" }, titleOf(topic)), ...names.map((name) => {
      const found = gatherFinding(this.state.runs(name), topic);
      if (!found) return el("td", { class: "na" }, "–");
      const chosen = this.chosen?.[0] === name && this.chosen[1] === topic;
      if (found.verdict === "found" || chosen) cards.push(card(this.state, name, found));
      return el("td", {}, el("button", { type: "button", class: `chip ${tone(found)}`, "aria-pressed": chosen, "data-tip": found.words,
        onclick: () => { this.chosen = chosen ? null : [name, topic]; this.draw(); } },
      found.of > 1 && found.count < found.of ? `${found.verdict} in ${found.count} of ${found.of}` : found.verdict));
    })));
    this.table.replaceChildren(el("table", {}, el("thead", {}, el("tr", {}, el("th", { scope: "col" }, el("span", { class: "sort" }, "Looked for")),
      ...names.map((name) => el("th", { scope: "col" }, el("span", { class: "sort" }, name))))), el("tbody", {}, ...body)));
    this.cards.replaceChildren(...cards);
  }
}

export function findings(state) {
  if (topicsOf(state.data).length === 0) return null;
  return figure("What the residuals and stamps say",
    "Each row is something that can be wrong, each column a method; a red cell was found (amber: in half of the runs or fewer), and its card tells by what. Point at any cell for its words, click it for its numbers; 'cannot be told' is no all-clear.",
    new Findings(state).element);
}
