import assert from "node:assert/strict";
import test from "node:test";
import { change, changeText, formatP, isSignificant, largestChanges, matching, sparseTicks, tone, whereOf } from "../../../reports/web/src/changes.js";
import { placeOnAxis, ratioAxis } from "../../../reports/web/src/comparison.js";
import { ends, levelWords, seriesWords, steps, stretchWords, toneOf } from "../../../reports/web/src/located.js";
import { frame, pieces, scaleLength } from "../../../reports/web/src/pathmap.js";
import { differing } from "../../../reports/web/src/record.js";

const row = (metric, ratio, verdict, more = {}) => ({ case: "loop", a: "x", b: "x", metric, ratio, verdict, cost: false, words: verdict, ...more });

test("what changed most: significant rows by size of the change either way, then the rest, without costs", () => {
  const rows = [row("small", 1.1, "worse"), row("half", 0.5, "better"), row("chance", 30, "no_difference"), row("thrice", 3, "worse"),
    row("time", 100, "worse", { cost: true }), row("same", 1, "identical"), row("few", 9, "too_few"), row("none", null, "no_ratio")];
  const shown = largestChanges(rows, 2, 5);
  assert.deepEqual(shown.significant.map((r) => r.metric), ["thrice", "half"]);
  assert.deepEqual(shown.others.map((r) => r.metric), ["chance"]);
  assert.equal(shown.more, 1);
  assert.equal(change(row("", 0.5, "")), change(row("", 2, "")));
  assert.equal(change(row("", null, "")), null);
});

test("only what is more than chance has a colour", () => {
  for (const verdict of ["no_difference", "identical", "too_few", "no_ratio"]) {
    assert.equal(tone({ verdict, ratio: 20, low: 2, high: 90 }), "plain");
    assert.equal(isSignificant({ verdict }), false);
  }
  assert.equal(tone({ verdict: "better" }), "good");
  assert.equal(tone({ verdict: "worse" }), "bad");
  assert.equal(tone({ verdict: "different" }), "mixed");
});

test("changes in percent, factors where percents do not read", () => {
  assert.equal(changeText(1.123), "+12 %");
  assert.equal(changeText(0.95), "−5.0 %");
  assert.equal(changeText(1), "±0.00 %");
  assert.equal(changeText(25), "× 25.0");
  assert.equal(changeText(null), "n/a");
  assert.equal(formatP(3e-7), "< 0.0001");
  assert.equal(formatP(0.0412), "0.041");
  assert.equal(formatP(null), "n/a");
  assert.equal(whereOf(row("m", 1, "")), "loop · x");
  assert.equal(whereOf({ ...row("m", 1, ""), b: "y" }), "loop");
});

test("the filter wants all of its words, anywhere in a row", () => {
  const rows = [row("deskew_error_rms_m", 2, "worse"), row("ate_se3_rmse_m", 2, "worse")];
  assert.deepEqual(matching(rows, "Deskew worse").map((r) => r.metric), ["deskew_error_rms_m"]);
  assert.equal(matching(rows, "deskew better").length, 0);
  assert.equal(matching(rows, "").length, 2);
  assert.deepEqual(matching(rows, "rigid", { ate_se3_rmse_m: { meaning: "best rigid motion" } }).map((r) => r.metric), ["ate_se3_rmse_m"]);
});

test("ticks never stand closer than there is room for, and 1 is always there", () => {
  const axis = ratioAxis([{ ratio: 9, low: 8, high: 12 }]);
  const ticks = sparseTicks(axis, 20);
  assert.ok(ticks.includes(1) && ticks.length > 1 && ticks.length < axis.ticks.length);
  for (let k = 1; k < ticks.length; ++k) assert.ok(placeOnAxis(axis, ticks[k]) - placeOnAxis(axis, ticks[k - 1]) >= 20);
  assert.deepEqual(sparseTicks(axis, 0), axis.ticks);
});

test("an axis may reach farther than a factor of 20 where the figure wants it", () => {
  const axis = ratioAxis([{ ratio: 300, low: 200, high: 400 }], 1000);
  assert.ok(axis.high > 400 && axis.ticks.includes(100));
});

