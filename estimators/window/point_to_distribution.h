/// Distance of a moving point from a distribution of the map.
#pragma once

#include <Eigen/Core>

#include "core/lie.h"

namespace tarmac::estimators {

/// p [m] in the body, mean q [m] in the map, U^T U the information:
///   r(T) = U (T p - q)      dr/dxi = U R [ I  -hat(p) ]   for T <- T Exp(xi), xi = (rho, phi)
/// Source: Magnusson, The Three-Dimensional Normal-Distributions Transform (2009), ch. 6; Jacobian of T p as Sola et
/// al. 2018 (arXiv:1812.01537), eq. 182.
struct PointToDistribution {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d q_map = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sqrt_information = Eigen::Matrix3d::Identity();

  Eigen::Vector3d operator()(const core::SE3& T_map_body) const {
    return sqrt_information * (T_map_body.linear() * p_body + T_map_body.translation() - q_map);
  }
  Eigen::Vector3d operator()(const core::SE3& T_map_body, Eigen::Matrix<double, 3, 6>& J) const {
    J.leftCols<3>() = sqrt_information * T_map_body.linear();
    J.rightCols<3>() = -J.leftCols<3>() * core::so3::hat(p_body);
    return (*this)(T_map_body);
  }
};

}  // namespace tarmac::estimators
