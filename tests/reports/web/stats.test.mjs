import assert from "node:assert/strict";
import test from "node:test";
import { ascending, combine, dotRange, extent, interpolate, logExtent, median, medianInterval, medianRank, nearestIndex, range, sortRows } from "../../../reports/web/src/stats.js";
import { listed, seedBand } from "../../../reports/web/src/words.js";

test("median and range leave gaps out", () => {
  assert.equal(median([3, null, 1, 2]), 2);
  assert.equal(median([4, 1, 2, 3]), 2.5);
  assert.equal(median([null]), null);
  assert.deepEqual(range([NaN, 2, -1]), [-1, 2]);
  assert.equal(range([]), null);
});

test("interpolation stops at gaps and ends", () => {
  const series = { x: [0, 1, 2, 3], y: [0, 10, null, 30] };
  assert.equal(interpolate(series, 0.25), 2.5);
  assert.equal(interpolate(series, 1), 10);
  assert.equal(interpolate(series, 1.5), null);
  assert.equal(interpolate(series, 4), null);
});

test("several seeds give a median with their range, on a common grid", () => {
  const a = { x: [0, 1, 2], y: [1, 2, 3] };
  const b = { x: [0, 0.5, 1, 1.5, 2], y: [3, 3, 3, 3, 3] };
  const c = { x: [0, 2], y: [5, 7] };
  const all = combine([a, b, undefined, c]);
  assert.deepEqual(all.x, b.x);
  assert.deepEqual(all.y, [3, 3, 3, 3, 3]);
  assert.deepEqual(all.low, [1, 1.5, 2, 2.5, 3]);
  assert.deepEqual(all.high, [5, 5.5, 6, 6.5, 7]);
  assert.equal(all.seeds, 3);
  assert.equal(combine([undefined, a]), a);
  assert.equal(combine([]), null);
});

test("the nearest sample is found at both ends and between", () => {
  const x = [0, 1, 4];
  assert.deepEqual([-5, 0.4, 0.6, 2.6, 9].map((v) => nearestIndex(x, v)), [0, 0, 1, 2, 2]);
});

test("sorting puts n/a last either way and keeps equals in order", () => {
  const rows = [{ n: "a", v: 2 }, { n: "b", v: null }, { n: "c", v: 1 }, { n: "d", v: 2 }];
  const names = (ascending) => sortRows(rows, (row) => row.v, ascending).map((row) => row.n).join("");
  assert.equal(names(true), "cadb");
  assert.equal(names(false), "adcb");
});

test("the median's interval is the widest pair of order statistics of at least 90 %", () => {
  assert.deepEqual(medianRank(4), { rank: 0, confidence: 0 });
  assert.deepEqual(medianRank(5), { rank: 1, confidence: 1 - 2 / 32 });
  assert.deepEqual(medianRank(10), { rank: 2, confidence: 1 - 2 * (1 + 10) / 1024 });
  assert.deepEqual(medianInterval([3, 1, null, 2]), [1, 3], "too few: the range");
  assert.deepEqual(medianInterval([9, 1, 2, 3, 4, 5, 6, 7, 8, 10]), [2, 9]);
  assert.equal(medianInterval([null]), null);
});

test("axes hold lines and bands, and 0 where they are linear", () => {
  const lines = [{ y: [1, null, 3], high: [1, 2, 5], low: [0.5, 1, 2] }, { y: [-2] }];
  const [low, high] = extent(lines);
  assert.ok(low < -2 && high > 5);
  assert.deepEqual(extent([{ y: [4] }])[0], 0);
  assert.deepEqual(extent([]), [0, 1]);
  assert.deepEqual(logExtent(lines), [0.5 / 1.4, 5 * 1.4]);
  assert.deepEqual(logExtent([{ y: [0, -1] }]), [0.1, 10]);
});

test("points that share an x are told apart, and gaps are left out", () => {
  const { x, y } = ascending([3, 1, 1, null, 1, 2], [30, 10, 11, 5, null, 20]);
  assert.deepEqual(y, [10, 11, 20, 30]);
  x.forEach((value, i) => assert.ok(i === 0 || value > x[i - 1]));
  assert.ok(Math.abs(x[1] - 1) < 1e-5);
  assert.deepEqual(ascending([], []), { x: [], y: [] });
});

test("a few wild dots do not set the axis", () => {
  const y = [...Array(1000).keys()].map((k) => k / 1000);
  const [low, high] = dotRange([{ y: [...y, 1e6, -1e6] }]);
  assert.ok(low > -0.2 && high < 1.2);
  assert.deepEqual(dotRange([]), [0, 1]);
});

test("sentences say what the band is", () => {
  const of = (n) => seedBand({ data: { seeds: [...Array(n).keys()] } });
  assert.equal(of(1), "");
  assert.match(of(3), /median of 3 seeds and the band their range: too few/);
  assert.match(of(5), /their range, holds the median of all such drives with 93 % confidence/);
  assert.match(of(10), /2nd lowest to the 2nd highest.*97 %/);
  assert.equal(listed(["a", "b", "c"]), "a, b and c");
});
