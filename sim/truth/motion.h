/// Motions by kind. The simulated motion never comes from a model class that an estimator uses: see sim/truth/README.md
/// for each one's class of functions.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/truth/body_box.h"

namespace tarmac::sim::truth {

/// `node` is the scenario's `motion:` block: {kind: NAME, ...options}; the motion covers [0, duration].
/// `ground` is what the wheels follow (may be nullptr: z = 0). Throws InputError.
std::shared_ptr<const core::SmoothTrajectory> make_motion(const core::ConfigNode& node, core::Duration duration,
                                                          std::shared_ptr<const scenes::Ground> ground,
                                                          std::uint64_t seed);
/// The motion block with every option written out, indented by 2.
std::string resolve_motion(const core::ConfigNode& node);
/// What moves, where the rig does not say it: a `drive` its vehicle, `towed` the trailer (without the tug), `handheld`
/// a person around the device, `drone` the airframe down to its legs; the others a van. Throws InputError as
/// make_motion.
BodyBox body_box(const core::ConfigNode& node);
std::vector<std::string> motion_kinds();
/// One line. Throws InputError for an unknown kind, as does the next.
std::string motion_summary(const std::string& kind);
std::vector<core::OptionDescription> describe_motion(const std::string& kind);

}  // namespace tarmac::sim::truth
