/// What a `drive` is told: path, speeds, road, vehicle. Defaults: a service van that surveys an apron.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/options.h"
#include "sim/truth/bumps.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

struct RoadOptions {
  std::string roughness = "A";
  int waves = 220;
  double contact_m = 0.12;
  double joint_spacing_m = 6;
  double joint_depth_m = 0.0015;
  double joint_length_m = 0.16;
  void visit(core::OptionVisitor& v);
};

struct SuspensionOptions {
  double wheelbase_m = 3.0, track_m = 1.6, centre_height_m = 0.5;
  double heave_hz = 1.4, heave_damping = 0.3;
  double pitch_hz = 1.6, pitch_damping = 0.3;
  double roll_hz = 1.6, roll_damping = 0.25;
  double dive_deg_per_m_s2 = 0.25;
  double lean_deg_per_m_s2 = 0.45;
  double surge_hz = 0, surge_damping = 0.15;
  void visit(core::OptionVisitor& v);
};

struct VibrationOptions {
  double idle_hz = 25;
  double engine_hz_per_m_s = 3;
  double engine_rms_m_s2 = 0.08;
  double engine_rms_deg_s = 0.03;
  double rolling_rms_m_s2 = 0.08;
  double rolling_rms_deg_s = 0.03;
  void visit(core::OptionVisitor& v);
};

/// A path, and the speeds along it: what every motion over ground has.
struct CourseOptions {
  StartOptions start;
  double rest_s = 3;
  std::vector<PathPiece> path;
  std::vector<SpeedEvent> speed;
  double stop_peak_m_s2 = 1.2;
  JitterOptions jitter;
  WanderOptions wander;
  void visit(core::OptionVisitor& v);
  SpeedPlan speed_plan() const { return {start.speed_m_s, rest_s, speed, stop_peak_m_s2}; }
};

struct DriveOptions : CourseOptions {
  std::string vehicle = "van";
  RoadOptions road;
  std::vector<BumpOptions> bumps;
  SuspensionOptions suspension;
  VibrationOptions vibration;
  void visit(core::OptionVisitor& v);
};

/// Options of a `motion:` block of kind drive: those of its vehicle, where the block does not say otherwise.
DriveOptions read_drive_options(const core::ConfigNode& node);

}  // namespace tarmac::sim::truth
