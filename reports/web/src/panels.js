// Small multiples: several charts with one y axis a unit, and a choice of what they are drawn over.
import { el } from "./dom.js";
import { filledChart, figure, labelsOf, linesOf, segments } from "./figures.js";
import { splitLabel } from "./format.js";
import { wantsLog } from "./plot.js";
import { extent, logExtent } from "./stats.js";

/**
 * views: [{label, reading, names: [series names], signed?, band?: keep a run's own band}]; every view has the same
 * number of names, and a view that no run has any series of is left out. Returns a figure, or null.
 */
export function panels(state, title, views, { height = 190, columns } = {}) {
  const usable = views.filter((view) => view.names.some((name) => labelsOf(state.data, name)));
  if (usable.length === 0) return null;
  let view = usable[0];
  let chosenLog = null;
  const lines = (name) => linesOf(state, name, view.band);
  const unit = (name) => splitLabel(labelsOf(state.data, name)?.[1])[1];
  const isLog = () => !view.signed && (chosenLog ?? view.names.some((name) => wantsLog(lines(name))));
  const charts = view.names.map((_, k) => {
    const together = () => view.names.filter((name) => unit(name) === unit(view.names[k])).flatMap(lines);
    const made = filledChart(state, {
      ...labels(k), height, log: "outside", sync: title, range: () => extent(together()), logRange: () => logExtent(together()),
    }, () => {
      made.log = isLog();
      return lines(view.names[k]);
    });
    return made;
  });
  function labels(k) {
    const [xLabel, yLabel] = labelsOf(state.data, view.names[k]) ?? ["", "no run has these values"];
    return { xLabel, yLabel };
  }
  const reading = el("span", {}, view.reading);
  const logSwitch = el("button", { type: "button", class: "quiet", onclick: () => { chosenLog = !isLog(); update(); } });
  function update() {
    reading.textContent = view.reading;
    logSwitch.hidden = Boolean(view.signed);
    logSwitch.textContent = isLog() ? "Linear axes" : "Log axes";
    charts.forEach((made, k) => {
      const { xLabel, yLabel } = labels(k);
      made.setLabels(xLabel, yLabel);
      made.fill();
    });
  }
  state.listen(() => { logSwitch.textContent = isLog() ? "Linear axes" : "Log axes"; });
  const choice = usable.length > 1
    ? segments("Drawn over", usable.map((one) => [one, one.label]), view, (chosen) => { view = chosen; update(); }) : null;
  update();
  const bar = choice || usable.some((one) => !one.signed) ? el("div", { class: "chart-bar" }, choice ?? el("span", {}), logSwitch) : null;
  return figure(title, reading, bar,
    el("div", { class: `panels ${columns ?? `n${charts.length}`}` }, ...charts.map((made) => made.element)));
}
