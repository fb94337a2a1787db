// Where the geometry gives out: smallest eigenvalues over time, the directions that nothing holds, and who notices.
import { el } from "./dom.js";
import { figure, filledChart, labelsOf, linesOf, segments, truthLines } from "./figures.js";
import { describe, stretches, weakDirections } from "./stretches.js";
import { SummaryTable } from "./tables.js";

const kDegenerate = 2;  // class in degeneracy_class_vs_time
const kViews = [
  ["6dof", "Pose (6)", "lambda_min_6dof_vs_time", "degeneracy_class_vs_time"],
  ["difference", "Motion in the sweep", "lambda_min_12dof_difference_vs_time", "degeneracy_class_12dof_vs_time"],
  ["12dof", "Two poses (12)", "lambda_min_12dof_vs_time", "degeneracy_class_12dof_vs_time"],
];

/** A method's series by its point-to-surface residuals where it solves with others, else by those it solves with. */
function ofMethod(state, name) {
  const surface = `surface_${name}`;
  const both = state.data.estimators.filter((estimator) => state.isVisible(estimator)).map((estimator) => {
    const has = state.data.runs.some((run) => run.estimator === estimator && run.series[surface]);
    return linesOf({ ...state, isVisible: (other) => other === estimator }, has ? surface : name);
  });
  return both.flat();
}

function timeline(state) {
  const usable = kViews.filter(([, , name]) => labelsOf(state.data, name) || labelsOf(state.data, `oracle_${name}`) || labelsOf(state.data, `surface_${name}`));
  if (usable.length === 0) return null;
  let view = usable[0];
  const lines = () => [
    ...truthLines(state, `oracle_${view[2]}`).map((line) => ({ ...line, name: "oracle", width: 2 })),
    ...ofMethod(state, view[2]).map((line) => ({ ...line, low: undefined, high: undefined })),
    ...truthLines(state, `oracle_threshold_${view[2].replace("lambda_min_", "")}`).map((line) => ({ ...line, name: "oracle's threshold", dash: [6, 4], width: 1 })),
    ...linesOf(state, `threshold_${view[2].replace("lambda_min_", "")}`).slice(0, 1).map((line) => ({ ...line, name: "methods' threshold", color: "--muted", dash: [2, 4], width: 1, low: undefined, high: undefined })),
  ];
  const firstSeed = () => String(state.seed === "all" ? state.data.seeds[0] : state.seed);
  const oracle = (name) => state.data.truth[firstSeed()]?.[`oracle_${name}`];
  const shades = () => {
    const series = oracle(view[3]);
    return series ? stretches(series, kDegenerate).map(({ from, to }) => ({ from, to, color: "--bad" })) : [];
  };
  const labels = () => labelsOf(state.data, view[2]) ?? labelsOf(state.data, `oracle_${view[2]}`) ?? labelsOf(state.data, `surface_${view[2]}`);
  const made = filledChart(state, { xLabel: labels()[0], yLabel: labels()[1], height: 300, sync: "time", log: "log", shades }, lines);
  const said = el("div", { class: "weakest" });
  const update = () => said.replaceChildren(...weakest(state, firstSeed(), view[3]));
  state.listen(update);
  update();
  const choice = usable.length > 1 ? segments("Eigenvalues of", usable.map((one) => [one, one[1]]), view, (chosen) => {
    view = chosen;
    made.setLabels(...labels());
    made.fill();
    update();
  }) : el("span", {});
  const several = state.data.seeds.length > 1 ? " Shades and stretches are those of the chosen seed, or of the first one." : "";
  return figure("Smallest eigenvalue over time",
    `How firmly a sweep's residuals hold the direction that they hold least: low means free. The dark line is the oracle's, by exact normals, and the shade is where it calls the geometry degenerate; a method that knows its limits falls with it.${several}`,
    el("div", { class: "chart-bar" }, choice, el("span", { class: "axis-name" }, labelsOf(state.data, `oracle_${view[2]}`) ? "Dark: oracle. Dashed: thresholds." : "")), made.element, said);
}

/** Who calls what degenerate, in words: the oracle first, then every method. */
function weakest(state, seed, className) {
  const rows = [];
  const tell = (who, color, seriesOf, prefix, ownPrefix) => {
    const classes = seriesOf(`${ownPrefix}${className}`);
    if (!classes) return;
    const list = stretches(classes, kDegenerate);
    const text = list.length === 0 ? "calls no sweep degenerate." : `${describe(list, (stretch) => weakDirections(seriesOf, prefix, stretch))}.`;
    rows.push(el("li", {}, color ? el("i", { class: "dot", style: { background: `var(${color})` } }) : null, el("strong", {}, who), " ", text));
  };
  tell("oracle", "--ink", (name) => state.data.truth[seed]?.[name], "oracle_", "oracle_");
  for (const estimator of state.data.estimators.filter((name) => state.isVisible(name))) {
    const run = state.data.runs.find((one) => one.estimator === estimator && String(one.seed) === seed);
    const surface = run?.series[`surface_${className}`];
    if (run) tell(estimator, state.color(estimator), (name) => run.series[name], "", surface ? "surface_" : "");
  }
  return rows.length ? [el("p", { class: "muted" }, "Degenerate stretches, and the directions that are free in them:"), el("ul", {}, ...rows)] : [];
}

const kScores = [["precision", "Precision"], ["recall", "Recall"], ["f1", "F1"], ["auc", "AUC"], ["event_precision", "Event precision"], ["event_recall", "Event recall"], ["lead_time_s", "Lead time"]];

function scores(state) {
  const content = [];
  for (const [source, words] of [["surface", "its point-to-surface residuals"], ["solve", "the residuals that it solves with"]]) {
    for (const [block, what] of [["6dof", "the pose"], ["12dof", "the motion in the sweep"]]) {
      const table = new SummaryTable(state, kScores.map(([name, label]) => [`degeneracy_${source}_${block}_${name}`, label]));
      if (table.columns.length) content.push(el("h3", { class: "small" }, `Degeneracy of ${what}, by ${words}`), table.element);
    }
  }
  if (content.length === 0) return [];
  return [figure("Who notices",
    "A method's eigenvalue against the oracle's verdict: precision is the share of its alarms that are right, recall the share of degenerate sweeps that it flags, lead time how long before the onset it does (above 0: before). Small figures are 95 % Wilson intervals of one seed, the range of several; sweeps near the threshold are left out.",
    ...content)];
}

export function degeneracy(state) {
  return [timeline(state), ...scores(state)];
}
