/// Moving a sweep's points to one instant.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/lie.h"
#include "core/measurements.h"

namespace tarmac::estimators {

/// Motion during a sweep as KISS-ICP models it: the previous sweep's increment D, gone through at constant twist and
/// completed at the sweep's last point:
///   T_end_point(t) = Exp((s - 1) Log D),   s = (t - t_min) / (t_max - t_min) over the stamps of the sweep's points.
/// Where all stamps are equal (or deskewing is off) nothing moves. A sweep without points moves from begin to end.
class SweepMotion {
 public:
  SweepMotion() = default;
  SweepMotion(const core::LidarSweep& sweep, const core::SE3& D, bool deskew);

  bool moves() const { return moves_; }
  /// Stamps of the first and the last point, from the sweep's begin.
  std::int32_t first_ns() const { return first_ns_; }
  std::int32_t last_ns() const { return last_ns_; }
  /// s, unbounded. Only where moves().
  double phase(std::int64_t t_ns) const {
    return static_cast<double>(t_ns - first_ns_) / static_cast<double>(std::int64_t{last_ns_} - first_ns_);
  }
  core::SE3 T_end_point(std::int64_t t_ns) const {
    return moves_ ? core::se3::exp((phase(t_ns) - 1) * twist_) : core::SE3::Identity();
  }

 private:
  bool moves_ = false;
  std::int32_t first_ns_ = 0, last_ns_ = 0;
  core::Vector6 twist_ = core::Vector6::Zero();
};

/// All points of the sweep as seen from the sensor's frame at the sweep's last point.
void deskew(const core::LidarSweep& sweep, const SweepMotion& motion, std::vector<Eigen::Vector3d>& points_m);

}  // namespace tarmac::estimators
