#include "estimators/ct_icp/registration.h"

namespace tarmac::estimators {
namespace {

struct Change {
  double translation_m = 0, rotation_rad = 0;
};

Change change_between(const core::Segment& from, const core::Segment& to) {
  Change sum;
  for (std::size_t b = 0; b < from.poses.size(); ++b) {
    sum.translation_m += (to.poses[b].translation() - from.poses[b].translation()).norm();
    sum.rotation_rad += core::so3::angle_rad(from.poses[b].linear().transpose() * to.poses[b].linear());
  }
  return sum;
}

}  // namespace

ElasticResult ElasticRegistration::align(const VoxelMap& map, const ElasticSettings& settings,
                                         std::span<const Keypoint> keypoints, const Eigen::Vector3d& p_body_lidar,
                                         const Regularisers* regularisers, const core::Segment& start) {
  ElasticResult result{.motion = start};
  associations_.clear();
  if (static_cast<int>(keypoints.size()) < settings.min_residuals) return result;
  while (!result.converged && result.iterations < settings.max_iterations) {
    const core::Segment before = result.motion;
    result.residuals = associate(map, settings.association, before, p_body_lidar, keypoints, associations_);
    ++result.iterations;
    const ElasticProblem problem{keypoints, associations_, settings.loss, regularisers};
    result.solved = result.residuals >= settings.min_residuals &&
                    (settings.use_ceres ? solve_with_ceres(problem, settings.ceres_max_iterations, result.motion)
                                        : gauss_newton_step(problem, result.motion));
    if (!result.solved) {
      result.motion = start;
      return result;
    }
    const Change change = change_between(before, result.motion);
    result.converged = change.translation_m < settings.convergence_m && change.rotation_rad < settings.convergence_rad;
  }
  return result;
}

}  // namespace tarmac::estimators
