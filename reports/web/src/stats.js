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

/**
 * The k for which the k-th smallest and k-th largest of n values hold the true median with at least 90 % probability,
 * whatever the distribution, and that probability; {rank: 0} below five values, where no two of them do.
 */
export function medianRank(n) {
  let below = 0;  // P(Binomial(n, 1/2) < k)
  let term = 0.5 ** n;
  let best = { rank: 0, confidence: 0 };
  for (let k = 1; 2 * k <= n; ++k) {
    below += term;
    term *= (n - k + 1) / k;
    if (1 - 2 * below < 0.9) break;
    best = { rank: k, confidence: 1 - 2 * below };
  }
  return best;
}

/** Interval that holds the median (medianRank); the range where there are too few values for one. */
export function medianInterval(values) {
  const sorted = values.filter(isNumber).sort((a, b) => a - b);
  if (sorted.length === 0) return null;
  const k = Math.max(1, medianRank(sorted.length).rank);
  return [sorted[k - 1], sorted[sorted.length - k]];
}

/** Lowest and highest of all lines with their bands, with a margin and 0 inside; [0, 1] of nothing. */
export function extent(lines) {
  let low = 0;
  let high = 0;
  for (const line of lines) {
    for (const column of [line.y, line.low, line.high]) {
      for (const value of column ?? []) {
        if (!isNumber(value)) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  if (low === high) return [0, 1];
  const margin = 0.06 * (high - low);
  return [low < 0 ? low - margin : 0, high > 0 ? high + margin : 0];
}

/** The same for a logarithmic axis: of what lies above 0. */
export function logExtent(lines) {
  let low = Infinity;
  let high = 0;
  for (const line of lines) {
    for (const column of [line.y, line.low, line.high]) {
      for (const value of column ?? []) {
        if (!isNumber(value) || value <= 0) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
  }
  return high > 0 ? [low / 1.4, high * 1.4] : [0.1, 10];
}

/** Where 99 % of the dots are: a few wild sweeps must not press the others onto the axis. */
export function dotRange(lines) {
  const values = lines.flatMap((line) => line.y).filter(isNumber).sort((a, b) => a - b);
  if (values.length === 0) return [0, 1];
  const low = values[Math.floor(0.005 * (values.length - 1))];
  const high = values[Math.ceil(0.995 * (values.length - 1))];
  const margin = 0.08 * (high - low) || 1e-6;
  return [low - margin, high + margin];
}

/** x strictly ascending, as charts of points need it: sorted, and equal ones apart by less than a dot shows. */
export function ascending(x, y) {
  const order = x.map((_, i) => i).filter((i) => isNumber(x[i]) && isNumber(y[i])).sort((a, b) => x[a] - x[b]);
  if (order.length === 0) return { x: [], y: [] };
  const least = 1e-7 * (x[order[order.length - 1]] - x[order[0]] || 1);
  const out = { x: [], y: [] };
  for (const i of order) {
    const last = out.x[out.x.length - 1];
    out.x.push(last === undefined || x[i] > last ? x[i] : last + least);
    out.y.push(y[i]);
  }
  return out;
}

function sameGrid(a, b) {
  return a.length === b.length && a.every((value, i) => Math.abs(value - b[i]) <= 1e-6 * Math.max(1, Math.abs(value)));
}

/** Median over seeds with its interval (medianInterval), on the grid of the longest series. One series comes back as it is. */
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
    const between = medianInterval(values);
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
