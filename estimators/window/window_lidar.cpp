// LiDAR residuals of one stamp: they share a pose, so they are summed before the trajectory is asked.
#include "estimators/blocks/point_to_plane.h"
#include "estimators/window/point_to_distribution.h"
#include "estimators/window/window_problem.h"

namespace tarmac::estimators {

using core::Row6;

double WindowProblem::stamp_cost(const LidarFactors& factors, std::size_t index, const core::SE3& T_map_body) const {
  double sum = 0;
  for (std::size_t k = factors.first[index]; k < factors.first[index + 1]; ++k) {
    const LidarFactor& f = factors.factors[k];
    const double scale = f.weight / model_->lidar_sigma_m;
    double s = 0;
    if (factors.distributions) {
      s = PointToDistribution{f.p_body, f.q_map, f.sqrt_information}(T_map_body).squaredNorm();
    } else {
      const double r = PointToPlane{f.p_body, f.q_map, f.n_map}(T_map_body);
      s = r * r;
    }
    sum += model_->lidar_loss(scale * scale * s).rho / 2;
  }
  return sum;
}

void WindowProblem::stamp_sum(const WindowState& state, const Stamp& stamp, core::StateJet& jet, LocalSum& sum) const {
  const LidarFactors& factors = *stamp.factors;
  state.trajectory->jet(stamp.t, core::Derivative::pose, jet);
  const core::SE3& T_map_body = jet.state.T_world_body;
  core::Matrix6 H = core::Matrix6::Zero();
  core::Vector6 g = core::Vector6::Zero();
  const bool summed = model_->sum_stamp_residuals && !factors.distributions;
  Row6 J_sum = Row6::Zero();
  double r_sum = 0;
  for (std::size_t k = factors.first[stamp.index]; k < factors.first[stamp.index + 1]; ++k) {
    const LidarFactor& f = factors.factors[k];
    const double scale = f.weight / model_->lidar_sigma_m, scale2 = scale * scale;
    if (factors.distributions) {
      Eigen::Matrix<double, 3, 6> J;
      const Eigen::Vector3d r = PointToDistribution{f.p_body, f.q_map, f.sqrt_information}(T_map_body, J);
      const double w = scale2 * model_->lidar_loss(scale2 * r.squaredNorm()).first;
      H.noalias() += w * J.transpose() * J;
      g.noalias() += w * J.transpose() * r;
    } else {
      Row6 J;
      const double r = PointToPlane{f.p_body, f.q_map, f.n_map}(T_map_body, J);
      if (summed) {
        r_sum += scale * r;
        J_sum += scale * J;
        continue;
      }
      const double w = scale2 * model_->lidar_loss(scale2 * r * r).first;
      const core::Vector6 wJ = w * J.transpose();
      H.noalias() += wJ * J;
      g += r * wJ;
    }
  }
  if (summed) {
    H.noalias() = J_sum.transpose() * J_sum;
    g = r_sum * J_sum.transpose();
  }
  sum.add_pose(jet.first, jet.J.topRows(6), H, g);
}

void WindowProblem::lidar_terms(const WindowState& state, const Stamp& stamp, std::vector<Term>& out) const {
  out.clear();
  const LidarFactors& factors = *stamp.factors;
  core::StateJet jet;
  state.trajectory->jet(stamp.t, core::Derivative::pose, jet);
  const core::SE3& T_map_body = jet.state.T_world_body;
  for (std::size_t k = factors.first[stamp.index]; k < factors.first[stamp.index + 1]; ++k) {
    const LidarFactor& f = factors.factors[k];
    const double scale = f.weight / model_->lidar_sigma_m;
    Term& term = out.emplace_back();
    term.clear(factors.distributions ? 3 : 1);
    term.first = jet.first;
    term.loss = &model_->lidar_loss;
    if (factors.distributions) {
      Eigen::Matrix<double, 3, 6> J;
      term.e = scale * PointToDistribution{f.p_body, f.q_map, f.sqrt_information}(T_map_body, J);
      term.J = scale * J * jet.J.topRows(6);
    } else {
      Row6 J;
      term.e[0] = scale * PointToPlane{f.p_body, f.q_map, f.n_map}(T_map_body, J);
      term.J = scale * J * jet.J.topRows(6);
    }
  }
}

}  // namespace tarmac::estimators
