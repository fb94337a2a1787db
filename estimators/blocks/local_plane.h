/// A plane through the points of a map around a place.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace tarmac::estimators {

struct LocalPlane {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, of either sign
  double thickness_m = 0;                             ///< standard deviation along the normal
};

/// By the covariance of the points, l0 <= l1 <= l2: planar where sqrt(l0) is at most `max_thickness_m` and a third of
/// sqrt(l1). Empty where the points are fewer than 6 or lie on no plane: on an edge, on one line (a single ground
/// ring), in foliage.
std::optional<LocalPlane> fit_plane(std::span<const Eigen::Vector3d> points_m, double max_thickness_m);

}  // namespace tarmac::estimators
