#include "scenes/actors/footing.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

using Eigen::Vector3d;

Footing footing_of(const Mesh& mesh, double thickness_m) {
  bool found = false;
  Footing footing;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Vector3d p = v.cast<double>();
    if (p.z() > thickness_m) continue;
    footing.rear_x_m = found ? std::min(footing.rear_x_m, p.x()) : p.x();
    footing.front_x_m = found ? std::max(footing.front_x_m, p.x()) : p.x();
    footing.half_track_m = std::max(footing.half_track_m, std::abs(p.y()));
    found = true;
  }
  return footing;
}

core::SE3 stand_on(const Ground& ground, const Footing& footing, const PlanarPose& rear_axle) {
  const double c = std::cos(rear_axle.heading_rad), s = std::sin(rear_axle.heading_rad);
  const auto under = [&](double ahead_m, double left_m) {
    const double x = rear_axle.x_m + ahead_m * c - left_m * s, y = rear_axle.y_m + ahead_m * s + left_m * c;
    return Vector3d(x, y, ground.height_m(x, y));
  };
  const double half = std::max(footing.half_track_m, 0.05), base = std::max(footing.wheelbase_m(), 0.1);
  const Vector3d left = under(0, half), right = under(0, -half), front = under(base, 0), rear = 0.5 * (left + right);
  core::SE3 T = core::SE3::Identity();
  T.linear().col(0) = (front - rear).normalized();
  T.linear().col(2) = T.linear().col(0).cross(left - right).normalized();
  T.linear().col(1) = T.linear().col(2).cross(T.linear().col(0));
  T.translation() = rear;
  return T;
}

double radius_about(const Mesh& mesh, const Vector3d& centre_m) {
  double radius = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) radius = std::max(radius, (v.cast<double>() - centre_m).norm());
  return radius * (1 + 1e-6) + 1e-6;
}

}  // namespace tarmac::scenes
