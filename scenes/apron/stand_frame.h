/// A stand's own frame: origin on the ground below the nose tip of the aircraft that stands there, y where the nose
/// points, x to the aircraft's right.
#pragma once

#include <Eigen/Core>
#include <numbers>

namespace tarmac::scenes {

struct StandFrame {
  Eigen::Vector2d nose_m{0, 0};  ///< world
  double sign = 1;               ///< 1: the nose points north, -1: south

  Eigen::Vector2d world(double x_m, double y_m) const { return nose_m + sign * Eigen::Vector2d(x_m, y_m); }
  /// From the stand's x axis to the world's.
  double world_yaw_rad(double yaw_rad) const { return sign > 0 ? yaw_rad : yaw_rad + std::numbers::pi; }
  double heading_rad() const { return world_yaw_rad(std::numbers::pi / 2); }
};

}  // namespace tarmac::scenes
