/// How hard CT-ICP tries, and whether it believes the outcome.
#pragma once

#include <vector>

#include "estimators/blocks/voxel_map.h"
#include "estimators/ct_icp/options.h"
#include "estimators/ct_icp/registration.h"

namespace tarmac::estimators {

/// The settings of one attempt. Level 0 is what the options say; each level above searches wider, iterates longer,
/// samples denser and lets farther planes in.
struct Effort {
  int level = 0;
  double keypoint_cell_m = 1.5;
  ElasticSettings settings;

  static Effort from(const CtIcpOptions& options, bool startup);
  void raise(const CtIcpOptions& options);
};

/// A sweep's motion in the terms that it is judged by.
struct MotionSize {
  double within_m = 0, within_deg = 0;  ///< from the sweep's begin to its end
  double since_last_deg = 0;            ///< from the last end to this one
  double jump_m = 0;                    ///< from the last end to this begin

  static MotionSize of(const core::SE3& begin, const core::SE3& end, const core::SE3& previous_end);
};

enum class Verdict {
  good,
  doubtful,  ///< calls for another attempt; believed when none is left
  wrong,     ///< calls for another attempt; the sweep is lost when none is left
};

/// Limits that always hold, and the stricter ones of `robust`, the map apart.
Verdict judge(const CtIcpOptions& options, const ElasticResult& result, const MotionSize& size, int level);

/// Share of points in voxels that are empty and in voxels that are at least half full.
struct MapOverlap {
  double empty = 0, half_full = 0;
  static MapOverlap of(const VoxelMap& map, const std::vector<Eigen::Vector3d>& points_map);
};
/// Whether a motion of that size asks for the overlap to be looked at.
bool wants_overlap(const CtIcpOptions& options, const MotionSize& size);
Verdict judge(const CtIcpOptions& options, const MapOverlap& overlap);

/// What is remembered from sweep to sweep: the level to start from, and what did not get into the map.
class Caution {
 public:
  int level() const { return level_; }
  /// Whether the sweep may go into the map.
  bool admit(const CtIcpOptions& options, const MotionSize& size, int attempts);
  /// The sweep was lost.
  void fail() { level_ = 2; }

 private:
  int level_ = 0;
  int suspects_ = 0;  ///< sweeps in a row that used all attempts
  int skipped_ = 0;   ///< sweeps in a row that were not added
};

}  // namespace tarmac::estimators
