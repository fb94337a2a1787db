/// What Gaussian processes claim to know: means and covariances against the dense solution and a smoother in vector
/// space, against draws on SE(3), and against the book's form.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "core/error.h"
#include "tests/core/gp_batch.h"
#include "tests/core/gp_examples.h"

namespace tarmac::core {
namespace {

using tests::Curve;
using tests::GpCase;
using tests::inverse_spd;
using tests::Normals;
using tests::ratios;

class EveryProcessClaims : public ::testing::TestWithParam<GpCase> {
 protected:
  GpPrior prior() const { return GetParam().prior(); }
};
INSTANTIATE_TEST_SUITE_P(Gp, EveryProcessClaims, ::testing::ValuesIn(tests::every_gp()),
                         [](const auto& each) { return each.param.name; });

// ---------------------------------------------------------------------------------------------------------------------
// Vector space: pure translation, rotation held. Everything is linear, so that one step of the batch is the answer.

struct Measured {
  double t;
  int axis;
  double z, sigma;
};

/// One axis: x(0) ~ N(mean, P), x' = A x + L w, and some positions measured.
struct AxisProblem {
  GpModel model;
  double rate, qc;
  Eigen::VectorXd mean;
  Eigen::MatrixXd P;
  std::vector<Measured> measured;

  Eigen::MatrixXd Phi(double d) const { return gp_transition(model, rate, d); }
  Eigen::MatrixXd Q(double d) const { return qc * gp_noise(model, rate, d); }
};

struct Posterior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd P;
};

/// The dense solution: the covariance of x at any two times, conditioned on all that was measured.
Posterior dense(const AxisProblem& p, double t) {
  const auto kernel = [&](double a, double b) -> Eigen::MatrixXd {
    const double first = std::min(a, b);
    Eigen::MatrixXd at_first = p.Phi(first) * p.P * p.Phi(first).transpose();
    if (first > 0) at_first += p.Q(first);
    return p.Phi(a - first) * at_first * p.Phi(b - first).transpose();
  };
  const auto n = static_cast<Eigen::Index>(p.measured.size());
  Eigen::MatrixXd K(n, n), cross(p.mean.size(), n);
  Eigen::VectorXd misfit(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Measured& m = p.measured[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) K(i, j) = kernel(m.t, p.measured[static_cast<std::size_t>(j)].t)(0, 0);
    K(i, i) += m.sigma * m.sigma;
    cross.col(i) = kernel(t, m.t).col(0);
    misfit[i] = m.z - (p.Phi(m.t) * p.mean)[0];
  }
  const Eigen::MatrixXd gain = K.ldlt().solve(cross.transpose()).transpose();
  return {p.Phi(t) * p.mean + gain * misfit, kernel(t, t) - gain * cross.transpose()};
}

/// Kalman's filter forwards and Rauch, Tung and Striebel's smoother backwards over all times of interest.
std::map<double, Posterior> smoothed(const AxisProblem& p, const std::vector<double>& asked) {
  std::map<double, std::vector<Measured>> at;
  for (const double t : asked) at[t];
  for (const Measured& m : p.measured) at[m.t].push_back(m);
  struct Step {
    double t;
    Posterior predicted, filtered;
  };
  std::vector<Step> steps;
  double before = 0;
  Posterior x{p.mean, p.P};
  for (const auto& [t, measured] : at) {
    if (t > before)
      x = {p.Phi(t - before) * x.mean, p.Phi(t - before) * x.P * p.Phi(t - before).transpose() + p.Q(t - before)};
    const Posterior predicted = x;
    for (const Measured& m : measured) {
      const Eigen::VectorXd gain = x.P.col(0) / (x.P(0, 0) + m.sigma * m.sigma);
      x.mean += gain * (m.z - x.mean[0]);
      x.P = (x.P - gain * x.P.row(0)).eval();
    }
    steps.push_back({t, predicted, x});
    before = t;
  }
  std::map<double, Posterior> out;
  Posterior later = steps.back().filtered;
  out[steps.back().t] = later;
  for (std::size_t i = steps.size() - 1; i-- > 0;) {
    const Eigen::MatrixXd Phi = p.Phi(steps[i + 1].t - steps[i].t);
    const Eigen::MatrixXd gain = steps[i].filtered.P * Phi.transpose() * inverse_spd(steps[i + 1].predicted.P);
    later = {steps[i].filtered.mean + gain * (later.mean - steps[i + 1].predicted.mean),
             steps[i].filtered.P + gain * (later.P - steps[i + 1].predicted.P) * gain.transpose()};
    out[steps[i].t] = later;
  }
  return out;
}

TEST_P(EveryProcessClaims, InVectorSpaceTheBatchIsTheDenseSolutionAndTheSmoother) {
  GpPrior prior = this->prior();
  prior.rate.head<3>() << prior.rate[0], prior.rate[3], prior.rate[4];  // the interesting ones where translation is
  prior.qc.tail<3>().setConstant(1e-30);  // rotation is held: what it strays by must not turn up in translation
  const int order = prior.order(), size = prior.size();
  const std::vector<double> knots = {0, 0.3, 0.5, 1.0, 1.25};
  const std::vector<double> asked = {0, 0.07, 0.15, 0.3, 0.44, 0.5, 0.51, 0.83, 1.0, 1.1, 1.25};
  Normals normals(1, "test/vector_space");
  GpKnot start;
  start.varpi << 3, -1, 0.5, 0, 0, 0;
  if (order == 3) start.dvarpi << 0.5, 2, -1, 0, 0, 0;
  GpTrajectory trajectory(prior, {start});
  std::vector<Time> later;
  for (std::size_t i = 1; i < knots.size(); ++i) later.push_back(time_from_s(knots[i]));
  trajectory.extend(later[0], later.back(), later);

  Eigen::VectorXd sigma0 = Eigen::VectorXd::Ones(size);
  for (int j = 0; j < order; ++j) sigma0.segment<3>(6 * j) << 0.3, 0.2, 0.4;
  const Eigen::MatrixXd P0 = sigma0.cwiseAbs2().asDiagonal();
  std::array<AxisProblem, 3> axes;
  for (int a = 0; a < 3; ++a) {
    Eigen::VectorXd mean(order), var(order);
    mean << 0, start.varpi[a], start.dvarpi.segment(a, order - 2);
    for (int j = 0; j < order; ++j) var[j] = P0(6 * j + a, 6 * j + a);
    axes[static_cast<std::size_t>(a)] = {prior.model, prior.rate[a], prior.qc[a], mean, var.asDiagonal(), {}};
  }

  tests::Factors factors = tests::prior_factors(trajectory);
  factors.push_back(tests::start_factor(trajectory, trajectory.value(0), P0));
  for (int k = 0; k < 60; ++k) {
    const double t_s = knots[static_cast<std::size_t>(5 * normals.uniform())];
    const Time t = time_from_s(t_s);
    const Measured m{t_s, k % 3, 5 * normals(), 0.05};
    axes[static_cast<std::size_t>(m.axis)].measured.push_back(m);
    StateJet jet;
    trajectory.jet(t, Derivative::pose, jet);
    factors.push_back({jet.first,
                       Eigen::VectorXd::Constant(1, (jet.state.T_world_body.translation()[m.axis] - m.z) / m.sigma),
                       jet.J.row(m.axis) / m.sigma});
  }
  std::vector<int> translation;
  for (int i = 0; i < trajectory.parameters(); ++i) {
    if (i % 6 < 3) translation.push_back(i);
  }
  const tests::Batch batch = tests::solve(factors, trajectory.parameters(), translation);
  trajectory.retract(batch.step);

  for (const double t_s : asked) {
    const Time t = time_from_s(t_s);
    const int block = std::min(trajectory.first_block_at(t), trajectory.blocks() - 2);
    const GpCovariance found =
        trajectory.covariance(t, batch.covariance.block(block * size, block * size, 2 * size, 2 * size));
    EXPECT_FALSE(found.projected);
    const GpKnot state = gp_knot(t, trajectory.at(t));
    for (int a = 0; a < 3; ++a) {
      const AxisProblem& axis = axes[static_cast<std::size_t>(a)];
      const Posterior by_kernel = dense(axis, t_s), by_smoother = smoothed(axis, {t_s}).at(t_s);
      Eigen::VectorXd mean(order);
      mean << state.T_world_body.translation()[a], state.varpi[a], state.dvarpi.segment(a, order - 2);
      Eigen::MatrixXd P(order, order);
      for (int i = 0; i < order; ++i) {
        for (int j = 0; j < order; ++j) P(i, j) = found.P(6 * i + a, 6 * j + a);
      }
      for (const Posterior& expected : {by_kernel, by_smoother}) {
        EXPECT_LT((mean - expected.mean).norm() / (1 + expected.mean.norm()), 1e-9) << t_s << " axis " << a;
        const Eigen::VectorXd unit = expected.P.diagonal().cwiseSqrt().cwiseInverse();
        EXPECT_LT((unit.asDiagonal() * (P - expected.P) * unit.asDiagonal()).norm(), 1e-9) << t_s << " axis " << a;
      }
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// SE(3)

TEST_P(EveryProcessClaims, DrawsWhitenedByThePriorHaveUnitVariance) {
  const Curve curve(prior());
  const tests::GpDraw draw(curve.prior, {curve.T});
  const Eigen::MatrixXd root = tests::square_root(curve.prior.noise(curve.T));
  Normals normals(1, "test/whitened");
  constexpr int n = 4000;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(curve.prior.size()), square = mean;
  double chi = 0;
  PriorJet jet;
  for (int i = 0; i < n; ++i) {
    const GpTrajectory trajectory(curve.prior, {curve.first, draw(curve.first, normals)[0]});
    trajectory.prior(0, jet);
    const Eigen::VectorXd u = root.triangularView<Eigen::Lower>().solve(jet.e);
    mean += u / n;
    square += u.cwiseAbs2() / n;
    chi += jet.e.dot(jet.information * jet.e) / (n * static_cast<double>(jet.e.size()));
  }
  // Four standard deviations of a mean of 4000 and of its squares'.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 4 / std::sqrt(n));
  EXPECT_LT((square.array() - 1).abs().maxCoeff(), 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(chi, 1, 4 * std::sqrt(2.0 / (n * static_cast<double>(jet.e.size()))));
}

TEST_P(EveryProcessClaims, CovarianceBeyondTheLastKnotIsThatOfDrawsOnSE3) {
  const Curve curve(prior());
  const int size = curve.prior.size();
  Normals normals(1, "test/extrapolated");
  const GpTrajectory mean(curve.prior, {curve.first});
  const Time t = curve.first.t + duration_from_s(curve.T);
  const GpKnot ahead = mean.extrapolated(t);
  const tests::GpDraw draw(curve.prior, {curve.T});
  const Eigen::MatrixXd P0 = 0.25 * curve.prior.noise(curve.T), root0 = tests::square_root(P0);
  constexpr int n = 20000;
  Eigen::MatrixXd drawn = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < n; ++i) {
    const GpKnot first = tests::perturbed(curve.first, root0 * normals.vector(size));
    const Eigen::VectorXd x = tests::perturbation(ahead, draw(first, normals)[0], size);
    drawn += x * x.transpose() / n;
  }
  const GpCovariance found = mean.extrapolated_covariance(t, P0);
  for (int i = 0; i < size; ++i) EXPECT_NEAR(found.P(i, i) / drawn(i, i), 1, 0.05) << i;
  EXPECT_THROW(mean.extrapolated_covariance(curve.first.t - Duration(1), P0), OutOfSpan);
  EXPECT_EQ((mean.extrapolated_covariance(curve.first.t, P0).P - P0).norm(), 0);
}

/// The book's information form, from the priors of the sections before and after t and of the whole (Barfoot
/// 2024, 11.3).
Eigen::MatrixXd by_the_book(const GpTrajectory& two, Time t, const Eigen::MatrixXd& joint) {
  const int size = two.block_size();
  const GpTrajectory three(two.process(), {two.knots()[0], gp_knot(t, two.at(t)), two.knots()[1]});
  PriorJet before, after, whole;
  three.prior(0, before);
  three.prior(1, after);
  two.prior(0, whole);
  const auto left = [&](const PriorJet& p) -> Eigen::MatrixXd { return p.J.leftCols(size); };
  const auto right = [&](const PriorJet& p) -> Eigen::MatrixXd { return p.J.rightCols(size); };
  Eigen::MatrixXd A(2 * size, size), B = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  A << left(before).transpose() * before.information * right(before),
      right(after).transpose() * after.information * left(after);
  B.topLeftCorner(size, size) = left(before).transpose() * before.information * left(before);
  B.bottomRightCorner(size, size) = right(after).transpose() * after.information * right(after);
  const Eigen::MatrixXd C = whole.J.transpose() * whole.information * whole.J;
  const Eigen::MatrixXd own = right(before).transpose() * before.information * right(before) +
                              left(after).transpose() * after.information * left(after);
  return inverse_spd(own - A.transpose() * inverse_spd(inverse_spd(joint) + B - C) * A);
}

TEST_P(EveryProcessClaims, CovarianceBetweenKnotsAgreesWithTheBooksForm) {
  for (const bool turning : {false, true}) {
    Curve curve(prior());
    if (!turning) {
      curve.first.varpi.setZero();
      curve.first.dvarpi.setZero();
      curve.first.T_world_body.setIdentity();
    }
    GpTrajectory trajectory(curve.prior, {curve.first});
    trajectory.extend(curve.first.t, curve.first.t + duration_from_s(curve.T), {});
    tests::Factors factors = tests::prior_factors(trajectory);
    factors.push_back(tests::start_factor(trajectory, trajectory.value(0), curve.prior.noise(curve.T)));
    // Something measured at the second knot, too: joint covariances with all their entries.
    factors.push_back({curve.prior.size(), Eigen::VectorXd::Zero(6),
                       Eigen::MatrixXd::Identity(6, curve.prior.size()) / std::sqrt(curve.prior.noise(curve.T)(0, 0))});
    const Eigen::MatrixXd joint = tests::solve(factors, trajectory.parameters()).covariance;
    for (const double r : {0.2, 0.5, 0.7}) {
      const Time t = curve.first.t + duration_from_s(r * curve.T);
      const auto [low, high] = ratios(by_the_book(trajectory, t, joint), trajectory.covariance(t, joint).P);
      // At rest both are linear and the same. In a turn of 0.2 rad the book's sections are linearised each at its own
      // knot, by the first-order form: they differ by parts of |xi|.
      EXPECT_NEAR(low, 1, turning ? 0.1 : 1e-7) << r;
      EXPECT_NEAR(high, 1, turning ? 0.1 : 1e-7) << r;
    }
  }
}

TEST_P(EveryProcessClaims, CovarianceAtAKnotIsThatKnots) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 1, 3, 0.2);
  const int size = trajectory.block_size();
  Normals normals(1, "test/at_a_knot");
  Eigen::MatrixXd root(2 * size, 2 * size);
  for (int k = 0; k < 2 * size; ++k) root.col(k) = normals.vector(2 * size);
  const Eigen::MatrixXd joint = root * root.transpose();
  EXPECT_LT((trajectory.covariance(trajectory.knots()[1].t, joint).P - joint.topLeftCorner(size, size)).norm(), 1e-12);
  EXPECT_LT((trajectory.covariance(trajectory.knots()[2].t, joint).P - joint.bottomRightCorner(size, size)).norm(),
            1e-12);
  // It comes close to it on either side, in units of its own deviations.
  for (const bool second : {false, true}) {
    const Eigen::MatrixXd P = second ? joint.bottomRightCorner(size, size) : joint.topLeftCorner(size, size);
    const Time t = second ? trajectory.knots()[2].t - Duration(10) : trajectory.knots()[1].t + Duration(10);
    const Eigen::VectorXd unit = P.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT((unit.asDiagonal() * (trajectory.covariance(t, joint).P - P) * unit.asDiagonal()).norm(), 0.02);
  }
  EXPECT_THROW(trajectory.covariance(trajectory.end(), Eigen::MatrixXd::Identity(size, size)), std::invalid_argument);
  EXPECT_THROW(trajectory.covariance(trajectory.end() + Duration(1), joint), OutOfSpan);
}

/// Both knots held, half a radian turned on the way: what is left of the process comes by how the state depends on
/// gamma.
TEST_P(EveryProcessClaims, BetweenHeldKnotsOnlyTheProcessIsLeft) {
  const GpPrior prior = this->prior();
  const GpTrajectory trajectory = tests::random_gp(prior, 4, 2, 1.0);
  const int size = prior.size(), order = prior.order();
  const double d = 0.06;
  const GpInterval interval(prior.model, group_axes(prior), trajectory.knots()[0], trajectory.knots()[1]);
  const GpLocal local = interval.local(d, interval.weights(d));
  const auto state_at = [&](int k, double step) {
    GpLocal other = local;
    if (k >= 0) other.row[static_cast<std::size_t>(k / 6)][k % 6] += step;
    return state_of(prior.model, trajectory.knots()[0].T_world_body, other);
  };
  Eigen::MatrixXd M(size, size), left = Eigen::MatrixXd::Zero(size, size);
  constexpr double h = 1e-5;
  for (int k = 0; k < size; ++k) {
    M.col(k) = (tests::perturbation(state_at(-1, 0), state_at(k, h), size) -
                tests::perturbation(state_at(-1, 0), state_at(k, -h), size)) /
               (2 * h);
  }
  for (int axis = 0; axis < 6; ++axis) {
    const GpBlock noise =
        prior.qc[axis] * GpAxis(prior.model, prior.rate[axis], interval.duration_s()).conditional_noise(d);
    for (int i = 0; i < order; ++i) {
      for (int j = 0; j < order; ++j) left(6 * i + axis, 6 * j + axis) = noise(i, j);
    }
  }
  const GpCovariance found =
      trajectory.covariance(trajectory.begin() + duration_from_s(d), Eigen::MatrixXd::Zero(2 * size, 2 * size));
  const auto [low, high] = ratios(found.P, M * left * M.transpose());
  EXPECT_NEAR(low, 1, 1e-6);
  EXPECT_NEAR(high, 1, 1e-6);
}

TEST_P(EveryProcessClaims, ACovarianceThatIsNoneIsProjectedAndSaysSo) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 2, 2, 0.2);
  const int size = trajectory.block_size();
  // Less than nothing along one direction.
  Normals normals(1, "test/indefinite");
  const Eigen::VectorXd along = normals.vector(2 * size).normalized();
  Eigen::MatrixXd joint = 100 * Eigen::MatrixXd::Identity(2 * size, 2 * size);
  const Time t = trajectory.begin() + std::chrono::milliseconds(40);
  EXPECT_FALSE(trajectory.covariance(t, joint).projected);
  joint -= 300 * along * along.transpose();
  const GpCovariance found = trajectory.covariance(t, joint);
  EXPECT_TRUE(found.projected);
  EXPECT_EQ((found.P - found.P.transpose()).norm(), 0);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(found.P).eigenvalues()[0], -1e-12 * found.P.norm());
}

