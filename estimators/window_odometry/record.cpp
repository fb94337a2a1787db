#include "estimators/window_odometry/record.h"

#include "estimators/blocks/point_to_plane.h"
#include "estimators/blocks/residual_row.h"

namespace tarmac::estimators {
namespace {

using core::Matrix6;
using core::Row6;
using core::SE3;
using Eigen::Vector3d;

/// Information of one match, in units of 1/sigma_m^2, by the pose at the end, and the robust weight with it.
double add_information(const LidarFactor& factor, bool distribution, const SE3& T, const SE3& T_end_map,
                       const RobustLoss& loss, double sigma_m, Matrix6& H) {
  const Vector3d p_map = T * factor.p_body, p_end = T_end_map * p_map;
  if (!distribution) {
    const double r = factor.weight * factor.n_map.dot(p_map - factor.q_map) / sigma_m;
    const double weight = factor.weight * factor.weight * loss(r * r).first;
    const Vector3d n_end = T_end_map.linear() * factor.n_map;
    Row6 J;
    J << n_end.transpose(), p_end.cross(n_end).transpose();
    H += weight * (J.transpose() * J);
    return weight;
  }
  const Vector3d r = factor.sqrt_information * (p_map - factor.q_map) / sigma_m;
  const double weight = loss(r.squaredNorm()).first;
  // d(p_map) = R_map_end (d rho - p_end x d phi)
  Eigen::Matrix<double, 3, 6> J;
  J << T_end_map.linear().transpose(), -T_end_map.linear().transpose() * core::so3::hat(p_end);
  J = factor.sqrt_information * J;
  H += weight * (J.transpose() * J);
  return weight;
}

}  // namespace

core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const WindowOdometry& odometry,
                                 const WindowOdometry::Step& step, core::DiagnosticsLevel level) {
  const WindowOdometrySettings& settings = odometry.settings();
  const bool distribution = settings.lidar.residual == "point-to-distribution";
  core::SweepDiagnostics record;
  record.index = sweep.index;
  record.iterations = step.associations;
  record.converged = step.converged;
  record.points_in = static_cast<std::int32_t>(sweep.size());
  record.points_used = static_cast<std::int32_t>(odometry.keypoints().size());
  const RobustLoss& loss = odometry.window().model().lidar_loss;
  record.scale_m = loss.kind == Loss::standard ? 0 : loss.scale * settings.lidar.sigma_m;
  record.rows_are_surface = !distribution;
  if (step.lost || step.first) return record;
  const bool full = level == core::DiagnosticsLevel::full;
  const SE3 T_end_map = step.T_map_body_end.inverse();
  const TimedPoints& keypoints = odometry.keypoints();
  std::vector<SE3> T_map_body;
  std::vector<Vector3d> p_map;
  place(keypoints, odometry.window().trajectory(), T_map_body, p_map);
  for (std::size_t k = 0; k < odometry.matches().size(); ++k) {
    const SurfaceMatch& match = odometry.matches()[k];
    if (!match.used) continue;
    const SE3& T = T_map_body[keypoints.stamp[k]];
    const double weight =
        add_information(match.factor, distribution, T, T_end_map, loss, settings.lidar.sigma_m, record.H_data);
    ++record.residuals;
    if (!full) continue;
    Row6 J;
    const double r = PointToPlane{match.factor.p_body, match.factor.q_map, match.factor.n_map}(T, J);
    (distribution ? record.surface : record.rows).push_back(residual_row(sweep, keypoints.point[k], r, weight, J));
  }
  record.H_prior = odometry.prior_information(sweep) * settings.lidar.sigma_m * settings.lidar.sigma_m;
  const Eigen::MatrixXd covariance = odometry.window().covariance(sweep.end, core::Derivative::pose);
  if (covariance.rows() == 6) record.covariance = covariance;
  return record;
}

}  // namespace tarmac::estimators
