#include "metrics/degeneracy/method_blocks.h"

#include "metrics/pose_pairs.h"

namespace tarmac::metrics {

using namespace core;

namespace {

/// The pose at t by the sweep's own motion: at its end, where the next one may begin, from before.
std::optional<SE3> own_pose(const PiecewiseTrajectory& trajectory, const SweepResult& sweep, Time t) {
  if (t >= sweep.end) return pose_from_before(trajectory, t);
  const Segment* segment = trajectory.find(t);
  return segment ? std::optional(segment->pose(t)) : std::nullopt;
}

/// H by the pose T, body frame and right perturbation, carried into frame c.
Matrix6 in_frame(const Matrix6& H, const SE3& T_map_body, const SE3& T_map_c) {
  const Matrix6 Ad = se3::adjoint(T_map_body.inverse() * T_map_c);
  return Ad.transpose() * H * Ad;
}

std::optional<double> prior_share_of(const SweepDiagnostics& record, const SweepResult& sweep, const SE3& T_map_c,
                                     const Spectrum& pose, double mean_range_m) {
  if (record.H_prior.isZero(0) || !record.H_prior.allFinite() || !record.H_data.allFinite()) return std::nullopt;
  Vector6 v = pose.vectors.col(0);
  v.tail<3>() /= mean_range_m;  // the eigenvector's rotation is in metres
  const double prior = v.dot(in_frame(record.H_prior, sweep.T_map_body, T_map_c) * v);
  const double data = v.dot(in_frame(record.H_data, sweep.T_map_body, T_map_c) * v);
  return prior + data > 0 ? std::optional(prior / (prior + data)) : std::nullopt;
}

}  // namespace

SweepInformation information_of(std::span<const ResidualRow> rows, const PiecewiseTrajectory& trajectory,
                                const SweepResult& sweep, const SE3& T_map_c) {
  SweepInformation information;
  std::optional<Matrix6> Ad;
  std::int32_t t_ns = 0;
  bool first = true;
  for (const ResidualRow& row : rows) {
    if (first || row.t_ns != t_ns) {  // a vector residual's rows follow one another
      const std::optional<SE3> T = own_pose(trajectory, sweep, sweep.begin + Duration(row.t_ns));
      Ad = T ? std::optional(se3::adjoint(T->inverse() * T_map_c)) : std::nullopt;
      t_ns = row.t_ns;
      first = false;
    }
    if (!Ad) continue;
    const Row6 J = Eigen::Map<const Eigen::Matrix<float, 1, 6>>(row.jacobian).cast<double>();
    information.add(J * *Ad, row.weight, ratio(sweep.begin + Duration(row.t_ns), sweep.begin, sweep.end));
  }
  return information;
}

MethodSweep method_sweep(const SweepDiagnostics& record, const PiecewiseTrajectory& trajectory,
                         const SweepResult& sweep, const Eigen::Vector3d& p_body_lidar_m, double mean_range_m) {
  MethodSweep result;
  result.index = sweep.index;
  result.end = sweep.end;
  result.solve_rows = record.rows.size();
  const std::optional<SE3> T_map_body = own_pose(trajectory, sweep, sweep.begin + (sweep.end - sweep.begin) / 2);
  if (!T_map_body || !se3::all_finite(*T_map_body)) return result;
  const SE3 T_map_c = *T_map_body * Eigen::Translation3d(p_body_lidar_m);

  SweepInformation solve = information_of(record.rows, trajectory, sweep, T_map_c);
  if (record.rows.empty() && record.residuals > 0) {
    solve.add_block(in_frame(record.H_data, sweep.T_map_body, T_map_c), static_cast<std::size_t>(record.residuals));
    result.solve_rows = static_cast<std::size_t>(record.residuals);
  }
  result.solve = analyse(solve, mean_range_m);
  if (record.rows_are_surface) {
    result.surface = result.solve;
    result.surface_rows = result.solve_rows;
  } else {
    result.surface = analyse(information_of(record.surface, trajectory, sweep, T_map_c), mean_range_m);
    result.surface_rows = record.surface.size();
  }
  if (result.solve) result.prior_share = prior_share_of(record, sweep, T_map_c, result.solve->pose, mean_range_m);
  return result;
}

}  // namespace tarmac::metrics
