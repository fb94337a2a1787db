/// KISS-ICP's registration of a thinned-out sweep against the map.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/lie.h"
#include "estimators/blocks/voxel_map.h"

namespace tarmac::estimators {

/// What the last iteration saw of one source point. weight 0: no partner within reach.
struct Match {
  Eigen::Vector3d residual_m = Eigen::Vector3d::Zero();  ///< s - q, in map axes
  double weight = 0;
};

struct IcpSettings {
  int max_iterations = 500;
  double convergence = 1e-4;
};

struct IcpResult {
  core::SE3 T_map_lidar = core::SE3::Identity();
  core::SE3 T_map_lidar_linearised = core::SE3::Identity();  ///< before the last update: where the matches hold
  int iterations = 0;
  bool converged = false;
  bool solved = false;  ///< false: too few partners to fix six degrees of freedom; T_map_lidar is the prediction
};

/// Point-to-point ICP:
///   r = s - q,  s = T p in the map, q its nearest neighbour there nearer than 3 sigma
///   w = sigma^2 / (sigma + |r|^2)^2         (sigma enters as it stands, though |r|^2 is squared: upstream's form)
///   dr/dxi = [ I  -[s]x ]  for T <- Exp(xi) T, xi = (rho, theta)
///   (sum w J^T J) xi = -sum w J^T r;  s <- Exp(xi) s,  T <- Exp(xi) T;  until |xi| < convergence
/// Source: Vizzo et al., RA-L 8(2) 2023, eq. 9-12; upstream v1.2.3.
class Registration {
 public:
  explicit Registration(const IcpSettings& settings) : settings_(settings) {}

  /// @param source_m points in the LiDAR's frame at the sweep's end
  /// Sums are taken over fixed chunks in a fixed order: the same bytes at any number of threads. An empty map gives the
  /// prediction back, solved.
  IcpResult align(std::span<const Eigen::Vector3d> source_m, const VoxelMap& map, const core::SE3& T_predicted,
                  double sigma_m);
  /// Of the last align, one a source point; empty when it did no iteration.
  const std::vector<Match>& matches() const { return matches_; }

 private:
  struct Sums;
  Sums iterate(const VoxelMap& map, const core::SE3& step, double sigma_m, bool with_hints);

  IcpSettings settings_;
  std::vector<Eigen::Vector3d> s_map_;
  std::vector<Eigen::Vector3d> q_map_;
  std::vector<Match> matches_;
};

}  // namespace tarmac::estimators
