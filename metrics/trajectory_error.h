/// Errors of poses at the reference instants: absolute after an alignment, and of relative motions.
#pragma once

#include <string>
#include <vector>

#include "core/time.h"
#include "metrics/align.h"
#include "metrics/evaluation.h"
#include "metrics/pose_pairs.h"
#include "metrics/row_set.h"

namespace tarmac::metrics {

/// T_world_map = T_true T_est^-1 of the first pair.
core::SE3 first_pose_alignment(const std::vector<PosePair>& pairs);

/// How the estimate's map is laid onto the world. Empty when the alignment is undefined for these pairs.
/// `gravity_aligned`: map's z axis points up; matters to yaw_pos only.
std::optional<Fit> align(const std::vector<PosePair>& pairs, Alignment alignment, bool gravity_aligned);

/// ||A p_est - p_true|| a pair [m].
std::vector<double> position_errors_m(const std::vector<PosePair>& pairs, const Similarity& A);
/// Angle between A R_est and R_true a pair [rad].
std::vector<double> rotation_errors_rad(const std::vector<PosePair>& pairs, const Similarity& A);

/// The error of one relative motion: E = (T_k^-1 T_j)^-1 (T^_k^-1 T^_j), j later than k, T true and T^ estimated.
struct RelativeError {
  std::size_t from = 0, to = 0;  ///< places in the list of pairs
  double trans_m = 0;
  double rot_rad = 0;
};
/// Pairs whose sweep index differs by exactly n: a sweep that is not scored leaves a hole, never a longer step.
std::vector<RelativeError> relative_over_sweeps(const std::vector<PosePair>& pairs, std::int64_t n);
/// Each pair with the one nearest to `span` later, if it is within half the median spacing of it.
std::vector<RelativeError> relative_over_time(const std::vector<PosePair>& pairs, core::Duration span);
/// Each pair with the first one at least `length_m` of true path later.
std::vector<RelativeError> relative_over_distance(const std::vector<PosePair>& pairs, double length_m);

struct TrajectoryOptions {
  bool gravity_aligned = false;
  bool common_frame = false;  ///< map is the world's frame: ate_none is defined
};
/// ate_*, rpe_*, end_error_*, path_length_m.
void add_trajectory_rows(const std::vector<PosePair>& pairs, const TrajectoryOptions& options, RowSet& rows);

/// error_vs_time, error_vs_distance (position error after first-pose alignment) and drift_vs_distance: over all
/// stretches of true path of a length, RMS of the translation error of the motion along it, with the band from the
/// 5th to the 95th percentile. Lengths follow 1-2-3-5-7-10 and end where no stretch fits.
void add_trajectory_series(const std::vector<PosePair>& pairs, core::Time t_zero, std::vector<Series>& series);

}  // namespace tarmac::metrics
