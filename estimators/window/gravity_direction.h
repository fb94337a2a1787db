/// A unit vector with two degrees of freedom.
#pragma once

#include <Eigen/Core>

namespace tarmac::estimators::gravity_direction {

/// An orthonormal basis of the plane across g, as columns; a fixed function of g.
Eigen::Matrix<double, 3, 2> tangent(const Eigen::Vector3d& g);
/// g turned by |d| towards B d: g cos|d| + B d sin|d| / |d|, B = tangent(g). Its Jacobian by d at 0 is B.
Eigen::Vector3d moved(const Eigen::Vector3d& g, const Eigen::Vector2d& d);
/// d with g = moved(base, d), and its Jacobian by a further step of g. Angles below pi.
Eigen::Vector2d difference(const Eigen::Vector3d& base, const Eigen::Vector3d& g, Eigen::Matrix2d& J);

}  // namespace tarmac::estimators::gravity_direction
