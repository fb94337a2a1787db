/// How errors grow along the drive: KITTI's segment errors, and drift split by direction.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/time.h"
#include "metrics/evaluation.h"
#include "metrics/pose_pairs.h"
#include "metrics/row_set.h"

namespace tarmac::metrics {

/// Segment errors as the KITTI odometry development kit computes them: segments of 100, 200 ... 800 m begin at every
/// tenth pose and end at the first pose whose distance along the chords between poses exceeds the length;
///   E = (T^_k^-1 T^_j)^-1 (T_k^-1 T_j),  |trans E| / length and angle(E) / length, averaged over all segments.
/// Angles by atan2 instead of acos. A pose is a scored reference pose. Source: Geiger et al. 2012, Are we ready for
/// Autonomous Driving?; evaluate_odometry.cpp of its development kit.
struct KittiSegments {
  static constexpr std::size_t kLengths = 8;
  static constexpr double length_m(std::size_t k) { return 100.0 * static_cast<double>(k + 1); }
  static constexpr double kShortestPathM = 200;  ///< on a shorter path one or two segments would stand for all
  double path_m = 0;                             ///< along the chords
  std::size_t count[kLengths] = {};
  double trans_fraction = 0;  ///< mean over all segments
  double rot_rad_per_m = 0;
  std::size_t segments() const;
  /// "100 m: 12, 200 m: 3"
  std::string counts() const;
};
KittiSegments kitti_segments(const std::vector<PosePair>& pairs);

/// An error as a driver would say it: along and across the true heading, up, and turned. Level axes: x along the true
/// body's x axis laid onto the horizontal, y to the left of it, z up.
struct SplitError {
  double along_m = 0, cross_m = 0, height_m = 0;
  double yaw_rad = 0;   ///< about the vertical, left positive
  double tilt_rad = 0;  ///< of roll and pitch together, never negative
};
/// Of the motion from pair `from` to pair `to`, seen at the end of it.
SplitError split_of_motion(const std::vector<PosePair>& pairs, std::size_t from, std::size_t to);
/// Of one pose, after `T_world_map` carried the map onto the world.
SplitError split_of_pose(const PosePair& pair, const core::SE3& T_world_map);

/// kitti_trans_percent, kitti_rot_deg_per_100m, drift_50m_*.
void add_drift_rows(const std::vector<PosePair>& pairs, RowSet& rows);

/// drift_{along,cross,height,yaw,tilt}_vs_distance and _vs_duration: RMS over all stretches of a length or a duration
/// (1-2-3-5-7-10), with the band from the 5th to the 95th percentile of the magnitude; error_{...}_vs_time, signed,
/// after first-pose alignment.
void add_drift_series(const std::vector<PosePair>& pairs, core::Time t_zero, std::vector<Series>& series);

}  // namespace tarmac::metrics
