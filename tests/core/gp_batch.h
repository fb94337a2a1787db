/// Draws from a Gaussian process on SE(3), and a batch solver for what it is observed by: dense, plain, for tests.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/gp_trajectory.h"
#include "core/random.h"

namespace tarmac::tests {

/// Square root of a covariance whose entries differ by many powers of ten: L L^T = P.
inline Eigen::MatrixXd square_root(const Eigen::MatrixXd& P) {
  const Eigen::VectorXd sigma = P.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = sigma.cwiseInverse();
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * P * inverse.asDiagonal();
  return sigma.asDiagonal() * Eigen::MatrixXd(correlation.llt().matrixL());
}

/// Inverse of a positive definite matrix, whatever its units.
inline Eigen::MatrixXd inverse_spd(const Eigen::MatrixXd& P) {
  const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * P * scale.asDiagonal();
  return scale.asDiagonal() * unit.llt().solve(Eigen::MatrixXd::Identity(P.rows(), P.cols())) * scale.asDiagonal();
}

/// Ratios of two covariances along all directions: 1 and 1 if they are equal.
inline std::pair<double, double> ratios(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Eigen::MatrixXd root = square_root(B);
  const Eigen::MatrixXd half = root.triangularView<Eigen::Lower>().solve(A);
  const Eigen::MatrixXd whole = root.triangularView<Eigen::Lower>().solve(half.transpose());
  const auto values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(whole).eigenvalues();
  return {values.minCoeff(), values.maxCoeff()};
}

class Normals {
 public:
  Normals(std::uint64_t seed, const std::string& name) : stream_(seed, name) {}
  double operator()() { return stream_.normal(next_++); }
  double uniform() { return stream_.uniform(next_++, 1); }
  Eigen::VectorXd vector(Eigen::Index n) {
    Eigen::VectorXd v(n);
    for (Eigen::Index i = 0; i < n; ++i) v[i] = (*this)();
    return v;
  }

 private:
  core::RandomStream stream_;
  std::uint64_t next_ = 0;
};

/// A knot-like state with its block's perturbation added.
inline core::GpKnot perturbed(core::GpKnot knot, const Eigen::VectorXd& d) {
  knot.T_world_body = core::se3::normalized(knot.T_world_body * core::se3::exp(d.head<6>()));
  knot.varpi += d.segment<6>(6);
  if (d.size() > 12) knot.dvarpi += d.segment<6>(12);
  return knot;
}

/// The perturbation that leads from `base` to `knot`.
inline Eigen::VectorXd perturbation(const core::GpKnot& base, const core::GpKnot& knot, int size) {
  Eigen::VectorXd d(size);
  d.head<6>() = core::se3::log(base.T_world_body.inverse() * knot.T_world_body);
  d.segment<6>(6) = knot.varpi - base.varpi;
  if (size > 12) d.tail<6>() = knot.dvarpi - base.dvarpi;
  return d;
}

/// The process itself over one interval, in the local variable of its first knot: states at the given times after it
/// [s], ascending, drawn one after the other.
class GpDraw {
 public:
  GpDraw(const core::GpPrior& prior, const std::vector<double>& after_s) : prior_(prior) {
    double d = 0;
    for (const double next : after_s) {
      Phi_.push_back(prior.transition(next - d));
      root_.push_back(square_root(prior.noise(next - d)));
      after_.push_back(next);
      d = next;
    }
  }
  std::vector<core::GpKnot> operator()(const core::GpKnot& first, Normals& normals) const {
    const int size = prior_.size();
    Eigen::VectorXd gamma(size);
    gamma << core::Vector6::Zero(), first.varpi, first.dvarpi.head(size - 12);
    std::vector<core::GpKnot> out;
    for (std::size_t i = 0; i < after_.size(); ++i) {
      gamma = Phi_[i] * gamma + root_[i] * normals.vector(size);
      core::GpLocal local;
      local.row.fill(core::Vector6::Zero());
      for (int j = 0; j < prior_.order(); ++j) local.row[static_cast<std::size_t>(j)] = gamma.segment<6>(6 * j);
      out.push_back(core::state_of(prior_.model, first.T_world_body, local));
      if (prior_.model == core::GpModel::wnoa) out.back().dvarpi.setZero();
      out.back().t = first.t + core::duration_from_s(after_[i]);
    }
    return out;
  }

 private:
  core::GpPrior prior_;
  std::vector<double> after_;
  std::vector<Eigen::MatrixXd> Phi_, root_;
};

/// One whitened residual with its Jacobian by the parameters from `first` on.
struct Factor {
  int first = 0;
  Eigen::VectorXd e;
  Eigen::MatrixXd J;
};
using Factors = std::vector<Factor>;

inline Factors prior_factors(const core::GpTrajectory& trajectory) {
  Factors out;
  core::PriorJet jet;
  for (int i = 0; i < trajectory.priors(); ++i) {
    trajectory.prior(i, jet);
    const Eigen::MatrixXd root =
        square_root(trajectory.process().noise(core::to_s(trajectory.knots()[static_cast<std::size_t>(i) + 1].t -
                                                          trajectory.knots()[static_cast<std::size_t>(i)].t)))
            .triangularView<Eigen::Lower>()
            .solve(Eigen::MatrixXd::Identity(jet.e.size(), jet.e.size()));
    out.push_back({jet.first, root * jet.e, root * jet.J});
  }
  return out;
}

/// A Gaussian on the first knot.
inline Factor start_factor(const core::GpTrajectory& trajectory, const Eigen::VectorXd& mean,
                           const Eigen::MatrixXd& P) {
  Factor f;
  trajectory.difference(0, mean, f.e, f.J);
  const Eigen::MatrixXd root =
      square_root(P).triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(P.rows(), P.rows()));
  return {0, root * f.e, root * f.J};
}

struct Batch {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
};

/// The least-squares step and the inverse of the normal equations, over the parameters named by `free` (all if empty).
inline Batch solve(const Factors& factors, int parameters, const std::vector<int>& free = {}) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(parameters, parameters);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(parameters);
  for (const Factor& f : factors) {
    H.block(f.first, f.first, f.J.cols(), f.J.cols()).noalias() += f.J.transpose() * f.J;
    g.segment(f.first, f.J.cols()).noalias() += f.J.transpose() * f.e;
  }
  if (free.empty()) {
    const Eigen::MatrixXd P = inverse_spd(H);
    return {-P * g, P};
  }
  const Eigen::MatrixXd P_free = inverse_spd(H(free, free));
  const Eigen::VectorXd step_free = -P_free * g(free);
  Batch out{Eigen::VectorXd::Zero(parameters), Eigen::MatrixXd::Zero(parameters, parameters)};
  out.step(free) = step_free;
  out.covariance(free, free) = P_free;
  return out;
}

/// A motion with velocity and turn, noise of some percent of it: small enough to be linear, as all covariances suppose.
struct Curve {
  core::GpPrior prior;
  core::GpKnot first;
  double T = 0.1;

  explicit Curve(const core::GpPrior& p) : prior(p) {
    first.T_world_body = core::se3::exp(core::Vector6::Constant(0.7));
    first.varpi << 2, -1, 0.5, 0.9, -1.2, 1.5;  // 0.2 rad from knot to knot
    if (p.order() == 3) first.dvarpi << 3, 2, -4, 1, 2, -3;
    prior.qc *= p.order() == 2 ? 0.02 : 2;
  }
};

}  // namespace tarmac::tests
