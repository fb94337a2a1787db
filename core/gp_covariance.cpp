/// Covariances between and beyond knots.
///
/// Given both knots, gamma at d is Gaussian with mean Lambda gamma_1 + Psi gamma_2 and the covariance that is left of
/// the process in between, (Q(d)^-1 + Phi(T - d)^T Q(T - d)^-1 Phi(T - d))^-1. With J the exact Jacobian of the
/// interpolated state by the knots and M by gamma,
///   P = J P_12 J^T + M (...) M^T.
/// In a vector space this is the book's information form (Barfoot 2024, 11.3: P^-1 = E^T Q^-1 E + F^T Q^-1 F - A^T
/// (P_12^-1 + B - C)^-1 A); it needs no inverse of P_12 and, as a sum of two squares, cannot become indefinite where
/// that form can: when its sections are linearised at different points.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/gp_trajectory.h"
#include "core/symmetric_eigen.h"

namespace tarmac::core {
namespace {

void check_size(const Eigen::MatrixXd& P, int size) {
  if (P.rows() != size || P.cols() != size || !P.allFinite()) {
    throw std::invalid_argument(fmt::format("a covariance of {} x {} finite numbers is needed here; it has {} x {}",
                                            size, size, P.rows(), P.cols()));
  }
}

/// Symmetrised; judged and projected in units of its own standard deviations, since metres and m/s^2 do not compare.
GpCovariance checked(const Eigen::MatrixXd& raw) {
  constexpr double kRounding = 1e-9;
  GpCovariance out{0.5 * (raw + raw.transpose()), false};
  const Eigen::VectorXd sigma = out.P.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::VectorXd inverse = sigma.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
  const SymmetricEigen eigen(inverse.asDiagonal() * out.P * inverse.asDiagonal());
  if (eigen.eigenvalues()[0] >= -kRounding) return out;
  const Eigen::MatrixXd V = sigma.asDiagonal() * eigen.eigenvectors();
  out.P = V * eigen.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
  out.P = (0.5 * (out.P + out.P.transpose())).eval();
  out.projected = true;
  return out;
}

Derivative highest(const GpPrior& prior) {
  return prior.model == GpModel::wnoa ? Derivative::velocity : Derivative::acceleration;
}

/// L with L L^T the matrix, which is positive semi-definite but for rounding; judged in units of its own deviations.
GpBlock root_of(const GpBlock& noise) {
  const auto sigma = noise.diagonal().cwiseMax(0).cwiseSqrt().eval();
  const auto inverse = sigma.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; }).eval();
  const SymmetricEigen eigen(inverse.asDiagonal() * noise * inverse.asDiagonal());
  return sigma.asDiagonal() * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// M L: the covariance of the state (pose, varpi[, varpi']) at d with both knots held is this times its transpose.
GpJacobian conditional_root(const GpPrior& prior, const GpInterval& interval, double d, Derivative upto) {
  const int n = static_cast<int>(upto) + 1;
  GpJacobian L = GpJacobian::Zero(6 * n, 6 * n);
  for (int axis = 0; axis < 6; ++axis) {
    const GpBlock root = root_of(prior.qc[axis] * interval.axis(axis).conditional_noise(d).topLeftCorner(n, n));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) L(6 * i + axis, 6 * j + axis) = root(i, j);
    }
  }
  return state_by_gamma(prior.model, interval.local(d, interval.weights(d)), upto) * L;
}

}  // namespace

Eigen::MatrixXd GpTrajectory::conditional_covariance(Time t, Derivative upto) const {
  Eigen::MatrixXd out = ParametricTrajectory::conditional_covariance(t, upto);
  const std::size_t k = interval_at(t);
  if (t == knots_[k].t || t == end()) return out;
  const Derivative own = std::min(upto, highest(prior_));
  const double d = since_knot(k, t);
  StateJet jet;
  world_rows(intervals_[k].state(d), conditional_root(prior_, intervals_[k], d, own), jet);
  const Eigen::MatrixXd root = jet.J.topRows(state_row::filled(own));
  out.topLeftCorner(root.rows(), root.rows()) = root * root.transpose();
  return out;
}

GpCovariance GpTrajectory::covariance(Time t, const Eigen::MatrixXd& joint) const {
  check_span(t);
  const int size = block_size();
  check_size(joint, 2 * size);
  if (intervals_.empty()) throw std::logic_error("there is no pair of knots around a single one");
  const std::size_t k = std::min(interval_at(t), intervals_.size() - 1);
  if (t == knots_[k].t) return checked(joint.topLeftCorner(size, size));
  if (t == knots_[k + 1].t) return checked(joint.bottomRightCorner(size, size));
  const GpInterval& interval = intervals_[k];
  const double d = since_knot(k, t);
  const Derivative upto = highest(prior_);
  GpKnot unused;
  const Eigen::MatrixXd J = jacobians_[k].state(interval, d, upto, unused);
  const Eigen::MatrixXd root = conditional_root(prior_, interval, d, upto);
  return checked(J * joint * J.transpose() + root * root.transpose());
}

/// The state after d is T Exp(xi) with gamma = Phi(d) gamma_1 + noise of covariance Q(d).
GpCovariance GpTrajectory::extrapolated_covariance(Time t, const Eigen::MatrixXd& of_last_knot) const {
  const int size = block_size();
  check_size(of_last_knot, size);
  if (t < end()) throw OutOfSpan(fmt::format("t = {} ns lies before the last knot at {} ns", to_ns(t), to_ns(end())));
  if (t == end()) return checked(of_last_knot);
  const double d = to_s(t - end());
  const GpLocal local = predicted(knots_.back(), d);
  const Eigen::MatrixXd M = state_by_gamma(prior_.model, local, highest(prior_));
  Eigen::MatrixXd J = M * prior_.transition(d);
  J.leftCols<6>().setZero();
  J.topLeftCorner<6, 6>() = se3::adjoint(se3::exp(-local.row[0]));
  return checked(J * of_last_knot * J.transpose() + M * prior_.noise(d) * M.transpose());
}

}  // namespace tarmac::core
