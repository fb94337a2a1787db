/// What a `handheld` motion is told: where a person walks with the sensor, and how.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "sim/truth/drive_options.h"

namespace tarmac::sim::truth {

/// How the device swings with the steps. Steps come at speed / step_length_m, a stride is two.
struct GaitOptions {
  double step_length_m = 0.68, full_speed_m_s = 0.9;
  double vertical_m = 0.04, lateral_m = 0.045, surge_m_s = 0.15;
  double roll_rms_deg = 2, pitch_rms_deg = 2, yaw_deg = 4.5;
  double strike_m_s2 = 3.5, strike_hz = 20, strike_damping = 0.25;
  double rate_jitter = 0.03;
  void visit(core::OptionVisitor& v);
};

/// How it is held.
struct HoldOptions {
  double height_m = 1.35, ahead_m = 0.3, tilt_deg = 0;
  double tremor_deg = 0.05, tremor_m_s2 = 0.2;
  double posture_deg = 1.2, posture_m = 0.012;
  void visit(core::OptionVisitor& v);
};

/// One look around: to the left, to the right, and ahead again.
struct LookOptions {
  double at_s = 0, left_deg = 60, right_deg = 60, period_s = 4;
  void visit(core::OptionVisitor& v);
};

struct HandheldOptions : CourseOptions {
  HandheldOptions();
  std::string gait_name = "walk";
  GaitOptions gait;
  HoldOptions hold;
  std::vector<LookOptions> looks;
  void visit(core::OptionVisitor& v);
};

std::vector<std::string> gait_names();
/// Options of a `motion:` block of kind handheld: those of its gait, where the block does not say otherwise.
HandheldOptions read_handheld_options(const core::ConfigNode& node);

}  // namespace tarmac::sim::truth
