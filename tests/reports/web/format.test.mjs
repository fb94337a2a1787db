import assert from "node:assert/strict";
import test from "node:test";
import { formatLength, formatNumber, formatRange, formatTick, logTicks, splitLabel } from "../../../reports/web/src/format.js";

test("numbers have three significant digits and a true minus", () => {
  assert.equal(formatNumber(0.012345), "0.0123");
  assert.equal(formatNumber(123.456), "123");
  assert.equal(formatNumber(-1.5), "−1.50");
  assert.equal(formatNumber(0), "0");
  assert.equal(formatNumber(1.5e-7), "1.5e-7");
  for (const missing of [null, undefined, NaN]) assert.equal(formatNumber(missing), "n/a");
});

test("tick labels tell neighbours apart", () => {
  for (const step of [0.025, 0.25, 2.5, 0.5, 1, 20]) {
    const labels = [0, 1, 2, 3, 4].map((k) => formatTick(k * step, step));
    labels.forEach((label, k) => assert.ok(Math.abs(Number(label) - k * step) < 1e-9, label));
  }
});

test("logarithmic ticks lie inside and rise", () => {
  const ticks = logTicks(0.03, 4);
  assert.deepEqual(ticks, [0.05, 0.1, 0.2, 0.5, 1, 2]);
  assert.deepEqual(logTicks(1e-6, 1e3).every((tick) => Math.abs(Math.log10(tick) % 1) < 1e-9), true);
  assert.deepEqual(logTicks(0.02, 30), [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20]);
  assert.deepEqual(logTicks(0, 1), []);
});

test("lengths take the unit that suits them", () => {
  assert.equal(formatLength(0.0123), "1.23 cm");
  assert.equal(formatLength(0.00123), "1.23 mm");
  assert.equal(formatLength(12.3), "12.3 m");
});

test("labels split into name and unit", () => {
  assert.deepEqual(splitLabel("position error [m]"), ["position error", "m"]);
  assert.deepEqual(splitLabel("iterations [1]"), ["iterations", ""]);
  assert.deepEqual(splitLabel("phase (0 = first)"), ["phase (0 = first)", ""]);
});

test("a range of equals is one number", () => {
  assert.equal(formatRange([100, 100]), "100");
  assert.equal(formatRange([0.1, 0.2]), "0.100–0.200");
});
