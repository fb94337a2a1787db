// What several seeds say together. No DOM here: tested by node.

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

export function median(values) {
  const sorted = values.filter(isNumber).sort((a, b) => a - b);
  if (sorted.length === 0) return null;
  const middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

export function range(values) {
  const finite = values.filter(isNumber);
  return finite.length ? [Math.min(...finite), Math.max(...finite)] : null;
}

/** Index of the element of ascending `sorted` that is nearest to x. */
export function nearestIndex(sorted, x) {
  if (sorted.length === 0) return -1;
  let low = 0;
  let high = sorted.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (sorted[middle] <= x) low = middle;
    else high = middle;
  }
  return Math.abs(sorted[high] - x) < Math.abs(x - sorted[low]) ? high : low;
}

/** y at x by a straight line between neighbours; null outside and beside a gap. */
export function interpolate(series, x) {
  const { x: xs, y: ys } = series;
  if (xs.length === 0 || x < xs[0] || x > xs[xs.length - 1]) return null;
  const k = nearestIndex(xs, x);
  if (xs[k] === x) return ys[k];
  const a = xs[k] < x ? k : k - 1;
  if (!isNumber(ys[a]) || !isNumber(ys[a + 1])) return null;
  const share = (x - xs[a]) / (xs[a + 1] - xs[a]);
  return ys[a] + share * (ys[a + 1] - ys[a]);
}

function sameGrid(a, b) {
  return a.length === b.length && a.every((value, i) => Math.abs(value - b[i]) <= 1e-6 * Math.max(1, Math.abs(value)));
}

/** Median with smallest and largest over seeds, on the grid of the longest series. One series comes back as it is. */
export function combine(list) {
  const filled = list.filter((series) => series && series.x.length > 0);
  if (filled.length === 0) return null;
  if (filled.length === 1) return filled[0];
  const grid = filled.reduce((best, series) => (series.x.length > best.x.length ? series : best)).x;
  const columns = filled.map((series) =>
    sameGrid(series.x, grid) ? series.y : grid.map((x) => interpolate(series, x)));
  const y = [], low = [], high = [];
  for (let i = 0; i < grid.length; ++i) {
    const values = columns.map((column) => column[i]);
    const between = range(values);
    y.push(median(values));
    low.push(between ? between[0] : null);
    high.push(between ? between[1] : null);
  }
  return { ...filled[0], x: grid, y, low, high, seeds: filled.length };
}

/** Sorts rows by key(row); n/a comes last in either direction; equal rows keep their order. */
export function sortRows(rows, key, ascending) {
  const missing = (value) => value === null || value === undefined || Number.isNaN(value);
  return rows
    .map((row, place) => ({ row, place, value: key(row) }))
    .sort((a, b) => {
      if (missing(a.value) !== missing(b.value)) return missing(a.value) ? 1 : -1;
      if (missing(a.value)) return a.place - b.place;
      const order = typeof a.value === "string" ? a.value.localeCompare(b.value) : a.value - b.value;
      return (ascending ? order : -order) || a.place - b.place;
    })
    .map((entry) => entry.row);
}
