import assert from "node:assert/strict";
import test from "node:test";
import { unpack } from "../../../reports/web/src/data.js";
import { filledColumns, whyMissing } from "../../../reports/web/src/tables.js";

test("series that share an x get it back by its number", () => {
  const data = unpack({ grids: [[0, 1], [5, 6, 7]], runs: [{ series: { a: { x: 1, y: [1, 2, 3] } } }], truth: { 1: { t: { x: 0, y: [1, 2] } } } });
  assert.deepEqual(data.runs[0].series.a.x, [5, 6, 7]);
  assert.deepEqual(data.truth[1].t.x, [0, 1]);
});

test("a column without any value gives way and says why", () => {
  const rows = (error, time) => ({ rows: [
    { metric: "error", value: error, status: error === null ? "n/a: the recording has no truth" : "ok" },
    { metric: "shift", value: null, status: "n/a: the recording has no truth" },
    { metric: "time", value: time, status: "ok" }] });
  const wanted = [["error", "End error"], ["shift", "Shift"], ["time", "Time"], ["never", "Never"]];
  const alone = filledColumns([rows(null, 3), rows(null, 4)], wanted);
  assert.deepEqual(alone.shown, [["time", "Time"]]);
  assert.equal(whyMissing(alone.missing), "No end error or shift: the recording has no truth.");
  const one = filledColumns([rows(null, 3), rows(0.5, 4)], wanted);
  assert.deepEqual(one.shown.map(([metric]) => metric), ["error", "time"]);
  assert.equal(whyMissing([]), "");
});
