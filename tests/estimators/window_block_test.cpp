// The block test by the window that estimators use: truth drawn from the very prior that it is made with, walls known
// exactly, noise as said, states leaving as it slides. A deliberate inverse crime: it asks whether solver, marginal
// prior and covariance are consistent, not whether the prior fits any motion.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "estimators/window/state_jacobian.h"
#include "estimators/window/window.h"
#include "tests/core/gp_batch.h"

namespace tarmac::estimators {
namespace {

using core::Time;
using Eigen::Vector3d;

constexpr double kSpacing_s = 0.1, kSigma_m = 0.05;
constexpr int kIntervals = 8, kStamps = 10, kPoints = 3;  // stamps in an interval, points at a stamp

core::GpPrior prior_of(core::GpModel model) {
  core::GpPrior prior;
  prior.model = model;
  // Noise that makes a motion of its own within 0.8 s but keeps |xi| below 0.2 from knot to knot.
  const double density[] = {0.05, 0.5, 13};
  prior.qc.setConstant(density[static_cast<int>(model)]);
  if (model == core::GpModel::singer) prior.rate.setConstant(10);
  return prior;
}

/// Points anywhere on walls n . p = d, off them by noise, as seen from the states.
LidarFactors seen_from(const std::vector<core::GpKnot>& states, tests::Normals& normals) {
  const std::array<std::pair<Vector3d, double>, 6> walls = {{{Vector3d(1, 0, 0), 10},
                                                             {Vector3d(-1, 0.2, 0).normalized(), 8},
                                                             {Vector3d(0, 1, 0.1).normalized(), 6},
                                                             {Vector3d(0.1, -1, 0).normalized(), 7},
                                                             {Vector3d(0, 0, 1), 4},
                                                             {Vector3d(0, 0.1, -1).normalized(), 2}}};
  LidarFactors factors;
  for (const core::GpKnot& state : states) {
    factors.stamps.push_back(state.t);
    for (int k = 0; k < kPoints; ++k) {
      const auto& [n, d] = walls[static_cast<std::size_t>(6 * normals.uniform())];
      Vector3d q = 5 * Vector3d(normals(), normals(), normals());
      q += (d - n.dot(q)) * n;
      LidarFactor& f = factors.factors.emplace_back();
      f.n_map = n;
      f.q_map = q;
      f.p_body = state.T_world_body.inverse() * (q + kSigma_m * normals() * n);
    }
    factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
  }
  return factors;
}

struct Counts {
  int inside = 0, all = 0;
};

/// Each interval's poses as they are when it is the newest.
void slide(core::GpModel model, std::uint64_t seed, Counts& counts) {
  const core::GpPrior prior = prior_of(model);
  tests::Normals normals(seed, "test/window_block");
  core::Kinematics mean;
  mean.v_world << 0.5, 0.2, -0.1;
  mean.omega_body << 0.1, -0.2, 0.4;
  core::StateVector sigma = core::StateVector::Zero();
  sigma.head<6>().setConstant(0.05);
  sigma.segment<6>(core::state_row::velocity).setConstant(0.2);
  if (prior.order() == 3) sigma.tail<6>().setConstant(0.5);
  const Time begin = core::time_from_ns(1'700'000'000'000'000'000);
  WindowModel window_model;
  window_model.lidar_sigma_m = kSigma_m;
  WindowState state;
  state.trajectory = std::make_unique<core::GpTrajectory>(prior, std::vector{core::gp_knot(begin, mean)});
  Window window(window_model, std::move(state));
  window.add_anchor(begin, mean, sigma);
  core::GpKnot truth =
      core::gp_knot(begin, moved(mean, sigma.cwiseProduct(core::StateVector(normals.vector(core::state_row::count)))));
  std::vector<double> after;
  for (int k = 1; k <= kStamps; ++k) after.push_back(kSpacing_s * k / kStamps);
  const tests::GpDraw draw(prior, after);
  for (int i = 0; i < kIntervals; ++i) {
    const std::vector<core::GpKnot> states = draw(truth, normals);
    truth = states.back();
    window.trajectory().extend(window.trajectory().end(), truth.t, {});
    window.set_lidar(i, seen_from(states, normals));
    ASSERT_TRUE(window.solve({.max_iterations = 10}).ok);
    for (const core::GpKnot& at : states) {
      const core::Vector6 e = core::se3::log(window.trajectory().pose(at.t).inverse() * at.T_world_body);
      const core::Matrix6 P = window.covariance(at.t, core::Derivative::pose);
      counts.inside += e.dot(P.llt().solve(e)) < 12.592;  // 95 % of chi-squared with 6 degrees of freedom
      ++counts.all;
    }
    if (i >= 1) window.marginalise_before(begin + i * core::duration_from_s(kSpacing_s), Marginalisation::plain);
  }
  EXPECT_LE(window.trajectory().blocks(), 3);
}

class WindowBlock : public testing::TestWithParam<core::GpModel> {};

TEST_P(WindowBlock, EllipsoidsCoverATruthDrawnFromThePrior) {
  Counts counts;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) slide(GetParam(), seed, counts);
  const double coverage = counts.inside / static_cast<double>(counts.all);
  std::printf("coverage %.3f of %d poses\n", coverage, counts.all);
  EXPECT_GE(coverage, 0.90);
  EXPECT_LE(coverage, 0.99);
}

INSTANTIATE_TEST_SUITE_P(Processes, WindowBlock,
                         testing::Values(core::GpModel::wnoa, core::GpModel::wnoj, core::GpModel::singer));

}  // namespace
}  // namespace tarmac::estimators
