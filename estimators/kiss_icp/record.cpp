#include "estimators/kiss_icp/record.h"

#include <algorithm>

#include "estimators/blocks/residual_row.h"
#include "estimators/blocks/stopwatch.h"

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

/// Three rows a matched point, one a point with a surface.
class RowWriter {
 public:
  RowWriter(const core::LidarSweep& sweep, const KissOdometry::Step& step, const SE3& T_lidar_body)
      : sweep_(sweep), step_(step), T_lidar_body_(T_lidar_body), T_body_lidar_(T_lidar_body.inverse()) {}

  void write(std::size_t i, const Match& match, std::vector<core::ResidualRow>& rows) const {
    const Matrix36 J = jacobian(T_map_body(i).linear(), T_body_lidar_ * sweep_.point(i));
    for (int axis = 0; axis < 3; ++axis)
      rows.push_back(residual_row(sweep_, i, match.residual_m[axis], match.weight, J.row(axis)));
  }

  void write(const KissOdometry::SurfacePoint& at, std::vector<core::ResidualRow>& rows) const {
    const SE3 T = T_map_body(at.point);
    const Vector3d p_body = T_body_lidar_ * sweep_.point(at.point), p_map = T * p_body;
    const Vector3d to_sensor = T * T_body_lidar_.translation() - p_map;
    const Vector3d n_map = at.plane.normal.dot(to_sensor) < 0 ? Vector3d(-at.plane.normal) : at.plane.normal;
    const Vector3d n_body = T.linear().transpose() * n_map;
    core::Row6 J;
    J << n_body.transpose(), p_body.cross(n_body).transpose();
    rows.push_back(residual_row(sweep_, at.point, n_map.dot(p_map - at.plane.centre), 1, J));
  }

 private:
  SE3 T_map_body(std::size_t i) const {
    return step_.icp.T_map_lidar_linearised * step_.motion.T_end_point(sweep_.t_ns[i]) * T_lidar_body_;
  }

  const core::LidarSweep& sweep_;
  const KissOdometry::Step& step_;
  SE3 T_lidar_body_, T_body_lidar_;
};

/// The measured path over the sweep's span, moved from the left so that at the last point it is at `T_map_body`.
core::Segment carried(const core::LidarSweep& sweep, const SweepMotion& motion, const SE3& T_map_body) {
  const core::Segment& path = *motion.path();
  const SE3 T_map_path = T_map_body * motion.path_pose(motion.last_ns()).inverse();
  std::vector<core::Time> times;
  std::vector<SE3> poses;
  const auto node = [&](core::Time t, const SE3& T_path_body) {
    times.push_back(t);
    poses.push_back(core::se3::normalized(T_map_path * T_path_body));
  };
  const core::Time begin = std::max(sweep.begin, path.t0), end = std::min(sweep.end, path.t1);
  node(begin, path.pose(begin));
  for (std::size_t k = 0; k < path.times.size(); ++k) {
    if (path.times[k] > begin && path.times[k] < end) node(path.times[k], path.poses[k]);
  }
  if (end > begin) node(end, path.pose(end));
  return core::Segment::sampled(path.model, std::move(times), std::move(poses));
}

core::SweepStatus status(const KissOdometry& odometry, const KissOdometry::Step& step) {
  if (odometry.icp_sample().empty()) return core::SweepStatus::empty;
  return step.icp.solved ? core::SweepStatus::ok : core::SweepStatus::lost;
}

}  // namespace

std::vector<core::Segment> placed_by(const core::LidarSweep& sweep, const SweepMotion& motion, const SE3& T_map_lidar,
                                     const SE3& T_lidar_body) {
  using core::Segment;
  if (!motion.moves()) return {Segment::hold(sweep.begin, sweep.end, T_map_lidar * T_lidar_body)};
  if (motion.path()) return {carried(sweep, motion, T_map_lidar * T_lidar_body)};
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
  if (level == core::DiagnosticsLevel::full) {
    for (const KissOdometry::SurfacePoint& at : step.surface) rows.write(at, record.surface);
  }
  return record;
}

SweepOutcome outcome_of(const core::LidarSweep& sweep, const KissOdometry& odometry, KissOdometry::Step step,
                        const SE3& T_lidar_body, core::DiagnosticsLevel level) {
  SweepOutcome outcome;
  outcome.stages_ms = std::move(step.stages_ms);
  Stopwatch stopwatch(outcome.stages_ms);

  // Stamps beyond the sweep's end are a fault of the sensor's; the reference stays inside.
  const core::Duration span = sweep.end - sweep.begin;
  const core::Duration last =
      sweep.empty() ? span : std::clamp(core::Duration(step.motion.last_ns()), core::Duration(0), span);
  const SE3 T_last_reference =
      last.count() == step.motion.last_ns() ? SE3::Identity() : step.motion.T_end_point(last.count());
  outcome.result = {.index = sweep.index,
                    .begin = sweep.begin,
                    .end = sweep.end,
                    .reference = sweep.begin + last,
                    .status = status(odometry, step),
                    .T_map_body = step.icp.T_map_lidar * T_last_reference * T_lidar_body};
  outcome.motion = placed_by(sweep, step.motion, step.icp.T_map_lidar, T_lidar_body);
  if (level != core::DiagnosticsLevel::none) {
    outcome.diagnostics = record_of(sweep, odometry, step, T_lidar_body, level);
    stopwatch.lap(kRecordStage);
  }
  outcome.diagnostics.index = sweep.index;
  return outcome;
}

}  // namespace tarmac::estimators
