/// Estimate and truth at the same instants: what ATE and RPE are computed from.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/estimate.h"
#include "core/trajectory.h"

namespace tarmac::metrics {

struct PosePair {
  std::int64_t index = 0;                          ///< of the sweep; RPE over sweeps counts in these
  core::Time t;                                    ///< the reference instant
  core::SE3 T_world_body = core::SE3::Identity();  ///< true
  core::SE3 T_map_body = core::SE3::Identity();    ///< estimated
  double distance_m = 0;                           ///< true path travelled since the first pair
};

/// Chords of the true path, 10 ms apart and ending at t1: between them a vehicle's path is straight to 1e-6 of its
/// length.
double path_length_m(const core::Trajectory& truth, core::Time t0, core::Time t1);

/// Fills in distance_m.
void measure_path(const core::Trajectory& truth, std::vector<PosePair>& pairs);

/// The pose at t seen from before: where two segments touch at t and the motion jumps, the earlier one's. What a
/// sweep's own motion says at its end, while PiecewiseTrajectory::pose(t) belongs to the next. Empty where nothing
/// covers t.
std::optional<core::SE3> pose_from_before(const core::PiecewiseTrajectory& trajectory, core::Time t);

/// A trajectory's pose at the sweep's reference instant, as the sweep's own motion has it.
std::optional<core::SE3> pose_of_sweep(const core::PiecewiseTrajectory& trajectory, const core::SweepResult& sweep);

/// True when the sweep is scored: status ok, a finite pose, its reference instant inside the truth's span.
bool is_scored(const core::SweepResult& sweep, const core::Trajectory& truth);

/// Pairs at the reference instants of scored sweeps. Causal poses are the sweep results'; final ones come from the
/// final trajectory, and sweeps that it does not cover are left out.
std::vector<PosePair> pair_poses(const core::Estimate& estimate, bool final_trajectory, const core::Trajectory& truth);

}  // namespace tarmac::metrics
