/// The real motion: a road vehicle that follows a path, brakes, sways on its suspension and shakes.
#pragma once

#include <cstdint>
#include <memory>

#include "core/config.h"
#include "core/trajectory.h"
#include "scenes/scene.h"

namespace tarmac::sim::truth {

/// `node` is a `motion:` block of kind drive. Throws InputError for bad options, and for a path or speeds that do not
/// fit together.
std::shared_ptr<const core::SmoothTrajectory> make_drive(const core::ConfigNode& node, core::Duration duration,
                                                         std::shared_ptr<const scenes::Ground> ground,
                                                         std::uint64_t seed);

}  // namespace tarmac::sim::truth
