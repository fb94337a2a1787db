// Findings of several runs as one. No DOM here: tested by node.
import { capitalize } from "./format.js";
import { isNumber, median } from "./stats.js";

const kOrder = ["found", "cannot be told", "nothing found"];

/** A run's findings of a topic as one: several that are found (stretches of a drive) are told one after the other. */
function ofRun(run, topic, most = 4) {
  const list = (run.findings ?? []).filter((finding) => finding.topic === topic);
  if (list.length === 0) return null;
  const verdict = kOrder.find((one) => list.some((finding) => finding.verdict === one)) ?? list[0].verdict;
  const same = list.filter((finding) => finding.verdict === verdict);
  const words = same.slice(0, most).map((finding) => finding.words).join(" ");
  return { seed: run.seed, verdict, words: same.length > most ? `${words} And ${same.length - most} more.` : words,
    evidence: same.length === 1 ? same[0].evidence ?? [] : [] };
}

/**
 * One topic of one method over its runs: found when any run has it, else the verdict of most; how many share it, and
 * the words and evidence of the first of those; numbers as the median over them.
 */
export function gatherFinding(runs, topic) {
  const all = runs.map((run) => ofRun(run, topic)).filter(Boolean);
  if (all.length === 0) return null;
  const count = (verdict) => all.filter((finding) => finding.verdict === verdict).length;
  const verdict = count("found") > 0 ? "found" : kOrder.reduce((best, one) => (count(one) > count(best) ? one : best));
  const same = all.filter((finding) => finding.verdict === verdict);
  const numbers = (same[0].evidence ?? []).map((number) => {
    const values = same.map((finding) => finding.evidence.find((other) => other.name === number.name)?.value);
    return same.length === 1 ? number : { name: number.name, unit: number.unit, value: median(values), over: values.filter(isNumber).length };
  });
  return { topic, verdict, count: same.length, of: all.length, words: same[0].words, seed: same[0].seed, evidence: numbers };
}

export function topicsOf(data) {
  return [...new Set(data.runs.flatMap((run) => (run.findings ?? []).map((finding) => finding.topic)))];
}

export const titleOf = (topic) => capitalize(topic.replaceAll("-", " "));
