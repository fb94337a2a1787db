/// Do Gaussian processes know what they do not know? Thousands of draws against what is claimed of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "tests/core/gp_batch.h"
#include "tests/core/gp_examples.h"

namespace tarmac::core {
namespace {

using tests::Curve;
using tests::GpCase;
using tests::Normals;
using tests::ratios;

class EveryProcessOnSE3 : public ::testing::TestWithParam<GpCase> {
 protected:
  GpPrior prior() const { return GetParam().prior(); }
};
INSTANTIATE_TEST_SUITE_P(Gp, EveryProcessOnSE3, ::testing::ValuesIn(tests::every_gp()),
                         [](const auto& each) { return each.param.name; });

/// Both knots and a state between them drawn again and again: the covariance between, from that of the knots alone.
TEST_P(EveryProcessOnSE3, CovarianceBetweenKnotsIsThatOfDraws) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Curve curve(prior());
    const int size = curve.prior.size();
    Normals normals(seed, "test/monte_carlo");
    const double d = curve.T * (0.2 + 0.2 * static_cast<double>(seed));
    const tests::GpDraw draw(curve.prior, {d, curve.T});
    GpTrajectory mean(curve.prior, {curve.first});
    mean.extend(curve.first.t, curve.first.t + duration_from_s(curve.T), {});
    const Time t = curve.first.t + duration_from_s(d);
    const GpKnot between = gp_knot(t, mean.at(t));
    const Eigen::MatrixXd root0 =
        0.5 * tests::square_root(curve.prior.noise(curve.T));  // the first knot is uncertain, too
    constexpr int n = 20000;
    Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(2 * size, 2 * size), drawn = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * size), x(3 * size);
    for (int i = 0; i < n; ++i) {
      const GpKnot first = tests::perturbed(curve.first, root0 * normals.vector(size));
      const std::vector<GpKnot> later = draw(first, normals);
      x << tests::perturbation(mean.knots()[0], first, size), tests::perturbation(mean.knots()[1], later[1], size),
          tests::perturbation(between, later[0], size);
      sum += x / n;
      joint += x.head(2 * size) * x.head(2 * size).transpose() / n;
      drawn += x.tail(size) * x.tail(size).transpose() / n;
    }
    joint -= sum.head(2 * size) * sum.head(2 * size).transpose();
    drawn -= sum.tail(size) * sum.tail(size).transpose();
    const GpCovariance found = mean.covariance(t, joint);
    EXPECT_FALSE(found.projected);
    for (int i = 0; i < size; ++i) EXPECT_NEAR(found.P(i, i) / drawn(i, i), 1, 0.05) << "seed " << seed << " row " << i;
    // Along every direction; 20000 draws of 18 alone spread by 2 sqrt(18/20000) = 6 %.
    const auto [low, high] = ratios(found.P, drawn);
    EXPECT_GT(low, 0.9) << seed;
    EXPECT_LT(high, 1.1) << seed;
  }
}

