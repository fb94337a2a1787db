// Residuals over the point's time in the sweep: what bends, what slopes, and what an offset of clocks would do.
import { el } from "./dom.js";
import { chart, figure, filledChart, labelsOf, linesOf, pair } from "./figures.js";
import { formatNumber } from "./format.js";
import { panels } from "./panels.js";
import { ascending, dotRange, isNumber } from "./stats.js";
import { gather } from "./tables.js";
import { listed, seedBand } from "./words.js";

/** All samples of a scatter over the chosen seeds as one set of dots a method, and its fit as a line. */
function scatterLines(state, name) {
  const dots = [];
  for (const estimator of state.data.estimators) {
    if (!state.isVisible(estimator)) continue;
    const runs = state.runs(estimator).map((run) => run.series[name]).filter(Boolean);
    if (runs.length === 0) continue;
    const { x, y } = ascending(runs.flatMap((series) => series.x), runs.flatMap((series) => series.y));
    dots.push({ name: estimator, color: state.color(estimator), x, y, dots: true });
  }
  return [...dots, ...linesOf(state, `${name}_fit`, true).map((line) => ({ ...line, width: 2.2 }))];
}

/** "kiss-icp-imu 5.02 ms (4.98 to 5.06)": a method's fitted time over its chosen runs. */
function fitted(state, metric) {
  return state.data.estimators.filter((name) => state.isVisible(name)).map((name) => {
    const found = gather(state.runs(name), metric);
    if (found.median === null) return null;
    const row = found.rows[0].row;
    const interval = found.values.length > 1 ? found.range : isNumber(row?.low) ? [row.low, row.high] : null;
    const what = found.values.length > 1 ? "seeds from " : "95 % interval ";
    return el("li", {}, el("i", { class: "dot", style: { background: `var(${state.color(name)})` } }), el("strong", {}, `${formatNumber(found.median)} ms`), ` ${name}`,
      interval ? el("span", { class: "muted" }, ` ${what}${formatNumber(interval[0])} to ${formatNumber(interval[1])}`) : null);
  }).filter(Boolean);
}

function regression(state, name, metric, title, reading) {
  const labels = labelsOf(state.data, name);
  if (!labels) return null;
  const made = filledChart(state, { xLabel: labels[0], yLabel: labels[1], height: 280, log: "never", range: () => dotRange(scatterLines(state, name)) },
    () => scatterLines(state, name));
  const values = el("ul", { class: "fitted" });
  const update = () => values.replaceChildren(...fitted(state, metric));
  state.listen(update);
  update();
  return figure(title, reading, made.element, values);
}

export function residuals(state) {
  const own = state.data.seeds.length === 1;
  const band = own ? " The band is the 95 % interval of a bootstrap over sweeps." : seedBand(state);
  const mean = chart(state, "residual_mean_by_phase", { log: "never", band: own })?.element;
  const spread = chart(state, "residual_spread_by_phase", { log: "linear", band: own })?.element;
  const lag = chart(state, "error_vs_lag", { log: "never" })?.element;
  const missing = state.data.estimators.filter((name) => !state.data.runs.some((run) => run.estimator === name && run.series.residual_mean_by_phase));
  return [
    pair(
      mean && figure("Residual over the point's time", `Mean of the signed distance from the map's surface, positive in front of it, by the point's place in the sweep: a line along 0 is a sweep that lies flat on its map; a slope, a bow or a saw-tooth is motion or time that the method gets wrong.${band}`, mean),
      spread && figure("Spread of the residuals", `How far the residuals of a moment scatter about their mean: the level is noise and roughness of surfaces, a rise at one end belongs to points that are placed worse.${band}`, spread)),
    panels(state, "Displacement that the residuals imply", [
      { label: "By phase", band: own, names: ["forward", "left", "up"].map((direction) => `displacement_${direction}_by_phase`), signed: true,
        reading: `How far points would have to be moved, along the vehicle's own axes, for the residuals of that moment to vanish: a slope forward is speed that is undone too little or too much, a bow is acceleration that is left out.${band}` }]),
    pair(
      regression(state, "residual_slope_vs_domega", "residual_lag_rotation_ms", "Slope against the change of the rate of turn",
        "A dot is one axis of one sweep: by how much the residuals turn over the sweep, over how much the rate of turn changed in it. The line's slope is a time: how late the turning that the method places points by is against the points; for a method with an IMU it is the offset of the clocks. The band is ± 1 σ."),
      regression(state, "residual_slope_vs_dv", "residual_lag_translation_ms", "Slope against the change of velocity",
        "The same for displacement over the change of velocity; a method that registers with the LiDAR corrects its own velocity, so this line does not tell of clocks. The band is ± 1 σ.")),
    lag && figure("Error against a lag of the truth", `The path error if the whole estimate were that much late: the bottom of the valley is the lag that fits best, and its distance from 0 an offset of the LiDAR's clock or a delay of the method.${seedBand(state)}`, lag),
    mean && missing.length ? el("p", { class: "reading" }, `No residuals were recorded for ${listed(missing)}, so ${missing.length > 1 ? "they are" : "it is"} not in these figures.`) : null,
  ];
}
