// Where on the drive two methods differ: series of both, their paired difference, and the path.
import { el } from "./dom.js";
import { filledChart, figure } from "./figures.js";
import { formatLength, formatNumber, splitLabel } from "./format.js";
import { pathMap } from "./pathmap.js";
import { listed } from "./words.js";

const kNames = { deskew_error_vs_time: "Deskew error", error_vs_time: "Position error" };

export const seriesName = (series) => kNames[series.name] ?? splitLabel(series.y_label)[0];

/** Of an error the lower is the better one: all series here are errors. */
export const toneOf = (stretch) => (stretch.difference > 0 ? "--bad" : "--good");

/** "from 3 to 7 s B's is higher by 1.2 cm" */
export function stretchWords(series, stretch) {
  const [, unit] = splitLabel(series.y_label);
  const size = Math.abs(stretch.difference);
  const amount = unit === "m" ? formatLength(size) : `${formatNumber(size)}${unit ? ` ${unit}` : ""}`;
  return `${formatNumber(stretch.from)} to ${formatNumber(stretch.to)} s: B ${stretch.difference > 0 ? "higher" : "lower"} by ${amount}`;
}

/** What a series of a drive says in words. */
export function seriesWords(drive, series) {
  const name = seriesName(series);
  if (series.pairs < 3) return `${name}: ${series.pairs} seed${series.pairs === 1 ? "" : "s"} with both, at least 3 are needed for an interval.`;
  if (!drive.located) return `${name}: no metric of this method on this case differs significantly, so no stretch is looked for.`;
  if (series.stretches.length === 0) return `${name}: no stretch stands out by itself; what differs is too little in any one second, or not at the same place on all seeds.`;
  const most = 4;
  const longest = [...series.stretches].sort((a, b) => (b.to - b.from) - (a.to - a.from)).slice(0, most).sort((a, b) => a.from - b.from);
  const more = series.stretches.length - longest.length;
  return `${name}: ${listed(longest.map((stretch) => stretchWords(series, stretch)))}${more > 0 ? `; and ${more} more` : ""}.`;
}

/** How the intervals were made, for people. */
export function levelWords(series, count) {
  const blocks = series.block_x.length;
  const block = series.block_length === 1 ? "a second" : `${formatNumber(series.block_length)} s`;
  return `Neighbouring sweeps err alike, so each seed's difference is averaged over ${block} first. The band is Student's interval over ${series.pairs} seeds at ${formatNumber(100 * series.level, 2)} % a second: `
    + `5 % shared by ${blocks} seconds${count > 1 ? ` and ${count} figures` : ""} (Bonferroni), so that all of the bands hold at once, and a shaded stretch is no accident of having looked at many.`
    + (series.pairs < 7 ? ` (Flipping signs would need no bell curve, but ${series.pairs} seeds have only ${2 ** series.pairs} patterns of signs: too few for this.)` : "");
}

function linesOf(state, series) {
  return [
    { name: "A", color: "--c0", x: series.x, y: series.a },
    { name: "B", color: "--c1", x: series.x, y: series.b },
  ];
}

function charts(state, series, key) {
  const shades = () => series.stretches.map((stretch) => ({ ...stretch, color: toneOf(stretch) }));
  const both = filledChart(state, { xLabel: series.x_label, yLabel: `median ${series.y_label}`, height: 200, sync: key, bare: true, log: "linear", shades }, () => linesOf(state, series));
  const [name, unit] = splitLabel(series.y_label);
  const has = series.difference.some((value) => value !== null);
  const difference = has ? filledChart(state, { xLabel: series.x_label, yLabel: `B's ${name} less A's [${unit}]`, height: 150, sync: key, log: "never", shades }, () => [
    { name: "difference", color: "--c7", x: series.block_x, y: series.difference, low: series.low, high: series.high },
  ]) : null;
  return [both.element, difference?.element];
}

const labelOf = (drive) => (drive.a === drive.b ? `${drive.case} · ${drive.a}` : `${drive.case} · ${drive.a} → ${drive.b}`);

export function whereOnTheDrive(state) {
  const { drives } = state.data;
  if (drives.length === 0) return null;
  const body = el("div", {});
  const show = (drive) => {
    const key = `drive ${drives.indexOf(drive)}`;
    const first = drive.series.find((series) => series.stretches.length) ?? drive.series[0];
    const map = drive.path && pathMap(drive.path, first.stretches, toneOf, (stretch) => `${seriesName(first)}, ${stretchWords(first, stretch)}`);
    body.replaceChildren(
      el("ul", { class: "fitted where-words" }, ...drive.series.map((series) => el("li", {}, seriesWords(drive, series)))),
      ...drive.series.map((series) => figure(`${seriesName(series)} along the drive`,
        `Above, the median over ${series.pairs} seed${series.pairs === 1 ? "" : "s"} of A and of B; below, B's less A's on the same seed, averaged. ${series.pairs >= 3 ? `Shaded is where the band leaves 0 aside: there B is ${series.stretches.length ? "" : "(nowhere here) "}worse (red) or better (green). ${levelWords(series, drive.series.length)}` : "Too few seeds for an interval."}`,
        ...charts(state, series, key).filter(Boolean))),
      map ? figure("The same stretches on the path", `The true path of seed ${drive.path.seed} from above, north up; coloured where B's ${seriesName(first).toLowerCase()} is worse (red) or better (green) than A's by more than chance.`, map) : "");
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
