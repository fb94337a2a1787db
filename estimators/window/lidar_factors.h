/// The LiDAR residuals of one sweep, by stamp.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/time.h"

namespace tarmac::estimators {

/// A point drawn to a plane of the map (information n n^T) or to a distribution (a full 3x3 information), both in units
/// of 1/lidar_sigma^2: point-to-plane has r = weight n^T (T p - q).
struct LidarFactor {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d q_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d n_map = Eigen::Vector3d::UnitZ();
  double weight = 1;
  Eigen::Matrix3d sqrt_information = Eigen::Matrix3d::Zero();  ///< U with U^T U the information; of distributions only
  std::uint32_t point = 0;                                     ///< index into the sweep
};

/// Factors in order of their stamps: those of stamps[i] are factors[first[i]] to factors[first[i + 1]] (exclusive), so
/// that the trajectory is asked once a stamp.
struct LidarFactors {
  bool distributions = false;  ///< sqrt_information counts; else the plane
  std::vector<core::Time> stamps;
  std::vector<std::uint32_t> first = {0};
  std::vector<LidarFactor> factors;
};

}  // namespace tarmac::estimators
