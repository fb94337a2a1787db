#include "estimators/kiss_icp/record.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

Matrix36 jacobian(const Matrix3d& R, const Vector3d& p_body) {
  Matrix36 J;
  J << R, -R * core::so3::hat(p_body);
  return J;
}

/// Three rows a matched point.
class RowWriter {
 public:
  RowWriter(const core::LidarSweep& sweep, const KissOdometry::Step& step, const SE3& T_lidar_body)
      : sweep_(sweep), step_(step), T_lidar_body_(T_lidar_body), T_body_lidar_(T_lidar_body.inverse()) {}

  void write(std::size_t i, const Match& match, std::vector<core::ResidualRow>& rows) const {
    const SE3 T_map_body = step_.icp.T_map_lidar_linearised * step_.motion.T_end_point(sweep_.t_ns[i]) * T_lidar_body_;
    const Matrix36 J = jacobian(T_map_body.linear(), T_body_lidar_ * sweep_.point(i));
    for (int axis = 0; axis < 3; ++axis) {
      core::ResidualRow& row = rows.emplace_back();
      row.t_ns = sweep_.t_ns[i];
      row.value = static_cast<float>(match.residual_m[axis]);
      row.weight = static_cast<float>(match.weight);
      for (int k = 0; k < 6; ++k) row.jacobian[k] = static_cast<float>(J(axis, k));
      row.sensor = sweep_.sensor;
    }
  }

 private:
  const core::LidarSweep& sweep_;
  const KissOdometry::Step& step_;
  SE3 T_lidar_body_, T_body_lidar_;
};

}  // namespace

std::vector<core::Segment> placed_by(const core::LidarSweep& sweep, const SweepMotion& motion, const SE3& T_map_lidar,
                                     const SE3& T_lidar_body) {
  using core::Segment;
  if (!motion.moves()) return {Segment::hold(sweep.begin, sweep.end, T_map_lidar * T_lidar_body)};
  std::int64_t t0_ns = 0, t1_ns = (sweep.end - sweep.begin).count();
  if (motion.phase(t0_ns) < -1 || motion.phase(t1_ns) > 2) {
    t0_ns = motion.first_ns();
    t1_ns = std::min<std::int64_t>(t1_ns, motion.last_ns());
  }
  const auto pose = [&](std::int64_t t_ns) -> SE3 { return T_map_lidar * motion.T_end_point(t_ns) * T_lidar_body; };
  return {Segment::two_pose(core::SegmentModel::two_pose_screw, sweep.begin + core::Duration(t0_ns), pose(t0_ns),
                            sweep.begin + core::Duration(t1_ns), pose(t1_ns))};
}

core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const KissOdometry& odometry,
                                 const KissOdometry::Step& step, const SE3& T_lidar_body,
                                 core::DiagnosticsLevel level) {
  core::SweepDiagnostics record;
  record.index = sweep.index;
  record.iterations = step.icp.iterations;
  record.converged = step.icp.converged;
  record.points_in = static_cast<std::int32_t>(sweep.size());
  record.points_used = static_cast<std::int32_t>(odometry.icp_sample().size());
  record.scale_m = step.sigma_m;

  const SE3 T_body_lidar = T_lidar_body.inverse();
  const RowWriter rows(sweep, step, T_lidar_body);
  const std::vector<Match>& matches = odometry.registration().matches();
  if (level == core::DiagnosticsLevel::full) record.rows.reserve(3 * matches.size());
  for (std::size_t k = 0; k < matches.size(); ++k) {
    if (!(matches[k].weight > 0)) continue;
    const std::size_t i = odometry.icp_sample()[k];
    const Matrix36 J = jacobian(Matrix3d::Identity(), T_body_lidar * odometry.deskewed_m()[i]);
    record.H_data += matches[k].weight * (J.transpose() * J);
    record.residuals += 3;
    if (level == core::DiagnosticsLevel::full) rows.write(i, matches[k], record.rows);
  }
  return record;
}

}  // namespace tarmac::estimators
