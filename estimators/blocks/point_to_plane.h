/// Distance of a moving point from a plane of the map.
#pragma once

#include <Eigen/Core>

#include "core/lie.h"

namespace tarmac::estimators {

/// p [m] in the body, q [m] and the unit normal n in the map:
///   r(T) = n^T (T p - q)      dr/dxi = [ n^T R   (p x R^T n)^T ]   for T <- T Exp(xi), xi = (rho, phi)
/// With n turned towards the sensor, r is positive where the point lies in front of the surface.
/// Source: Sola et al. 2018 (arXiv:1812.01537), eq. 181-183.
struct PointToPlane {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d q_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d n_map = Eigen::Vector3d::UnitZ();

  double operator()(const core::SE3& T_map_body) const {
    return n_map.dot(T_map_body.linear() * p_body + T_map_body.translation() - q_map);
  }
  double operator()(const core::SE3& T_map_body, core::Row6& J) const {
    const Eigen::Vector3d n_body = T_map_body.linear().transpose() * n_map;
    J << n_body.transpose(), p_body.cross(n_body).transpose();
    return (*this)(T_map_body);
  }
};

}  // namespace tarmac::estimators
