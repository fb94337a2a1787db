// Stretches of a drive in which two methods differ, in words and as steps. No DOM here: tested by node.
import { formatLength, formatNumber, splitLabel } from "./format.js";

const kNames = { deskew_error_vs_time: "Deskew error", error_vs_time: "Position error" };

export const seriesName = (series) => kNames[series.name] ?? splitLabel(series.y_label)[0];

/** Of an error the lower is the better one: all series here are errors. */
export const toneOf = (stretch) => (stretch.difference > 0 ? "--bad" : "--good");

const seconds = (value) => String(Math.round(10 * value) / 10);

/** Each block flat from its begin to its end: {x, y, low, high}; the first and last reach to the drive's ends. */
export function steps(series) {
  const out = { x: [], y: [], low: [], high: [] };
  const half = 0.5 * series.block_length;
  const [, end] = ends(series);
  series.block_x.forEach((middle, k) => {
    const last = k + 1 === series.block_x.length;
    const from = k === 0 ? middle - half : out.x.at(-1) + 1e-6;
    out.x.push(from, last ? end : from + 2 * half - 1e-6);
    for (const [name, column] of [["y", "difference"], ["low", "low"], ["high", "high"]]) out[name].push(series[column][k], series[column][k]);
  });
  return out;
}

/** Where the charts of a drive begin and end: blocks and samples alike. */
export function ends(series) {
  const first = series.block_x[0] - 0.5 * series.block_length;
  const last = Math.max(series.x.at(-1) ?? first, ...series.stretches.map((stretch) => stretch.to));
  return [Math.min(first, series.x[0] ?? first), Math.max(last, series.block_x.at(-1))];
}

/** "3 to 7 s: B higher by 1.2 cm" */
export function stretchWords(series, stretch) {
  const [, unit] = splitLabel(series.y_label);
  const size = Math.abs(stretch.difference);
  const amount = unit === "m" ? formatLength(size) : `${formatNumber(size)}${unit ? ` ${unit}` : ""}`;
  return `${seconds(stretch.from)} to ${seconds(stretch.to)} s: B ${stretch.difference > 0 ? "higher" : "lower"} by ${amount}`;
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
  return `${name}: ${longest.map((stretch) => stretchWords(series, stretch)).join("; ")}${more > 0 ? `; and ${more} more` : ""}.`;
}

/** How the intervals were made, for people. */
export function levelWords(series, count) {
  const blocks = series.block_x.length;
  const block = series.block_length === 1 ? "a second" : `${formatNumber(series.block_length)} s`;
  return `Neighbouring sweeps err alike, so each seed's difference is averaged over ${block} first. The band is Student's interval over ${series.pairs} seeds at ${formatNumber(100 * series.level, 2)} % a second: `
    + `5 % shared by ${blocks} seconds${count > 1 ? ` and ${count} figures` : ""} (Bonferroni), so that all of the bands hold at once, and a shaded stretch is no accident of having looked at many.`
    + (series.pairs < 7 ? ` (Flipping signs would need no bell curve, but ${series.pairs} seeds have only ${2 ** series.pairs} patterns of signs: too few for this.)` : "");
}
