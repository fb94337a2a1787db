/// CT-ICP's registration of one sweep against the map.
#pragma once

#include <span>
#include <vector>

#include "estimators/ct_icp/association.h"

namespace tarmac::estimators {

struct ElasticSettings {
  AssociationSettings association;
  RobustLoss loss;
  bool use_ceres = false;
  int ceres_max_iterations = 1;
  int max_iterations = 5;
  int min_residuals = 100;
  double convergence_m = 1e-4, convergence_rad = 1e-4;
};

struct ElasticResult {
  core::Segment motion;  ///< where solved; else the one it started from
  int iterations = 0;
  bool converged = false;
  bool solved = false;
  int residuals = 0;  ///< of the last association
};

/// Associate, solve, again: until begin and end together move by less than convergence_m and turn by less than
/// convergence_rad. Each time gauss-newton takes one step and Ceres up to ceres_max_iterations.
class ElasticRegistration {
 public:
  /// @param start     its model and number of poses say what is solved for: two poses or one
  /// @param regularisers  may be null
  ElasticResult align(const VoxelMap& map, const ElasticSettings& settings, std::span<const Keypoint> keypoints,
                      const Eigen::Vector3d& p_body_lidar, const Regularisers* regularisers,
                      const core::Segment& start);
  /// Of the last iteration, one a keypoint; empty where there was none.
  const std::vector<Association>& associations() const { return associations_; }
  void clear() { associations_.clear(); }

 private:
  std::vector<Association> associations_;
};

}  // namespace tarmac::estimators
