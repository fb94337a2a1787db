// Stretches of a drive where something holds, and the directions that are free in them. No DOM here: tested by node.
import { formatNumber } from "./format.js";
import { isNumber } from "./stats.js";
import { listed } from "./words.js";

const kDirections = [["along_track", "along the track"], ["cross_track", "across the track"], ["height", "in height"], ["roll", "in roll"], ["pitch", "in pitch"], ["yaw", "in yaw"]];

/** Stretches of x in which y is at least `limit`; half a step is added at either end, so that single samples show. */
export function stretches(series, limit) {
  const { x, y } = series;
  const list = [];
  for (let i = 0; i < x.length; ++i) {
    if (!isNumber(y[i]) || y[i] < limit) continue;
    const before = i > 0 ? 0.5 * (x[i] - x[i - 1]) : 0;
    const after = i + 1 < x.length ? 0.5 * (x[i + 1] - x[i]) : 0;
    const last = list[list.length - 1];
    if (last && last.lastIndex === i - 1) Object.assign(last, { to: x[i] + after, lastIndex: i });
    else list.push({ from: x[i] - before, to: x[i] + after, firstIndex: i, lastIndex: i });
  }
  return list;
}

/** Directions of which at least half lies in the weak subspace on average over a stretch; the weakest when none does. */
export function weakDirections(seriesOf, prefix, { from, to }) {
  const shares = kDirections.map(([name, words]) => {
    const series = seriesOf(`${prefix}weak_${name}_vs_time`);
    const inside = series ? series.y.filter((value, i) => isNumber(value) && series.x[i] >= from && series.x[i] <= to) : [];
    return { words, share: inside.length ? inside.reduce((sum, value) => sum + value, 0) / inside.length : 0 };
  }).filter(({ share }) => share > 0);
  const weak = shares.filter(({ share }) => share >= 0.5);
  if (weak.length) return weak.map(({ words }) => words);
  const most = shares.reduce((best, one) => (one.share > (best?.share ?? 0) ? one : best), null);
  return most ? [most.words] : [];
}

/** "12.3 to 15.0 s: along the track and in yaw; 20.0 to 21.0 s: in yaw; and 3 shorter". */
export function describe(list, directionsOf, most = 4) {
  const longest = [...list].sort((a, b) => (b.to - b.from) - (a.to - a.from)).slice(0, most).sort((a, b) => a.from - b.from);
  const texts = longest.map((stretch) => {
    const directions = directionsOf(stretch);
    return `${formatNumber(stretch.from)} to ${formatNumber(stretch.to)} s${directions.length ? `: ${listed(directions)}` : ""}`;
  });
  const more = list.length - longest.length;
  return texts.join("; ") + (more > 0 ? `; and ${more} shorter` : "");
}
