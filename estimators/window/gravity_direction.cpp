#include "estimators/window/gravity_direction.h"

#include <Eigen/Geometry>
#include <cmath>

namespace tarmac::estimators::gravity_direction {

using Eigen::Vector3d;

Eigen::Matrix<double, 3, 2> tangent(const Vector3d& g) {
  // The axis least along g, so that the cross product is never short.
  Eigen::Index axis = 0;
  g.cwiseAbs().minCoeff(&axis);
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = Vector3d::Unit(axis).cross(g).normalized();
  B.col(1) = g.cross(B.col(0)).normalized();
  return B;
}

Vector3d moved(const Vector3d& g, const Eigen::Vector2d& d) {
  const double angle = d.norm();
  const double sinc = angle < 1e-4 ? 1 - angle * angle / 6 : std::sin(angle) / angle;
  return (std::cos(angle) * g + sinc * (tangent(g) * d)).normalized();
}

/// With a the angle between them and f = a / sin a: d = f B_base^T g, and df/dg = -(sin a - a cos a) / sin^3 a base^T.
Eigen::Vector2d difference(const Vector3d& base, const Vector3d& g, Eigen::Matrix2d& J) {
  const double sine = base.cross(g).norm(), angle = std::atan2(sine, base.dot(g));
  const bool small = angle < 1e-3;
  const double f = small ? 1 + angle * angle / 6 : angle / sine;
  const double slope = small ? 1.0 / 3 + 2 * angle * angle / 15 : (sine - angle * base.dot(g)) / (sine * sine * sine);
  const auto B = tangent(base);
  const Eigen::Vector2d across = B.transpose() * g;
  J = (f * B.transpose() - slope * across * base.transpose()) * tangent(g);
  return f * across;
}

}  // namespace tarmac::estimators::gravity_direction