const series = { name: "deskew_error_vs_time", x_label: "time [s]", y_label: "deskew error [m]", pairs: 5, level: 0.0025, block_length: 1,
  x: [0.1, 1, 2.2], a: [1, 1, 1], b: [2, 2, 2], block_x: [0.5, 1.6], difference: [0.1, -0.2], low: [0.05, -0.3], high: [0.15, -0.1],
  stretches: [{ from: 0, to: 1, difference: 0.1 }, { from: 1, to: 2.2, difference: -0.2 }] };

test("blocks are drawn flat from their begin to their end", () => {
  const drawn = steps(series);
  assert.deepEqual(drawn.y, [0.1, 0.1, -0.2, -0.2]);
  assert.deepEqual(drawn.low, [0.05, 0.05, -0.3, -0.3]);
  assert.equal(drawn.x[0], 0);
  assert.ok(Math.abs(drawn.x[1] - 1) < 1e-5 && Math.abs(drawn.x[2] - 1) < 1e-5 && drawn.x[2] > drawn.x[1]);
  assert.equal(drawn.x[3], 2.2);
  assert.deepEqual(ends(series), [0, 2.2]);
});

test("stretches in words, and why there are none", () => {
  assert.equal(stretchWords(series, series.stretches[0]), "0 to 1 s: B higher by 10.0 cm");
  assert.equal(stretchWords(series, series.stretches[1]), "1 to 2.2 s: B lower by 20.0 cm");
  assert.equal(toneOf(series.stretches[0]), "--bad");
  assert.equal(toneOf(series.stretches[1]), "--good");
  assert.match(seriesWords({ located: true }, series), /^Deskew error: 0 to 1 s: B higher by 10.0 cm; 1 to 2.2 s/);
  const none = { ...series, stretches: [] };
  assert.match(seriesWords({ located: false }, none), /no metric of this method on this case differs significantly/);
  assert.match(seriesWords({ located: true }, none), /no stretch stands out/);
  assert.match(seriesWords({ located: true }, { ...none, pairs: 2 }), /2 seeds with both, at least 3/);
});

test("the level is explained with its figures", () => {
  const words = levelWords(series, 2);
  assert.match(words, /0\.25 % a second/);
  assert.match(words, /5 % shared by 2 seconds and 2 figures/);
  assert.match(words, /32 patterns/);
  assert.doesNotMatch(levelWords({ ...series, pairs: 10 }, 2), /patterns/);
});

test("a stretch takes the samples of its time, and the one before", () => {
  const path = { t: [1, 2, 3, 4], x: [10, 20, 30, null], y: [0, 0, 0, 0] };
  assert.deepEqual(pieces(path, [{ from: 2, to: 3 }])[0].points, [[10, 0], [20, 0], [30, 0]]);
  assert.deepEqual(pieces(path, [{ from: 2.5, to: 5 }])[0].points, [[20, 0], [30, 0]]);
  assert.deepEqual(pieces(path, [{ from: 9, to: 10 }])[0].points, []);
});

test("the path's frame has room and is never a slit; its scale is round", () => {
  const box = frame({ x: [0, 100], y: [5, 5] });
  assert.ok(box.x < 0 && box.x + box.width > 100 && box.height >= 25);
  assert.equal(frame({ x: [], y: [] }), null);
  assert.equal(scaleLength(116), 20);
  assert.equal(scaleLength(40), 5);
  assert.equal(scaleLength(5), 1);
});

test("what differs between two provenances: options line by line, times apart", () => {
  const text = (iterations, commit) => JSON.stringify({ seed: 1, made_at: `t${iterations}`, command: `c${commit}`, build: { commit },
    options: `kiss-icp:\n    max_iterations: ${iterations}\n    voxel_size_m: 1\nct-icp:\n    max_iterations: 5\n` });
  assert.deepEqual(differing(text(500, "aa"), text(1, "bb")), [["build.commit", "aa", "bb"], ["options kiss-icp max_iterations", "500", "1"]]);
  assert.deepEqual(differing(text(1, "a"), text(1, "a")), []);
});
