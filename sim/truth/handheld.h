/// A sensor in the hands of somebody who walks or runs.
#pragma once

#include <cstdint>
#include <memory>

#include "core/config.h"
#include "core/trajectory.h"
#include "scenes/scene.h"

namespace tarmac::sim::truth {

/// `node` is a `motion:` block of kind handheld. Throws InputError for bad options.
std::shared_ptr<const core::SmoothTrajectory> make_handheld(const core::ConfigNode& node, core::Duration duration,
                                                            std::shared_ptr<const scenes::Ground> ground,
                                                            std::uint64_t seed);

}  // namespace tarmac::sim::truth
