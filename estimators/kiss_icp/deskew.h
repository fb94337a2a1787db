/// Moving a sweep's points to one instant.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/lie.h"
#include "core/measurements.h"
#include "core/trajectory.h"

namespace tarmac::estimators {

/// Motion during a sweep, from a point's time to the sweep's last point. Two kinds:
///
/// modelled, as KISS-ICP does it: the previous sweep's increment D, gone through at constant twist,
///   T_end_point(t) = Exp((s - 1) Log D),   s = (t - t_min) / (t_max - t_min) over the stamps of the sweep's points;
/// measured, by a path T(t) of the body that was propagated from elsewhere (an IMU):
///   T_end_point(t) = T_lidar_body T(t_max)^-1 T(t) T_body_lidar.
///
/// Where all stamps are equal (or deskewing is off) nothing moves. A sweep without points moves from begin to end.
class SweepMotion {
 public:
  SweepMotion() = default;
  SweepMotion(const core::LidarSweep& sweep, const core::SE3& D, bool deskew);
  /// Before and after the path's span its first and last pose hold.
  SweepMotion(const core::LidarSweep& sweep, core::Segment path, const core::SE3& T_body_lidar);

  bool moves() const { return moves_; }
  /// Stamps of the first and the last point, from the sweep's begin.
  std::int32_t first_ns() const { return first_ns_; }
  std::int32_t last_ns() const { return last_ns_; }
  /// s, unbounded. Only where moves().
  double phase(std::int64_t t_ns) const {
    return static_cast<double>(t_ns - first_ns_) / static_cast<double>(std::int64_t{last_ns_} - first_ns_);
  }
  core::SE3 T_end_point(std::int64_t t_ns) const;
  /// Of the measured kind: the body's path; nullptr for the modelled kind.
  const core::Segment* path() const { return path_ ? &*path_ : nullptr; }
  /// Of the measured kind: the path's pose of the body, held outside its span.
  core::SE3 path_pose(std::int64_t t_ns) const;

 private:
  void find_stamps(const core::LidarSweep& sweep);

  bool moves_ = false;
  std::int32_t first_ns_ = 0, last_ns_ = 0;
  core::Vector6 twist_ = core::Vector6::Zero();
  core::Time begin_;
  std::optional<core::Segment> path_;
  core::SE3 T_body_lidar_ = core::SE3::Identity(), T_end_path_ = core::SE3::Identity();
};

/// All points of the sweep as seen from the sensor's frame at the sweep's last point.
void deskew(const core::LidarSweep& sweep, const SweepMotion& motion, std::vector<Eigen::Vector3d>& points_m);

}  // namespace tarmac::estimators
