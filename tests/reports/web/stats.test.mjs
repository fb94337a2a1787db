import assert from "node:assert/strict";
import test from "node:test";
import { combine, interpolate, median, nearestIndex, range, sortRows } from "../../../reports/web/src/stats.js";

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
