import assert from "node:assert/strict";
import test from "node:test";
import { gatherFinding, titleOf, topicsOf } from "../../../reports/web/src/diagnosis.js";

const finding = (topic, verdict, words, value) => ({ topic, verdict, words, evidence: value === undefined ? [] : [{ name: "lag", value, unit: "ms", low: 0, high: 9 }] });

test("what any seed has is found, and says on how many", () => {
  const runs = [{ seed: 1, findings: [finding("x", "nothing found", "no", 0)] }, { seed: 2, findings: [finding("x", "found", "yes", 5)] },
    { seed: 3, findings: [finding("x", "nothing found", "no", 0)] }, { seed: 4 }];
  const found = gatherFinding(runs, "x");
  assert.equal(found.verdict, "found");
  assert.deepEqual([found.count, found.of, found.words, found.seed], [1, 3, "yes", 2]);
  assert.equal(found.evidence[0].high, 9, "one run's numbers keep their interval");
  assert.equal(gatherFinding(runs, "y"), null);
});

test("numbers of several seeds are their median, without an interval", () => {
  const runs = [1, 2, 9].map((value, k) => ({ seed: k + 1, findings: [finding("x", "found", "yes", value)] }));
  assert.deepEqual(gatherFinding(runs, "x").evidence, [{ name: "lag", unit: "ms", value: 2, over: 3 }]);
});

test("ignorance outranks innocence when seeds are split evenly", () => {
  const runs = [{ seed: 1, findings: [finding("x", "nothing found", "no")] }, { seed: 2, findings: [finding("x", "cannot be told", "?")] }];
  assert.equal(gatherFinding(runs, "x").verdict, "cannot be told");
});

test("a run with several stretches counts once and tells them all, within reason", () => {
  const many = ["a.", "b.", "c.", "d.", "e.", "f."].map((words) => finding("degeneracy", "found", words));
  const found = gatherFinding([{ seed: 1, findings: many }], "degeneracy");
  assert.deepEqual([found.count, found.of, found.words], [1, 1, "a. b. c. d. And 2 more."]);
});

test("topics keep their order and read as titles", () => {
  assert.deepEqual(topicsOf({ runs: [{}, { findings: [finding("b-c", "found", ""), finding("a", "found", "")] }, { findings: [finding("a", "found", "")] }] }), ["b-c", "a"]);
  assert.equal(titleOf("stamp-scale"), "Stamp scale");
});
