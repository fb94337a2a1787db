#include "estimators/ct_icp/elastic_problem.h"

#include <algorithm>

#include "estimators/blocks/point_to_plane.h"

namespace tarmac::estimators {
namespace {

using core::Row6;
using core::SE3;
using Eigen::Matrix3d;
using Eigen::Vector3d;

int count_used(std::span<const Association> associations) {
  return static_cast<int>(
      std::count_if(associations.begin(), associations.end(), [](const Association& a) { return a.used; }));
}

/// Three rows of |value|^2, moved by the translations of begin and end: t <- t + R rho.
void add_rows(std::vector<PriorRow>& rows, double weight, const Vector3d& value, const Matrix3d& by_t_begin,
              const Matrix3d& by_t_end) {
  if (!(weight > 0)) return;
  for (int axis = 0; axis < 3; ++axis) {
    PriorRow& row = rows.emplace_back();
    row.value = value[axis];
    row.weight = weight;
    row.by_begin.head<3>() = by_t_begin.row(axis);
    row.by_end.head<3>() = by_t_end.row(axis);
  }
}

/// With m = q_e'^-1 q_b = (w, v): the value is 1 - w^2, and q_b <- q_b (1, d/2) moves w by -v . d/2.
PriorRow orientation_row(double weight, const Matrix3d& R_begin, const Matrix3d& R_previous_end) {
  const Eigen::Quaterniond m(Matrix3d(R_previous_end.transpose() * R_begin));
  PriorRow row;
  row.value = m.vec().squaredNorm();
  row.weight = weight;
  row.by_begin.tail<3>() = m.w() * m.vec().transpose();
  return row;
}

double data_cost(const ElasticProblem& problem, const core::Segment& motion) {
  const SegmentSampler sampler(motion);
  double sum = 0;
  for (std::size_t k = 0; k < problem.keypoints.size(); ++k) {
    const Association& a = problem.associations[k];
    if (!a.used) continue;
    const Keypoint& keypoint = problem.keypoints[k];
    const double r = a.weight * PointToPlane{keypoint.p_body, a.q_map, a.n_map}(sampler.pose(keypoint.alpha));
    sum += problem.loss(r * r).rho;
  }
  return sum;
}

}  // namespace

std::vector<PriorRow> prior_rows(const Regularisers& regularisers, int residuals, const core::Segment& motion) {
  const Regularisers& reg = regularisers;
  const SE3 &begin = motion.poses.at(0), &end = motion.poses.at(1);
  const Matrix3d &R_b = begin.linear(), &R_e = end.linear(), zero = Matrix3d::Zero();
  const Vector3d displacement = end.translation() - begin.translation();
  const Vector3d previous = reg.T_previous_end.translation() - reg.T_previous_begin.translation();
  std::vector<PriorRow> rows;
  if (reg.quirk) {
    add_rows(rows, residuals * reg.beta_location, -displacement, R_b, zero);
    add_rows(rows, residuals * reg.beta_constant_velocity, displacement - previous, zero, R_e);
  } else {
    add_rows(rows, residuals * reg.beta_location, begin.translation() - reg.T_previous_end.translation(), R_b, zero);
    add_rows(rows, residuals * reg.beta_constant_velocity, displacement - previous, -R_b, R_e);
  }
  add_rows(rows, residuals * reg.beta_small_velocity, -displacement, R_b, -R_e);
  if (reg.beta_orientation > 0) {
    rows.push_back(orientation_row(residuals * reg.beta_orientation, R_b, reg.T_previous_end.linear()));
  }
  return rows;
}

void assemble(const ElasticProblem& problem, const core::Segment& motion, NormalEquations& equations) {
  equations.set_zero();
  const SegmentSampler sampler(motion);
  std::array<core::BlockJacobian, 2> chain;
  const std::span<const core::BlockJacobian> blocks(chain.data(), static_cast<std::size_t>(sampler.blocks()));
  for (std::size_t k = 0; k < problem.keypoints.size(); ++k) {
    const Association& a = problem.associations[k];
    if (!a.used) continue;
    const Keypoint& keypoint = problem.keypoints[k];
    const SE3 T = sampler.pose(keypoint.alpha, chain);
    Row6 J;
    const double r = PointToPlane{keypoint.p_body, a.q_map, a.n_map}(T, J);
    const double w2 = a.weight * a.weight;
    equations.add_data(r, w2 * problem.loss(w2 * r * r).first, J, blocks);
  }
  if (problem.regularisers == nullptr || sampler.blocks() != 2) return;
  for (const PriorRow& row : prior_rows(*problem.regularisers, equations.data_rows(), motion)) {
    const NormalEquations::PriorTerm terms[] = {{0, row.by_begin}, {1, row.by_end}};
    equations.add_prior(row.value, row.weight, terms);
  }
}

bool gauss_newton_step(const ElasticProblem& problem, core::Segment& motion) {
  NormalEquations equations(static_cast<int>(motion.poses.size()));
  assemble(problem, motion, equations);
  Eigen::VectorXd x;
  if (!equations.solve(x)) return false;
  for (std::size_t b = 0; b < motion.poses.size(); ++b) {
    const core::Vector6 xi = x.segment<6>(6 * static_cast<Eigen::Index>(b));
    motion.poses[b] = core::se3::normalized(motion.poses[b] * core::se3::exp(xi));
  }
  return true;
}

double cost(const ElasticProblem& problem, const core::Segment& motion) {
  double sum = data_cost(problem, motion);
  if (problem.regularisers != nullptr && motion.poses.size() == 2) {
    for (const PriorRow& row : prior_rows(*problem.regularisers, count_used(problem.associations), motion)) {
      sum += row.weight * row.value * row.value;
    }
  }
  return 0.5 * sum;
}

}  // namespace tarmac::estimators