TEST_P(EveryProcessClaims, TheHessianIsBlockTridiagonal) {
  const GpTrajectory trajectory = tests::random_gp(prior(), 3, 7, 0.2);
  const int size = trajectory.block_size();
  Normals normals(1, "test/tridiagonal");
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(trajectory.parameters(), trajectory.parameters());
  tests::Factors factors = tests::prior_factors(trajectory);
  for (int k = 0; k < 200; ++k) {
    StateJet jet;
    trajectory.jet(time_from_s(0.6 * normals.uniform()), Derivative::acceleration, jet);
    ASSERT_LE(jet.columns(), 2 * size);
    factors.push_back({jet.first, {}, normals.vector(18).transpose() * jet.J});
  }
  for (const auto& f : factors) H.block(f.first, f.first, f.J.cols(), f.J.cols()) += f.J.transpose() * f.J;
  for (int i = 0; i < trajectory.blocks(); ++i) {
    for (int j = 0; j < trajectory.blocks(); ++j) {
      const double norm = H.block(i * size, j * size, size, size).norm();
      if (std::abs(i - j) > 1) {
        EXPECT_EQ(norm, 0);
      } else {
        EXPECT_GT(norm, 0);
      }
    }
  }
}

}  // namespace
}  // namespace tarmac::core
