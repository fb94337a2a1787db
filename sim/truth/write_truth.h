/// Writes what load_ground_truth reads back; labels are written by whoever traces the rays.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/rig.h"
#include "core/trajectory.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::sim::truth {

/// Writes scenario.yaml (as given; needs name, seed, duration_s, scene, motion), motion.yaml (`resolved_motion`, the
/// text of resolve_motion, with its class of functions), truth.tum, rig.json (`rig` has the true extrinsics) and
/// faults.json into `folder`, which is created when it is absent.
void write_truth(const std::filesystem::path& folder, const std::string& resolved_scenario,
                 const std::string& resolved_motion, const core::SmoothTrajectory& motion, const core::Rig& rig,
                 const std::vector<Fault>& faults);

/// T_world_body in lines of "t x y z qx qy qz qw" at begin, every millisecond and at the end; t in seconds with all
/// nine digits of its nanoseconds, positions [m] and quaternions with 12 decimals.
std::string motion_as_tum(const core::SmoothTrajectory& motion);

}  // namespace tarmac::sim::truth
