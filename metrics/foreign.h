/// Poses against poses: `tarmac evaluate --truth gt.tum --estimate est.tum`, where nothing but two lists exists.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/lie.h"
#include "core/time.h"
#include "metrics/align.h"
#include "metrics/evaluation.h"

namespace tarmac::metrics {

using StampedPose = std::pair<core::Time, core::SE3>;

struct ForeignSettings {
  std::optional<Alignment> alignment = std::nullopt;  ///< only this one's ATE; empty: all
  bool gravity_aligned = false;                       ///< the estimate's z axis points up (matters to yaw_pos)
  core::Duration max_gap{1'000'000'000};  ///< true poses farther apart than this do not bridge the time between them
};

struct ForeignEvaluation {
  std::vector<Row> rows;  ///< ate_*, rpe_*, kitti_*, drift_*, end_error_*, path_length_m, coverage_percent
  std::size_t associated = 0;
  std::size_t outside = 0;  ///< estimate stamps before the first or after the last true pose: left out
  std::size_t in_gaps = 0;  ///< estimate stamps inside a gap of the truth: left out
};

/// Interpolates the truth (a constant twist between neighbouring poses) at the estimate's stamps, never the estimate,
/// and never takes the nearest neighbour. A "sweep" of the RPE is a pose of the estimate; path length is that of the
/// interpolated truth. Throws InputError when a list is empty or not in strictly ascending time, or when nothing can be
/// associated.
ForeignEvaluation evaluate_poses(const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate,
                                 const ForeignSettings& settings);

}  // namespace tarmac::metrics
