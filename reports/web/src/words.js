// Sentences that several figures share. No DOM here: tested by node.
import { medianRank } from "./stats.js";

/** What line and band are over several seeds; nothing of one seed. */
export function seedBand(state) {
  const n = state.data.seeds.length;
  if (n < 2) return "";
  const { rank, confidence } = medianRank(n);
  if (rank === 0) return ` The line is the median of ${n} seeds and the band their range: too few for a confidence.`;
  const which = rank === 1 ? "their range" : `from the ${ordinal(rank)} lowest to the ${ordinal(rank)} highest`;
  return ` The line is the median of ${n} seeds; the band, ${which}, holds the median of all such drives with ${Math.floor(100 * confidence)} % confidence.`;
}

export function ordinal(n) {
  const ending = n % 100 >= 11 && n % 100 <= 13 ? "th" : ["th", "st", "nd", "rd"][n % 10] ?? "th";
  return `${n}${ending}`;
}

/** "a", "a and b", "a, b and c". */
export function listed(names) {
  return names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}`;
}
