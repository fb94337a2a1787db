/// A sensor on a trailer behind a tug.
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

/// One rigid link of the train, from a hitch to its own axle.
struct LinkOptions {
  double hitch_m = 0.6;  ///< behind the axle of what pulls it
  double length_m = 2.2;
  void visit(core::OptionVisitor& v);
};

struct TowedOptions {
  TowedOptions();
  CourseOptions tug;
  std::vector<LinkOptions> links;
  RoadOptions road;
  std::vector<BumpOptions> bumps;
  SuspensionOptions suspension;
  VibrationOptions vibration;
  void visit(core::OptionVisitor& v);
};

TowedOptions read_towed_options(const core::ConfigNode& node);

/// The body is that of the last link. Throws InputError for a path on which the train would jack-knife.
std::shared_ptr<const core::SmoothTrajectory> make_towed(const core::ConfigNode& node, core::Duration duration,
                                                         std::shared_ptr<const scenes::Ground> ground,
                                                         std::uint64_t seed);

}  // namespace tarmac::sim::truth
