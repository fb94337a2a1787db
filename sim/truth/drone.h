/// A sensor under a multirotor.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/truth/drive_options.h"

namespace tarmac::sim::truth {

/// One change of height along the path.
struct ClimbOptions {
  double at_m = 0, by_m = 0, over_m = 20;
  void visit(core::OptionVisitor& v);
};

struct TakeOffOptions {
  double legs_m = 0.3, height_m = 12, climb_m_s = 2, spin_up_s = 2;
  void visit(core::OptionVisitor& v);
};

struct WindOptions {
  double mean_m_s = 2, from_deg = 240;
  double gust_m_s = 0.8, gust_length_m = 100;
  void visit(core::OptionVisitor& v);
};

struct AirframeOptions {
  double drag_per_s = 0.18;
  double hold_hz = 0.12, hold_damping = 0.7;
  double jitter_deg = 0.5;
  double max_tilt_deg = 60;
  double rotor_hz = 85;
  int blades = 2;
  double rotor_rms_m_s2 = 0.8, rotor_rms_deg_s = 0.8;
  void visit(core::OptionVisitor& v);
};

struct DroneOptions : CourseOptions {
  DroneOptions();
  std::string regime = "cruise";
  TakeOffOptions take_off;
  std::vector<ClimbOptions> climbs;
  WindOptions wind;
  AirframeOptions airframe;
  void visit(core::OptionVisitor& v);
};

std::vector<std::string> drone_regimes();
/// Options of a `motion:` block of kind drone: those of its regime, where the block does not say otherwise.
DroneOptions read_drone_options(const core::ConfigNode& node);

/// Throws InputError for bad options and for accelerations that need more tilt than max_tilt_deg.
std::shared_ptr<const core::SmoothTrajectory> make_drone(const core::ConfigNode& node, core::Duration duration,
                                                         std::shared_ptr<const scenes::Ground> ground,
                                                         std::uint64_t seed);

}  // namespace tarmac::sim::truth
