import assert from "node:assert/strict";
import test from "node:test";
import { describe, stretches, weakDirections } from "../../../reports/web/src/stretches.js";

test("stretches join neighbours, split at gaps and keep single samples wide enough to see", () => {
  const series = { x: [0, 1, 2, 3, 4, 5, 6], y: [2, 2, 0, null, 2, 1, 2] };
  assert.deepEqual(stretches(series, 2).map(({ from, to }) => [from, to]), [[0, 1.5], [3.5, 4.5], [5.5, 6]]);
  assert.deepEqual(stretches(series, 1).map(({ from, to }) => [from, to]), [[0, 1.5], [3.5, 6]]);
  assert.deepEqual(stretches({ x: [], y: [] }, 1), []);
});

test("the free directions of a stretch are those that lie at least half in the weak subspace", () => {
  const x = [0, 1, 2, 3];
  const all = { oracle_weak_along_track_vs_time: { x, y: [0, 1, 0.8, 0] }, oracle_weak_yaw_vs_time: { x, y: [0, 0.3, 0.5, 1] }, oracle_weak_roll_vs_time: { x, y: [1, 0.7, 0.9, 1] } };
  const seriesOf = (name) => all[name];
  assert.deepEqual(weakDirections(seriesOf, "oracle_", { from: 0.5, to: 2.5 }), ["along the track", "in roll"]);
  assert.deepEqual(weakDirections((name) => (name.includes("yaw") ? all.oracle_weak_yaw_vs_time : undefined), "oracle_", { from: 0.5, to: 2.5 }), ["in yaw"], "the weakest when none reaches a half");
  assert.deepEqual(weakDirections(() => undefined, "", { from: 0, to: 1 }), []);
});

test("the longest stretches are told in order, the others counted", () => {
  const list = [{ from: 0, to: 1 }, { from: 2, to: 5 }, { from: 6, to: 6.2 }, { from: 8, to: 10 }];
  assert.equal(describe(list, () => ["in yaw"], 2), "2.00 to 5.00 s: in yaw; 8.00 to 10.0 s: in yaw; and 2 shorter");
  assert.equal(describe(list.slice(0, 1), () => []), "0 to 1.00 s");
});
