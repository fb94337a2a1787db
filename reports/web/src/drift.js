// How errors grow along the drive, and in which direction.
import { el } from "./dom.js";
import { chart, figure, pair } from "./figures.js";
import { panels } from "./panels.js";
import { SummaryTable } from "./tables.js";
import { seedBand } from "./words.js";

const kDirections = ["along", "cross", "height", "yaw", "tilt"];

const kColumns = [
  ["kitti_trans_percent", "KITTI translation"],
  ["kitti_rot_deg_per_100m", "KITTI rotation"],
  ["drift_50m_along_rms_m", "Along, 50 m"],
  ["drift_50m_cross_rms_m", "Across, 50 m"],
  ["drift_50m_height_rms_m", "Height, 50 m"],
  ["drift_50m_yaw_rms_deg", "Yaw, 50 m"],
  ["drift_50m_tilt_rms_deg", "Tilt, 50 m"],
  ["time_lag_ms", "Time lag"],
];

function split(state) {
  const own = state.data.seeds.length === 1;
  const band = own ? " The band holds 5 to 95 % of the stretches." : seedBand(state);
  const names = (pattern) => kDirections.map((direction) => pattern.replace("*", direction));
  return panels(state, "Drift by direction", [
    { label: "By distance", names: names("drift_*_vs_distance"), band: own,
      reading: `Each panel is one direction of the error over stretches of the given length, on one scale for metres and one for degrees: the panel that climbs is where the method loses its way, and a method that only turns wrongly climbs across the track too.${band}` },
    { label: "By duration", names: names("drift_*_vs_duration"), band: own,
      reading: `The same over stretches of the given duration: unlike by distance, a method that drifts while the vehicle stands still shows here.${band}` },
    { label: "Along the drive", names: names("error_*_vs_time"), signed: true,
      reading: `The signed error at each moment, in the directions of the true heading: ahead, left, up and turned left are positive; a step marks a moment, a slope a steady loss.${seedBand(state)}` },
  ], { columns: "five" });
}

function table(state) {
  const filled = new SummaryTable(state, kColumns);
  if (filled.columns.length === 0) return null;
  return [filled.element, el("p", { class: "reading" },
    "Means over all stretches: of 100 to 800 m by KITTI's rule, and root mean squares over stretches of 50 m by direction; lower is better, a lamp marks the best, and every column sorts.",
    filled.missing ? ` ${filled.missing}` : "")];
}

export function drift(state) {
  const whole = chart(state, "drift_vs_distance", { band: state.data.seeds.length === 1 })?.element;
  const along = chart(state, "error_vs_distance")?.element;
  return [pair(
    along && figure("Error along the way", `Read from left to right as the vehicle drives: a line that climbs steadily drifts, a step marks the place where something went wrong.${seedBand(state)}`, along),
    whole && figure("Drift against distance", `For every stretch of the given length the method's motion is compared with the true one: flat means that errors cancel, a straight slope means that they add up.${state.data.seeds.length === 1 ? " The band holds 5 to 95 % of the stretches." : seedBand(state)}`, whole)),
  split(state), ...(table(state) ?? [])];
}
