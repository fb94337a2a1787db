import assert from "node:assert/strict";
import test from "node:test";
import { bestReference, judged, placeOnAxis, ratioAxis } from "../../../reports/web/src/comparison.js";

const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

test("the axis of ratios holds 1 in its middle and every interval, up to a factor of 20", () => {
  const axis = ratioAxis([{ ratio: 0.5, low: 0.25, high: 1.1 }, { ratio: 2, low: null, high: null }]);
  near(placeOnAxis(axis, 1), 50);
  near(axis.low * axis.high, 1);
  assert.ok(axis.low < 0.25 && axis.high > 4);
  near(placeOnAxis(axis, 4) - 50, 50 - placeOnAxis(axis, 0.25));
  assert.ok(axis.ticks.includes(1) && axis.ticks.every((tick) => tick > axis.low && tick < axis.high));
  const wide = ratioAxis([{ ratio: 100, low: 1e-3, high: 1e6 }]);
  assert.ok(wide.high < 25);
  assert.equal(placeOnAxis(wide, 1e6), 100);
  assert.equal(placeOnAxis(wide, 1e-3), 0);
});

test("only what is significant is called a difference", () => {
  assert.deepEqual(judged({ difference: "lower", p: 0.001 }), ["lower", "good"]);
  assert.deepEqual(judged({ difference: "higher", p: 0.001 }), ["higher", "bad"]);
  assert.deepEqual(judged({ difference: "not_significant", p: 0.4 }), ["no significant difference", "plain"]);
  assert.deepEqual(judged({ difference: "not_significant", p: 0.03 }), ["not settled: several pairs", "plain"]);
  assert.deepEqual(judged({ difference: "too_few", p: 1, pairs: 2 }), ["too few seeds (2)", "plain"]);
});

test("compared is with the best of those that can be compared", () => {
  const run = (estimator, value) => ({ estimator, seed: 1, status: "ok", rows: [{ metric: "end_error_percent", value, status: "ok" }] });
  const data = { estimators: ["a", "b", "alone"], runs: [run("a", 2), run("b", 1), run("alone", 0.1)],
    comparisons: [{ a: "a", b: "b" }, { a: "b", b: "a" }] };
  assert.equal(bestReference(data), "b");
});