/// With both knots known: the same as from a joint covariance of zero, rows as a state's; nothing at a knot.
TEST_P(EveryProcessOnSE3, ConditionalCovarianceIsWhatIsLeftWithBothKnotsKnown) {
  const Curve curve(prior());
  GpTrajectory mean(curve.prior, {curve.first});
  mean.extend(curve.first.t, curve.first.t + duration_from_s(curve.T), {});
  const int size = curve.prior.size();
  for (const double share : {0.01, 0.3, 0.5, 0.9}) {
    const Time t = curve.first.t + duration_from_s(share * curve.T);
    const Eigen::MatrixXd P = mean.covariance(t, Eigen::MatrixXd::Zero(2 * size, 2 * size)).P;
    const Eigen::MatrixXd found = mean.conditional_covariance(t, Derivative::acceleration);
    ASSERT_EQ(found.rows(), state_row::count);
    const Matrix6 pose = P.topLeftCorner<6, 6>(), found_pose = found.topLeftCorner<6, 6>();
    EXPECT_LT((found_pose - pose).norm(), 1e-9 * pose.norm());
    // v = R nu: R (d(nu) - hat(nu) phi) by pose and velocity.
    const GpKnot knot = gp_knot(t, mean.at(t));
    Eigen::Matrix<double, 3, 12> by_state = Eigen::Matrix<double, 3, 12>::Zero();
    by_state.middleCols<3>(3) = -knot.T_world_body.linear() * so3::hat(knot.varpi.head<3>());
    by_state.middleCols<3>(6) = knot.T_world_body.linear();
    const Eigen::Matrix3d velocity = by_state * P.topLeftCorner<12, 12>() * by_state.transpose();
    const Eigen::Matrix3d found_velocity = found.block<3, 3>(6, 6);
    EXPECT_LT((found_velocity - velocity).norm(), 1e-9 * velocity.norm());
    EXPECT_EQ(mean.conditional_covariance(t, Derivative::pose).rows(), 6);
  }
  EXPECT_EQ(mean.conditional_covariance(mean.begin(), Derivative::velocity).norm(), 0);
  EXPECT_EQ(mean.conditional_covariance(mean.end(), Derivative::velocity).norm(), 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// The block test: truth drawn from the very prior that the estimate is made with, walls known exactly, noise as said. A
// deliberate inverse crime: it asks whether solver and covariances are consistent, not whether the prior fits any
// motion.

/// A wall n . p = d in the world.
struct Wall {
  Eigen::Vector3d n;
  double d;
};
const std::array<Wall, 6> kWalls = {{{Eigen::Vector3d(1, 0, 0), 10},
                                     {Eigen::Vector3d(-1, 0.2, 0).normalized(), 8},
                                     {Eigen::Vector3d(0, 1, 0.1).normalized(), 6},
                                     {Eigen::Vector3d(0.1, -1, 0).normalized(), 7},
                                     {Eigen::Vector3d(0, 0, 1), 4},
                                     {Eigen::Vector3d(0, 0.1, -1).normalized(), 2}}};

/// One point seen on a wall.
struct Seen {
  Time t;
  std::size_t wall;
  Eigen::Vector3d p_body;
};

constexpr double kSpacing_s = 0.1, kSigma_m = 0.05;
constexpr int kIntervals = 8, kStamps = 10, kPoints = 3;  // stamps in an interval, points at a stamp

struct Drive {
  GpKnot start_mean;
  Eigen::MatrixXd P0;
  std::vector<GpKnot> truth;  ///< at every stamp and knot, ascending
  std::vector<Seen> seen;
};

Drive drive(const GpPrior& prior, std::uint64_t seed) {
  Normals normals(seed, "test/gp_block");
  Drive out;
  out.start_mean.varpi << 0.5, 0.2, -0.1, 0.1, -0.2, 0.4;
  const int size = prior.size();
  Eigen::VectorXd sigma0(size);
  sigma0.head<6>().setConstant(0.05);
  sigma0.segment<6>(6).setConstant(0.2);
  if (size > 12) sigma0.tail<6>().setConstant(0.5);
  out.P0 = sigma0.cwiseAbs2().asDiagonal();
  GpKnot knot = tests::perturbed(out.start_mean, sigma0.cwiseProduct(normals.vector(size)));
  std::vector<double> after;
  for (int k = 1; k <= kStamps; ++k) after.push_back(kSpacing_s * k / kStamps);
  const tests::GpDraw draw(prior, after);
  out.truth = {knot};
  for (int i = 0; i < kIntervals; ++i) {
    const std::vector<GpKnot> states = draw(knot, normals);
    out.truth.insert(out.truth.end(), states.begin(), states.end());
    EXPECT_LT(se3::log(knot.T_world_body.inverse() * states.back().T_world_body).norm(), 0.2) << "seed " << seed;
    knot = states.back();
  }
  for (const GpKnot& state : out.truth) {
    for (int k = 0; k < kPoints; ++k) {
      const auto wall = static_cast<std::size_t>(6 * normals.uniform());
      const Wall& w = kWalls[wall];
      // Anywhere on the wall, off it by the noise.
      Eigen::Vector3d q = 5 * Eigen::Vector3d(normals(), normals(), normals());
      q += (w.d + kSigma_m * normals() - w.n.dot(q)) * w.n;
      out.seen.push_back({state.t, wall, state.T_world_body.inverse() * q});
    }
  }
  return out;
}

/// r = (n . T p - d)/sigma; by T <- T Exp(rho, phi): n^T R (rho - hat(p) phi).
tests::Factor factor_of(const GpTrajectory& trajectory, const Seen& seen) {
  StateJet jet;
  trajectory.jet(seen.t, Derivative::pose, jet);
  const Wall& w = kWalls[seen.wall];
  const Eigen::RowVector3d n_body = w.n.transpose() * jet.state.T_world_body.linear();
  Row6 by_pose;
  by_pose << n_body, -n_body * so3::hat(seen.p_body);
  return {jet.first, Eigen::VectorXd::Constant(1, (w.n.dot(jet.state.T_world_body * seen.p_body) - w.d) / kSigma_m),
          by_pose * jet.J.topRows<6>() / kSigma_m};
}

struct Solved {
  GpTrajectory trajectory;
  Eigen::MatrixXd P;
};

Solved solve(const GpPrior& prior, const Drive& d) {
  GpTrajectory trajectory(prior, {d.start_mean});
  const Eigen::VectorXd start = trajectory.value(0);
  std::vector<Time> knots;
  for (int i = 1; i <= kIntervals; ++i) knots.push_back(d.start_mean.t + duration_from_s(kSpacing_s * i));
  trajectory.extend(trajectory.begin(), knots.back(), knots);
  tests::Batch batch;
  for (int iteration = 0; iteration < 10; ++iteration) {
    tests::Factors factors = tests::prior_factors(trajectory);
    factors.push_back(tests::start_factor(trajectory, start, d.P0));
    for (const Seen& seen : d.seen) factors.push_back(factor_of(trajectory, seen));
    batch = tests::solve(factors, trajectory.parameters());
    trajectory.retract(batch.step);
    if (batch.step.norm() < 1e-9) break;
  }
  EXPECT_LT(batch.step.norm(), 1e-9) << "no convergence";
  return {std::move(trajectory), std::move(batch.covariance)};
}

/// Share of chi squared with 6 degrees of freedom below x: 1 - exp(-x/2) (1 + x/2 + x^2/8).
double chi6_below(double x) {
  return 1 - std::exp(-x / 2) * (1 + x / 2 + x * x / 8);
}

TEST_P(EveryProcessOnSE3, EllipsoidsCoverATruthDrawnFromThePrior) {
  GpPrior prior = this->prior();
  // Noise that makes a motion of its own within 0.8 s but keeps |xi| below 0.2 from knot to knot.
  prior.qc = prior.model == GpModel::wnoa   ? Vector6::Constant(0.05)
             : prior.model == GpModel::wnoj ? Vector6::Constant(0.5)
                                            : Vector6(0.5 * (1 + prior.rate.array().square() / 4));
  int inside = 0, all = 0;
  double nees_knots = 0, nees_between = 0;
  int knots = 0, between = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Drive d = drive(prior, seed);
    const Solved solved = solve(prior, d);
    const int size = prior.size();
    for (std::size_t i = 0; i < d.truth.size(); ++i) {
      const Time t = d.truth[i].t;
      const int block = std::min(solved.trajectory.first_block_at(t), solved.trajectory.blocks() - 2);
      const GpCovariance P =
          solved.trajectory.covariance(t, solved.P.block(block * size, block * size, 2 * size, 2 * size));
      EXPECT_FALSE(P.projected);
      const Vector6 e = se3::log(solved.trajectory.pose(t).inverse() * d.truth[i].T_world_body);
      const double nees = e.dot(P.P.topLeftCorner<6, 6>().llt().solve(e));
      inside += chi6_below(nees) < 0.95;
      ++all;
      const bool at_knot = i % kStamps == 0;
      (at_knot ? nees_knots : nees_between) += nees / 6;
      ++(at_knot ? knots : between);
    }
  }
  const double coverage = inside / static_cast<double>(all);
  RecordProperty("coverage", std::to_string(coverage));
  std::printf("coverage %.3f, NEES/6 at knots %.3f, between %.3f\n", coverage, nees_knots / knots,
              nees_between / between);
  EXPECT_GE(coverage, 0.90);
  EXPECT_LE(coverage, 0.99);
}

}  // namespace
}  // namespace tarmac::core
