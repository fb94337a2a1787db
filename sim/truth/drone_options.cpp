#include "sim/truth/drone.h"

namespace tarmac::sim::truth {

namespace {

struct Regime {
  const char* name;
  AirframeOptions airframe;
  double gust_m_s;
};

const std::vector<Regime>& regimes() {
  static const std::vector<Regime> all = {
      {"cruise", {}, 0.8},
      {"aggressive",
       {.hold_hz = 0.35, .jitter_deg = 1, .rotor_hz = 110, .rotor_rms_m_s2 = 1.4, .rotor_rms_deg_s = 1.8},
       1.5},
  };
  return all;
}

}  // namespace

std::vector<std::string> drone_regimes() {
  std::vector<std::string> names;
  for (const Regime& regime : regimes()) names.emplace_back(regime.name);
  return names;
}

DroneOptions::DroneOptions() {
  wander = {.lateral_rms_m = 0, .min_wavelength_m = 22, .max_wavelength_m = 70};
}

void ClimbOptions::visit(core::OptionVisitor& v) {
  v("at_m", at_m, "distance along the path at which it begins", {.at_least = 0});
  v("by_m", by_m, "change of height, up positive");
  v("over_m", over_m, "distance over which the height changes", {.above = 0});
}

void TakeOffOptions::visit(core::OptionVisitor& v) {
  v("legs_m", legs_m, "height of the body's origin over the ground while it stands", {.at_least = 0});
  v("height_m", height_m, "height over that at which the path is flown", {.above = 0});
  v("climb_m_s", climb_m_s, "fastest climb of the take-off", {.above = 0, .at_most = 10});
  v("spin_up_s", spin_up_s, "time before the take-off in which the rotors come up to speed", {.above = 0});
}

void WindOptions::visit(core::OptionVisitor& v) {
  v("mean_m_s", mean_m_s, "steady wind", {.at_least = 0, .at_most = 20});
  v("from_deg", from_deg, "where it comes from, from east, counter-clockwise");
  v("gust_m_s", gust_m_s, "rms of the gusts along each axis (Dryden's spectrum; vertical: half)",
    {.at_least = 0, .at_most = 5});
  v("gust_length_m", gust_length_m, "their length scale", {.at_least = 10, .at_most = 1000});
}

void AirframeOptions::visit(core::OptionVisitor& v) {
  v("drag_per_s", drag_per_s, "deceleration by drag per air speed", {.at_least = 0, .at_most = 1});
  v("hold_hz", hold_hz, "how fast the position is held against gusts", {.above = 0.01, .at_most = 2});
  v("hold_damping", hold_damping, "share of critical damping", {.above = 0, .at_most = 2});
  v("jitter_deg", jitter_deg, "rms of the attitude's jitter at 0.5 to 3 Hz, about each axis",
    {.at_least = 0, .at_most = 5});
  v("max_tilt_deg", max_tilt_deg, "more is an error", {.above = 0, .at_most = 80});
  v("rotor_hz", rotor_hz, "turns of the rotors", {.at_least = 20, .at_most = 250});
  v("blades", blades, "of a rotor", {.at_least = 2, .at_most = 6});
  v("rotor_rms_m_s2", rotor_rms_m_s2, "vibration of the rotors at the sensor, along each axis",
    {.at_least = 0, .at_most = 10});
  v("rotor_rms_deg_s", rotor_rms_deg_s, "the same about each axis", {.at_least = 0, .at_most = 20});
}

void DroneOptions::visit(core::OptionVisitor& v) {
  v.choice("regime", regime, drone_regimes(), "sets the defaults of airframe and of the gusts");
  CourseOptions::visit(v);
  v.group("take_off", take_off, "from the ground to the path's height, after rest_s");
  v.list("climbs", climbs, "changes of height along the path");
  v.group("wind", wind, "what it flies in");
  v.group("airframe", airframe, "how it answers");
}

DroneOptions read_drone_options(const core::ConfigNode& node) {
  DroneOptions options;
  if (const core::ConfigNode name = node.child("regime"); name.present()) {
    const std::string wanted = name.scalar("regime");
    for (const Regime& regime : regimes()) {
      if (wanted != regime.name) continue;
      options.airframe = regime.airframe;
      options.wind.gust_m_s = regime.gust_m_s;
    }
  }
  node.read(options, {"kind"});
  if (options.start.speed_m_s > 0) {
    node.child("start").fail_at("speed_m_s", "a drone begins on the ground: give its speeds in `speed`");
  }
  for (std::size_t i = 0; i < options.speed.size(); ++i) {
    if (options.speed[i].abs_m_s2 == 0) continue;
    node.child("speed").items().at(i).fail_at("abs_m_s2", "a drone has no wheels");
  }
  return options;
}

}  // namespace tarmac::sim::truth
