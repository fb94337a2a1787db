#include "estimators/ct_icp/record.h"

#include "estimators/blocks/point_to_plane.h"
#include "estimators/blocks/residual_row.h"

namespace tarmac::estimators {
namespace {

using core::Matrix6;
using core::Row6;
using core::SE3;

void add_priors(const CtOdometry::Step& step, int residuals, core::SweepDiagnostics& record) {
  const SE3 &begin = step.motion.poses.front(), &end = step.motion.poses.back();
  const Matrix6 begin_by_end = core::se3::adjoint(begin.inverse() * end);
  for (const PriorRow& prior : prior_rows(step.regularisers, residuals, step.motion)) {
    const Row6 J = prior.by_begin * begin_by_end + prior.by_end;
    record.H_prior += prior.weight * (J.transpose() * J);
  }
}

}  // namespace

core::SweepDiagnostics record_of(const core::LidarSweep& sweep, const CtOdometry& odometry,
                                 const CtOdometry::Step& step, core::DiagnosticsLevel level) {
  core::SweepDiagnostics record;
  record.index = sweep.index;
  record.iterations = step.registration.iterations;
  record.converged = step.registration.converged;
  record.points_in = static_cast<std::int32_t>(sweep.size());
  record.points_used = static_cast<std::int32_t>(odometry.keypoints().size());
  record.scale_m = step.settings.loss.kind == Loss::standard ? 0 : step.settings.loss.scale;
  record.rows_are_surface = true;
  const bool full = level == core::DiagnosticsLevel::full;
  const std::vector<Association>& associations = odometry.associations();
  if (full) record.rows.reserve(associations.size());

  const SegmentSampler at(step.motion);
  const SE3 T_end_map = step.motion.poses.back().inverse();
  for (std::size_t k = 0; k < associations.size(); ++k) {
    const Association& a = associations[k];
    if (!a.used) continue;
    const Keypoint& keypoint = odometry.keypoints()[k];
    const SE3 T = at.pose(keypoint.alpha);
    Row6 J, J_end;
    const double r = PointToPlane{keypoint.p_body, a.q_map, a.n_map}(T, J);
    const double w2 = a.weight * a.weight, weight = w2 * step.settings.loss(w2 * r * r).first;
    const Eigen::Vector3d n_end = T_end_map.linear() * a.n_map, p_end = T_end_map * (T * keypoint.p_body);
    J_end << n_end.transpose(), p_end.cross(n_end).transpose();
    record.H_data += weight * (J_end.transpose() * J_end);
    ++record.residuals;
    if (full) record.rows.push_back(residual_row(sweep, keypoint.point, r, weight, J));
  }
  if (step.regularised && record.residuals > 0) add_priors(step, record.residuals, record);
  return record;
}

}  // namespace tarmac::estimators
