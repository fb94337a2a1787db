#include "sim/truth/drive_options.h"

#include "sim/truth/vehicles.h"

namespace tarmac::sim::truth {

void RoadOptions::visit(core::OptionVisitor& v) {
  v.choice("roughness", roughness, {"none", "A", "B", "C", "D"}, "ISO 8608 class of the pavement");
  v("waves", waves, "sines that the roughness is made of", {.at_least = 200, .at_most = 2000});
  v("contact_m", contact_m, "length of a tyre's contact patch, which averages the road",
    {.at_least = 0, .at_most = 0.5});
  v("joint_spacing_m", joint_spacing_m, "distance between slab joints (0: none)", {.at_least = 0});
  v("joint_depth_m", joint_depth_m, "how far a wheel sinks into a joint", {.at_least = -0.1, .at_most = 0.1});
  v("joint_length_m", joint_length_m, "joint and contact patch together", {.above = 0.01, .at_most = 2});
}

void SuspensionOptions::visit(core::OptionVisitor& v) {
  const core::Range hz{.above = 0.2, .at_most = 25}, damping{.above = 0, .at_most = 0.9};
  v("wheelbase_m", wheelbase_m, "distance between the axles", {.above = 0.2});
  v("track_m", track_m, "distance between the wheels of an axle", {.above = 0.2});
  v("centre_height_m", centre_height_m, "height of the centre of pitch and roll", {.at_least = 0, .at_most = 3});
  v("heave_hz", heave_hz, "natural frequency of heave", hz);
  v("heave_damping", heave_damping, "share of critical damping", damping);
  v("pitch_hz", pitch_hz, "natural frequency of pitch", hz);
  v("pitch_damping", pitch_damping, "share of critical damping", damping);
  v("roll_hz", roll_hz, "natural frequency of roll", hz);
  v("roll_damping", roll_damping, "share of critical damping", damping);
  v("dive_deg_per_m_s2", dive_deg_per_m_s2, "steady pitch under braking", {.at_least = 0, .at_most = 2});
  v("lean_deg_per_m_s2", lean_deg_per_m_s2, "steady roll out of a turn", {.at_least = 0, .at_most = 2});
  v("surge_hz", surge_hz, "natural frequency of the body's forward motion on its wheels (0: none)",
    {.at_least = 0, .at_most = 25});
  v("surge_damping", surge_damping, "share of critical damping", damping);
}

void VibrationOptions::visit(core::OptionVisitor& v) {
  v("idle_hz", idle_hz, "firing frequency of the idling engine", {.above = 1, .at_most = 60});
  v("engine_hz_per_m_s", engine_hz_per_m_s, "rise of the firing frequency with speed", {.at_least = 0, .at_most = 20});
  v("engine_rms_m_s2", engine_rms_m_s2, "engine vibration at idle, vertical (others: 0.6 of it)",
    {.at_least = 0, .at_most = 10});
  v("engine_rms_deg_s", engine_rms_deg_s, "engine vibration at idle, about each axis", {.at_least = 0, .at_most = 20});
  v("rolling_rms_m_s2", rolling_rms_m_s2, "tyre vibration at 5 m/s, vertical (others: 0.6 of it)",
    {.at_least = 0, .at_most = 10});
  v("rolling_rms_deg_s", rolling_rms_deg_s, "tyre vibration at 5 m/s, about each axis", {.at_least = 0, .at_most = 20});
}

void CourseOptions::visit(core::OptionVisitor& v) {
  v.group("start", start, "where the path begins");
  v("rest_s", rest_s, "time before the first change of speed", {.at_least = 0});
  v.list("path", path, "straights and turns, one after the other; after the last the path goes on straight");
  v.list("speed", speed, "changes of speed in order");
  v("stop_peak_m_s2", stop_peak_m_s2, "deceleration of the stop at the end of the path (0: no stop)",
    {.at_least = 0, .at_most = 12});
  v.group("jitter", jitter, "ripple of the speed");
  v.group("wander", wander, "sideways wander");
}

void DriveOptions::visit(core::OptionVisitor& v) {
  v.choice("vehicle", vehicle, vehicle_names(), "sets the defaults of suspension and vibration");
  CourseOptions::visit(v);
  v.group("road", road, "unevenness under the wheels");
  v.list("bumps", bumps, "single obstacles under the wheels");
  v.group("suspension", suspension, "how the body answers");
  v.group("vibration", vibration, "engine and tyres");
}

DriveOptions read_drive_options(const core::ConfigNode& node) {
  DriveOptions options;
  if (const core::ConfigNode vehicle = node.child("vehicle"); vehicle.present()) {
    set_vehicle(vehicle.scalar("vehicle"), options.suspension, options.vibration);
  }
  node.read(options, {"kind"});
  for (BumpOptions& bump : options.bumps) complete_bump(bump);
  return options;
}

}  // namespace tarmac::sim::truth
