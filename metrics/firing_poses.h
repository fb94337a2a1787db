/// True and estimated poses at the firing times of one sweep, once for all points that were fired together.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/measurements.h"
#include "core/trajectory.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

using Matrix34 = Eigen::Matrix<double, 3, 4>;

/// Consecutive points with one firing time.
struct Firing {
  std::size_t first = 0, last = 0;  ///< points [first, last)
  core::Time t;                     ///< true
  std::uint16_t sensor = 0;         ///< of a merged sweep
  bool covered = false;             ///< by estimate and truth both
  core::SE3 T_world_body = core::SE3::Identity();
  core::SE3 T_map_body = core::SE3::Identity();
};

/// Poses of the truth at many instants. Up to `kExactQueries` are asked for one by one; beyond (sensors whose channels
/// fire one after the other), each anchor of 100 us serves its neighbourhood by a second-order expansion, whose error
/// is below jerk x (50 us)^3 / 6: 2e-12 m at 100 m/s^3.
class TruthPoses {
 public:
  static constexpr std::size_t kExactQueries = 4096;
  TruthPoses(const core::SmoothTrajectory& truth, std::size_t queries)
      : truth_(truth), exact_(queries <= kExactQueries) {}
  bool covers(core::Time t) const { return truth_.covers(t); }
  core::SE3 pose(core::Time t);

 private:
  const core::SmoothTrajectory& truth_;
  bool exact_;
  bool has_anchor_ = false;
  std::int64_t bucket_ = 0;
  core::Time anchor_t_;
  core::Kinematics anchor_;
};

/// Groups a sweep's points by true firing time and looks up both motions. `point_sensor`: of a merged sweep, whose each
/// point is (LidarSweep::point_sensor); a firing is then one sensor's.
std::vector<Firing> firings_of(const sim::truth::PointLabels& labels, const core::PiecewiseTrajectory& estimate,
                               const core::SmoothTrajectory& truth,
                               const std::vector<std::uint16_t>& point_sensor = {});

}  // namespace tarmac::metrics
