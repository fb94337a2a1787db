// Where on the drive two methods differ: series of both, their paired difference, and the path.
import { el } from "./dom.js";
import { filledChart, figure, segments } from "./figures.js";
import { splitLabel } from "./format.js";
import { ends, levelWords, seriesName, seriesWords, steps, stretchWords, toneOf } from "./located.js";
import { pathMap } from "./pathmap.js";

/** Both lines from end to end of the charts, so that one chart's seconds stand above the other's. */
function linesOf(series) {
  const [first, last] = ends(series);
  const before = series.x[0] > first ? [first] : [], after = series.x.at(-1) < last ? [last] : [];
  const padded = (y) => [...before.map(() => null), ...y, ...after.map(() => null)];
  const x = [...before, ...series.x, ...after];
  return [{ name: "A", color: "--c0", x, y: padded(series.a) }, { name: "B", color: "--c1", x, y: padded(series.b) }];
}

function charts(state, series, key) {
  const shades = () => series.stretches.map((stretch) => ({ ...stretch, color: toneOf(stretch) }));
  const both = filledChart(state, { xLabel: series.x_label, yLabel: `median ${series.y_label}`, height: 200, sync: key, bare: true, log: "linear", shades }, () => linesOf(series));
  const [name, unit] = splitLabel(series.y_label);
  const has = series.difference.some((value) => value !== null);
  const difference = has ? filledChart(state, { xLabel: series.x_label, yLabel: `B's ${name} less A's [${unit}]`, height: 150, sync: key, log: "never", shades }, () => [
    { name: "difference", color: "--c7", steps: true, ...steps(series) },
  ]) : null;
  return [both.element, difference?.element];
}

/** How to read a drive's figure; how the intervals were made is said once. */
function reading(drive, series, isFirst) {
  if (series.pairs < 3) return `Above, the median over ${series.pairs} seed${series.pairs === 1 ? "" : "s"} of A and of B: too few for an interval of their difference.`;
  if (!isFirst) return "Read as the figure above.";
  return `Above, the median over ${series.pairs} seeds of A (blue) and of B (orange); below, B's less A's on the same seed, averaged over the seeds. `
    + (drive.located ? "Shaded is where the band leaves 0 aside: there B is worse (red) or better (green). " : "Nothing is shaded, since no metric of this method on this case differs significantly. ")
    + levelWords(series, drive.series.length);
}

function pathFigure(drive) {
  const told = drive.series.filter((series) => series.stretches.length);
  const place = el("div", {});
  const draw = (series) => place.replaceChildren(pathMap(drive.path, series?.stretches ?? [], toneOf, (stretch) => `${seriesName(series)}, ${stretchWords(series, stretch)}`) ?? "");
  draw(told[0]);
  const choice = told.length > 1 ? el("div", { class: "chart-bar" }, segments("Coloured by", told.map((series) => [series, seriesName(series)]), told[0], draw)) : null;
  return figure("The same stretches on the path", `The true path of seed ${drive.path.seed} from above, north up. `
    + (told.length ? "Coloured is where B is worse (red) or better (green) than A by more than chance." : "No stretch is coloured: none is more than chance."), ...[choice, place].filter(Boolean));
}

const labelOf = (drive) => (drive.a === drive.b ? `${drive.case} · ${drive.a}` : `${drive.case} · ${drive.a} → ${drive.b}`);

export function whereOnTheDrive(state) {
  const { drives } = state.data;
  if (drives.length === 0) return null;
  const body = el("div", {});
  const show = (drive) => {
    const key = `drive ${drives.indexOf(drive)}`;
    body.replaceChildren(
      el("ul", { class: "fitted where-words" }, ...drive.series.map((series) => el("li", {}, seriesWords(drive, series)))),
      ...drive.series.map((series, i) => figure(`${seriesName(series)} along the drive`, reading(drive, series, i === 0), ...charts(state, series, key).filter(Boolean))),
      drive.path ? pathFigure(drive) : "");
  };
  const chosen = drives[0];
  const select = el("select", { "aria-label": "Case and method", onchange: (event) => show(drives[Number(event.target.value)]) },
    ...drives.map((drive, i) => el("option", { value: String(i), selected: drive === chosen }, labelOf(drive) + (drive.located ? "" : " (no significant difference)"))));
  show(chosen);
  const left = state.data.drives_left_out;
  return [
    el("div", { class: "filter" }, el("label", {}, "Drive ", select), left ? el("span", { class: "muted" }, `${left} more without room on the page: --case shows them`) : null),
    body,
  ];
}
