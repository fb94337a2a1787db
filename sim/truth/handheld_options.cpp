#include "sim/truth/handheld_options.h"

namespace tarmac::sim::truth {

namespace {

struct NamedGait {
  const char* name;
  GaitOptions gait;
};

/// The middle of what gait studies report for the trunk at 1.3, 1.7 and 3 m/s (Winter; Kavanagh), with the strikes that
/// are left of the heels' at the hand.
const std::vector<NamedGait>& gaits() {
  static const std::vector<NamedGait> all = {
      {"walk", {}},
      {"brisk",
       {.step_length_m = 0.79,
        .full_speed_m_s = 1.1,
        .vertical_m = 0.055,
        .lateral_m = 0.055,
        .surge_m_s = 0.25,
        .roll_rms_deg = 3.2,
        .pitch_rms_deg = 3.2,
        .yaw_deg = 6.5,
        .strike_m_s2 = 6}},
      {"run",
       {.step_length_m = 1.09,
        .full_speed_m_s = 2,
        .vertical_m = 0.09,
        .lateral_m = 0.03,
        .surge_m_s = 0.25,
        .roll_rms_deg = 5,
        .pitch_rms_deg = 5,
        .yaw_deg = 10,
        .strike_m_s2 = 12}},
  };
  return all;
}

}  // namespace

std::vector<std::string> gait_names() {
  std::vector<std::string> names;
  for (const NamedGait& gait : gaits()) names.emplace_back(gait.name);
  return names;
}

HandheldOptions::HandheldOptions() {
  stop_peak_m_s2 = 0.8;
  jitter = {.speed_fraction_rms = 0.03, .min_wavelength_m = 3, .max_wavelength_m = 25};
  wander = {.lateral_rms_m = 0.04, .min_wavelength_m = 6, .max_wavelength_m = 20};
}

void GaitOptions::visit(core::OptionVisitor& v) {
  v("step_length_m", step_length_m, "length of a step", {.above = 0.2, .at_most = 2});
  v("full_speed_m_s", full_speed_m_s, "speed from which on the swing is full; below it fades", {.above = 0});
  v("vertical_m", vertical_m, "rise and fall with the steps, peak to peak", {.at_least = 0, .at_most = 0.2});
  v("lateral_m", lateral_m, "sideways swing with the strides, peak to peak", {.at_least = 0, .at_most = 0.2});
  v("surge_m_s", surge_m_s, "ripple of the speed with the steps at 1.4 full_speed_m_s, half of peak to peak",
    {.at_least = 0, .at_most = 1});
  v("roll_rms_deg", roll_rms_deg, "roll with strides and steps", {.at_least = 0, .at_most = 20});
  v("pitch_rms_deg", pitch_rms_deg, "pitch with steps and strides", {.at_least = 0, .at_most = 20});
  v("yaw_deg", yaw_deg, "yaw with the strides, peak to peak", {.at_least = 0, .at_most = 40});
  v("strike_m_s2", strike_m_s2, "peak acceleration that a heel's strike makes at the device, upward",
    {.at_least = 0, .at_most = 60});
  v("strike_hz", strike_hz, "frequency at which a strike rings", {.at_least = 10, .at_most = 40});
  v("strike_damping", strike_damping, "share of critical damping", {.at_least = 0.1, .at_most = 0.9});
  v("rate_jitter", rate_jitter, "standard deviation of the step's duration, as a share of it",
    {.at_least = 0, .at_most = 0.1});
}

void HoldOptions::visit(core::OptionVisitor& v) {
  v("height_m", height_m, "height of the device's origin over the ground", {.above = 0, .at_most = 3});
  v("ahead_m", ahead_m, "distance of the device from the axis about which the person turns", {.at_least = 0});
  v("tilt_deg", tilt_deg, "steady pitch, downward positive", {.at_least = -60, .at_most = 60});
  v("tremor_deg", tremor_deg, "rms of the hands' tremor at 8 to 12 Hz, about each axis", {.at_least = 0, .at_most = 1});
  v("tremor_m_s2", tremor_m_s2, "the same along each axis", {.at_least = 0, .at_most = 2});
  v("posture_deg", posture_deg, "rms of slow changes of attitude while walking, about each axis (standing: a sixth)",
    {.at_least = 0, .at_most = 10});
  v("posture_m", posture_m, "the same along each axis", {.at_least = 0, .at_most = 0.1});
}

void LookOptions::visit(core::OptionVisitor& v) {
  v("at_s", at_s, "when it begins", {.at_least = 0});
  v("left_deg", left_deg, "how far to the left (below 0: right first)", {.at_least = -120, .at_most = 120});
  v("right_deg", right_deg, "how far to the right after that", {.at_least = -120, .at_most = 120});
  v("period_s", period_s, "duration of the whole; the fastest turn is 4 (left_deg + right_deg) / period_s",
    {.above = 0.5});
}

void HandheldOptions::visit(core::OptionVisitor& v) {
  v.choice("gait_name", gait_name, gait_names(), "sets the defaults of gait");
  CourseOptions::visit(v);
  v.group("gait", gait, "how the device swings with the steps");
  v.group("hold", hold, "how it is held");
  v.list("looks", looks, "looks around");
}

HandheldOptions read_handheld_options(const core::ConfigNode& node) {
  HandheldOptions options;
  if (const core::ConfigNode name = node.child("gait_name"); name.present()) {
    const std::string wanted = name.scalar("gait_name");
    for (const NamedGait& gait : gaits()) {
      if (wanted == gait.name) options.gait = gait.gait;
    }
  }
  node.read(options, {"kind"});
  return options;
}

}  // namespace tarmac::sim::truth
