/// A body on wheels that follows a course: the part that a drive and a towed trailer share.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/config.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/truth/course.h"

namespace tarmac::sim::truth {

/// What stands on the wheels.
struct BodyOptions {
  RoadOptions road;
  std::vector<BumpOptions> bumps;
  SuspensionOptions suspension;
  VibrationOptions vibration;
};

/// Throws InputError (at `node`) when the wheels would leave the ground, which the linear suspension does not know.
std::shared_ptr<const core::SmoothTrajectory> make_vehicle_body(const core::ConfigNode& node,
                                                                std::unique_ptr<const Course> course,
                                                                const BodyOptions& options, core::Duration duration,
                                                                std::shared_ptr<const scenes::Ground> ground,
                                                                std::uint64_t seed);

}  // namespace tarmac::sim::truth
