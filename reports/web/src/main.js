// Builds the page from the data that the program wrote into it.
import "uplot/dist/uPlot.min.css";
import "./page.css";
import { unpack } from "./data.js";
import { comparison } from "./comparison.js";
import { degeneracy } from "./degeneracy.js";
import { drift } from "./drift.js";
import { el, installTooltip } from "./dom.js";
import { chart, figure, pair } from "./figures.js";
import { findings } from "./findings.js";
import { formatNumber } from "./format.js";
import { contents, legend } from "./legend.js";
import { mapGallery, overview, pictureNote } from "./pictures.js";
import { outcome, provenance } from "./record.js";
import { residuals } from "./residuals.js";
import { createState } from "./state.js";
import { FullTable, SummaryTable } from "./tables.js";
import { applyTheme, themeSwitch } from "./theme.js";
import { TopView } from "./topview.js";
import { seedBand } from "./words.js";

applyTheme();
const data = unpack(JSON.parse(document.getElementById("tarmac-data").textContent));
const state = createState(data);
const sections = [];

const add = (name, options) => chart(state, name, options)?.element;

const kShort = { comparison: "Comparison", stills: "Scene", phase: "Sweep", residuals: "Residuals", deskew: "Deskew", outcome: "Outcome" };

function section(id, title, ...content) {
  const filled = content.flat().filter(Boolean);
  if (filled.length === 0) return;
  document.getElementById(id).append(el("h2", {}, title), ...filled);
  sections.push({ id, title: kShort[id] ?? title });
}

const manySeeds = seedBand(state);

function summary() {
  const table = new SummaryTable(state);
  section("summary", "Summary", table.element,
    el("p", { class: "reading" }, data.seeds.length > 1
      ? `Each row is a method: the large figure is the median over ${data.seeds.length} seeds, the small ones the smallest and largest; a lamp marks the best of a column.`
      : "Each row is a method; a lamp marks the best of a column, and pointing at a column's name or an n/a tells more.",
    table.missing ? ` ${table.missing}` : ""),
    new FullTable(state).element);
}

function paths() {
  const top = new TopView(state);
  state.listen(() => top.draw());
  section("top", "Paths", state.hasTruth
    ? figure("True and estimated paths from above",
      "The broad line is where the vehicle really went, a thin coloured one where a method believes it went; the gap between them is the error at that place, after the method's path was laid onto the truth at its first pose."
      + (top.degenerate().some((path) => path.x.length) ? " A red shade marks where the geometry leaves a direction free (see Degeneracy)." : ""),
      top.element)
    : figure("Estimated paths from above",
      "Each line is where a method believes the sensor went, drawn in the method's own frame, which begins at its first sweep; where lines part the methods disagree, and without truth nothing here says which of them is right.",
      top.element));
  section("stills", "Scene and maps", state.hasTruth && pictureNote(state),
    overview(state) && figure("The scene", `What the sensor drove through, seen from the south-west; things that move stand where they were at ${formatNumber(data.picture_time_s)} s.`, overview(state)),
    mapGallery(state));
}

function figures() {
  section("drift", "Drift", drift(state));

  const phase = add("reference_error_by_phase", { log: "linear" });
  const bent = add("deskew_error_by_phase", { log: "linear" });
  section("phase", "Inside the sweep", pair(
    phase && figure("Error by sweep phase", `Left is the first firing of a sweep, right the last, where most methods hold their pose: a line that rises towards the left belongs to a method that does not undo the vehicle's motion while the sensor turns.${manySeeds}`, phase),
    bent && figure("What remains after the sweep's best fit", `The same, after each sweep was moved rigidly to where it fits best: what is left is how far the sweep itself is bent.${manySeeds}`, bent)));

  section("residuals", "Residuals and time", residuals(state));

  const deskew = add("deskew_error_vs_time", { sync: "time", bare: true });
  const speed = add("speed_vs_time", { sync: "time", bare: true, height: 110, truth: true, log: "never" });
  const yaw = add("yaw_rate_vs_time", { sync: "time", height: 130, truth: true, log: "never" });
  section("deskew", "Deskew and motion",
    (deskew || speed) && figure("Deskew error beside speed and yaw rate",
      "Peaks above turns and fast stretches below show which motion a method fails to undo; a method that deskews well stays low through all of them.",
      deskew, speed, yaw));

  section("degeneracy", "Degeneracy", degeneracy(state));

  const time = add("sweep_time_vs_time", { sync: "time" });
  const iterations = add("iterations_vs_time", { sync: "time" });
  section("timing", "Timing", pair(
    time && figure("Time a sweep", "A sensor that turns at 10 Hz hands over a sweep every 100 ms: a method keeps up while its line stays below that, on the machine named under Provenance.", time),
    iterations && figure("Iterations a sweep", "How often the method went round before it was content; a rise here is a rise in time, and often a sign of poor geometry.", iterations)));
}

document.getElementById("theme").append(themeSwitch(() => state.changed("theme")));
legend(state);
summary();
section("comparison", "Compared over seeds", comparison(state));
section("findings", "Findings", findings(state));
paths();
figures();
section("outcome", "How the runs ended", outcome(state));
section("provenance", "Provenance", provenance(state));
contents(sections);
installTooltip();
document.documentElement.classList.add("ready");
