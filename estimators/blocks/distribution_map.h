/// A map of normal distributions, one a voxel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "estimators/blocks/voxel.h"

namespace tarmac::estimators {

/// Mean and covariance of the points that fell into each voxel, updated point by point (Welford) until the voxel has
/// `max_points` of them: then it stays as it is, so that a place seen for long does not smear.
/// Source: Biber and Strasser, The Normal Distributions Transform, IROS 2003.
class DistributionMap {
 public:
  DistributionMap(double voxel_size_m, int min_points, int max_points);

  bool empty() const { return cells_.empty(); }
  std::size_t size() const { return cells_.size(); }
  /// Points out of the grid's reach are left out.
  void add(const Eigen::Vector3d& p_map);
  /// Drops every voxel whose mean is at `radius_m` or farther from `centre`.
  void remove_far(const Eigen::Vector3d& centre, double radius_m);

  struct Distribution {
    Eigen::Vector3d mean_map = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
    int points = 0;
  };
  /// Of the voxels around p (3 x 3 x 3) with at least `min_points` points, the one whose mean is nearest.
  std::optional<Distribution> nearest(const Eigen::Vector3d& p_map) const;

 private:
  struct Cell {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< sum of squares about the mean
    int points = 0;
  };
  struct Hash {
    std::size_t operator()(const Voxel& v) const { return spatial_hash(v); }
  };
  double voxel_size_m_;
  int min_points_, max_points_;
  std::unordered_map<Voxel, Cell, Hash> cells_;
};

}  // namespace tarmac::estimators
