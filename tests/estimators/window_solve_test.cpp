// Windows over splines and Gaussian processes: what they recover, and that Ceres finds the same.
#include <gtest/gtest.h>

#include "core/sweepwise_trajectory.h"
#include "estimators/window/ceres_window.h"
#include "estimators/window/state_jacobian.h"
#include "estimators/window/velocity_increment.h"
#include "tests/estimators/lively_window.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::Duration;
using core::Time;
using core::Vector6;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Vector6 kBias = (Vector6() << 0.02, -0.01, 0.015, 0.1, -0.2, 0.15).finished();
constexpr double kGravity_m_s2 = 9.80665;
constexpr double kOffset_s = 0.004'000'003;

WindowModel imu_model() {
  WindowModel model;
  model.T_body_imu = lively_mounting();
  model.gyro_sigma_rad_s = 0.01;
  model.accel_sigma_m_s2 = 0.05;
  model.free_gravity = model.free_imu_offset = true;
  return model;
}

void add_ideal_readings(Window& window, const core::ParametricTrajectory& truth, const Vector3d& gravity_map,
                        Time begin, Time end, Duration period) {
  for (Time t = begin; t < end; t += period) {
    if (!truth.covers(t - core::duration_from_s(kOffset_s))) continue;
    window.add(ideal_reading(truth, t, kOffset_s, window.model().T_body_imu, kGravity_m_s2 * gravity_map, kBias));
  }
}

void disturb(core::ParametricTrajectory& trajectory, double size, std::uint64_t seed) {
  const core::RandomStream stream(seed, "test/disturb");
  VectorXd step(trajectory.parameters());
  for (int i = 0; i < step.size(); ++i) step[i] = size * stream.normal(static_cast<std::uint64_t>(i));
  trajectory.retract(step);
}

core::StateVector pose_sigma(double sigma) {
  core::StateVector all = core::StateVector::Zero();
  all.head<6>().setConstant(sigma);
  return all;
}

class ImuAlone : public testing::TestWithParam<Lively> {};

TEST_P(ImuAlone, TellsBiasesGravityAndOffsetWhereSomePosesAreKnown) {
  const auto truth = lively(GetParam(), 26, 1);
  const Vector3d gravity = Vector3d(0.05, -0.08, -1).normalized();
  WindowState state;
  state.trajectory = truth->clone();
  state.biases = {{kLivelyBegin, Vector6::Zero()}};
  Window window(imu_model(), std::move(state));
  // A reading that the trajectory covers only until the offset is known.
  ImuReading early = ideal_reading(*truth, kLivelyBegin + Duration(4'100'000), kOffset_s, window.model().T_body_imu,
                                   kGravity_m_s2 * gravity, kBias);
  early.t = kLivelyBegin + Duration(1'000'000);
  window.add(early);
  add_ideal_readings(window, *truth, gravity, kLivelyBegin, truth->end(), Duration(5'000'000));
  for (int i = 0; i <= 4; ++i) {
    const Time t = kLivelyBegin + (truth->end() - kLivelyBegin) * i / 4;
    window.add_anchor(t, truth->at(t), pose_sigma(1e-3));
  }
  disturb(window.trajectory(), 0.02, 1);
  const SolveReport report = window.solve(
      {.levenberg_marquardt = true, .max_iterations = 60, .relative_decrease = 0, .absolute_decrease = 1e-14});
  ASSERT_TRUE(report.ok);
  EXPECT_LT(report.final_cost, 1e-6) << "from " << report.initial_cost;
  EXPECT_LT((window.state().biases[0].gyro_accel - kBias).norm(), 1e-6);
  EXPECT_LT((window.state().gravity_map - gravity).norm(), 1e-6);
  EXPECT_NEAR(window.state().imu_offset_s, kOffset_s, 1e-8);
  const Time middle = kLivelyBegin + (truth->end() - kLivelyBegin) / 3;
  EXPECT_LT(tests::pose_difference(window.trajectory().pose(middle), truth->pose(middle)), 1e-5);
  EXPECT_EQ(report.left_out, 1);
  EXPECT_LT(std::sqrt(window.border_covariance()(window.offset_column(), window.offset_column())), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Splines, ImuAlone, testing::Values(Lively::spline_split, Lively::spline_se3));

TEST(VelocityIncrements, AreThoseOfTheMotionToSecondOrderAndNotWithoutTheTransportTerm) {
  const auto truth = lively(Lively::spline_se3, 12, 1);
  const Vector3d gravity = Vector3d(0.05, -0.08, -1).normalized();
  const auto error_m_s = [&](Duration period, bool omit_transport) {
    WindowState state;
    state.trajectory = truth->clone();
    state.biases = {{kLivelyBegin, kBias}};
    state.gravity_map = gravity;
    state.imu_offset_s = kOffset_s;
    WindowModel model = imu_model();
    model.gyro_sigma_rad_s = 0;
    model.accel_as_increments = true;
    model.omit_transport = omit_transport;
    Window window(model, std::move(state));
    // Samples in the middles of the parts they stand for.
    add_ideal_readings(window, *truth, gravity, kLivelyBegin + Duration(4'000'003) + period / 2,
                       truth->end() + Duration(4'000'003), period);
    double sum = 0;
    int increments = 0;
    const WindowProblem problem = window.problem();
    for (const WindowProblem::Item& item : problem.items()) {
      std::vector<Term> terms;
      problem.terms(window.state(), item, false, terms);
      for (const Term& term : terms) {
        ++increments;
        sum += term.e.squaredNorm() * 0.05 * 0.05 * core::to_s(period) * 0.1;  // sigma^2 = s^2 dt (t2 - t1)
      }
    }
    EXPECT_GE(increments, 6);
    return std::sqrt(sum / increments);
  };
  const double coarse = error_m_s(Duration(10'000'000), false), fine = error_m_s(Duration(5'000'000), false);
  EXPECT_LT(coarse, 5e-3) << "of increments of about 1 m/s";
  EXPECT_GT(coarse / fine, 3.5);
  // omega x v of about 1 rad/s and 1 m/s over 0.1 s.
  EXPECT_GT(error_m_s(Duration(5'000'000), true), 0.02);
}

TEST(VelocityIncrements, ShareTimeAmongReadingsAndRefuseGaps) {
  const Time t0 = kLivelyBegin;
  std::vector<ImuReading> readings;
  for (const int ms : {-3, 4, 10, 18, 27, 33}) readings.push_back({.t = t0 + std::chrono::milliseconds(ms)});
  const Time end = t0 + std::chrono::milliseconds(30);
  for (const double offset_s : {0.0, 0.001, -0.0015}) {
    const auto samples = increment_samples(readings, offset_s, t0, end, std::chrono::milliseconds(5));
    ASSERT_GE(samples.size(), 5U);
    double sum = 0, by_offset = 0;
    for (const IncrementSample& sample : samples) {
      sum += sample.dt_s;
      by_offset += sample.dt_by_offset;
      EXPECT_GE(sample.at, t0);
      EXPECT_LE(sample.at, end);
    }
    EXPECT_NEAR(sum, 0.03, 1e-12) << "the whole stretch, whatever the offset";
    EXPECT_EQ(by_offset, 0);
  }
  EXPECT_TRUE(increment_samples(readings, 0, t0, end, std::chrono::milliseconds(4)).empty()) << "9 ms apart";
  EXPECT_TRUE(
      increment_samples(readings, 0, t0, t0 + std::chrono::milliseconds(60), std::chrono::milliseconds(5)).empty())
      << "no reading has come yet";
  EXPECT_TRUE(increment_samples({}, 0, t0, end, std::chrono::milliseconds(5)).empty());
}

/// LiDAR and IMU, a noisy one, of the first `intervals` tenths of a second.
Window noisy_window(Lively kind, int knots, bool free_offset) {
  const auto truth = lively(kind, knots, 1);
  WindowModel model = imu_model();
  model.free_imu_offset = free_offset;
  model.gyro_walk_rad_s2_rthz = 1e-3;
  model.accel_walk_m_s3_rthz = 1e-2;
  model.gravity_sigma_rad = 0.1;
  model.imu_offset_sigma_s = 0.01;
  model.lidar_sigma_m = 0.02;
  WindowState state;
  state.trajectory = truth->clone();
  state.biases = {{kLivelyBegin, Vector6::Zero()}, {kLivelyBegin + std::chrono::milliseconds(400), Vector6::Zero()}};
  if (!free_offset) state.imu_offset_s = kOffset_s;
  Window window(model, std::move(state));
  add_ideal_readings(window, *truth, Vector3d(0.05, -0.08, -1).normalized(), kLivelyBegin, truth->end(),
                     Duration(5'000'000));
  window.set_lidar(0, lively_factors(*truth, kLivelyBegin, truth->end(), 60, 4, 0.02, false, 1));
  window.add_anchor(kLivelyBegin, truth->at(kLivelyBegin), pose_sigma(0.01));
  window.add_bias_anchor(0, Vector6::Zero(), Vector6::Constant(0.5));
  disturb(window.trajectory(), 0.01, 2);
  return window;
}

double distance(const Window& a, const Window& b) {
  double most = 0;
  for (int block = 0; block < a.trajectory().blocks(); ++block) {
    VectorXd d;
    MatrixXd J;
    a.trajectory().difference(block, b.trajectory().value(block), d, J);
    most = std::max(most, d.cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < a.state().biases.size(); ++k)
    most = std::max(most, (a.state().biases[k].gyro_accel - b.state().biases[k].gyro_accel).cwiseAbs().maxCoeff());
  most = std::max(most, (a.state().gravity_map - b.state().gravity_map).norm());
  return std::max(most, std::abs(a.state().imu_offset_s - b.state().imu_offset_s));
}

const SolveSettings kToTheEnd{
    .levenberg_marquardt = true, .max_iterations = 60, .relative_decrease = 0, .absolute_decrease = 1e-15};

class WithCeres : public testing::TestWithParam<Lively> {};

TEST_P(WithCeres, OneStepOfTheSameDampingIsTheSame) {
  const double lambda = 30;
  Window ours = noisy_window(GetParam(), 12, true), theirs = noisy_window(GetParam(), 12, true);
  VectorXd step;
  ASSERT_TRUE(ours.normal_equations().solve_with_identity(lambda, step));
  retract(ours.state(), ours.problem().layout(), step);
  const double start = theirs.cost();
  const SolveReport report =
      solve_with_ceres(theirs, {.max_iterations = 1, .initial_lambda = lambda}, CeresDamping::identity);
  ASSERT_TRUE(report.ok);
  EXPECT_NEAR(report.initial_cost, start, 1e-9 * start);
  ASSERT_LT(report.final_cost, start) << "the step was taken";
  EXPECT_NEAR(report.final_cost, ours.cost(), 1e-9 * start);
  EXPECT_LT(distance(ours, theirs), 1e-9 * step.cwiseAbs().maxCoeff());
}

TEST_P(WithCeres, BothComeToTheSameMinimum) {
  for (const Loss loss : {Loss::standard, Loss::cauchy}) {
    Window ours = noisy_window(GetParam(), 9, true), theirs = noisy_window(GetParam(), 9, true);
    for (Window* window : {&ours, &theirs}) {
      window->model().lidar_loss = window->model().accel_loss = {loss, 2, 0};
      ASSERT_TRUE(window->solve(kToTheEnd).ok);
      // A prior of what has left, so that it is part of the comparison; then away from the minimum.
      window->marginalise_before(kLivelyBegin + std::chrono::milliseconds(210), Marginalisation::plain);
      disturb(window->trajectory(), 0.01, 3);
    }
    ASSERT_TRUE(ours.solve(kToTheEnd).ok);
    const SolveReport report = solve_with_ceres(theirs, {.max_iterations = 200, .relative_decrease = 1e-16});
    ASSERT_TRUE(report.ok);
    EXPECT_NEAR(report.final_cost, theirs.cost(), 1e-9 * theirs.cost());
    EXPECT_NEAR(ours.cost(), theirs.cost(), 1e-9 * theirs.cost());
    EXPECT_LT(distance(ours, theirs), 1e-7);
  }
}

TEST_P(WithCeres, SlidingStaysWithinASmallPartOfASigmaOfTheBatch) {
  Window batch = noisy_window(GetParam(), 14, false), sliding = noisy_window(GetParam(), 14, false);
  ASSERT_TRUE(batch.solve(kToTheEnd).ok);
  for (const int ms : {110, 210, 320, 430}) {
    ASSERT_TRUE(sliding.solve({.max_iterations = 3}).ok);
    sliding.marginalise_before(kLivelyBegin + std::chrono::milliseconds(ms), Marginalisation::plain);
  }
  ASSERT_TRUE(sliding.solve(kToTheEnd).ok);
  EXPECT_LT(sliding.trajectory().blocks(), batch.trajectory().blocks());
  const Time t = sliding.trajectory().begin() + std::chrono::milliseconds(150);
  const MatrixXd P = batch.covariance(t, core::Derivative::pose);
  const MatrixXd P_sliding = sliding.covariance(t, core::Derivative::pose);
  EXPECT_LT((P - P_sliding).norm(), 0.01 * P.norm());
  const Vector6 d = core::se3::log(batch.trajectory().pose(t).inverse() * sliding.trajectory().pose(t));
  EXPECT_LT(std::sqrt(d.dot(P.ldlt().solve(d))), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Models, WithCeres,
                         testing::Values(Lively::spline_split, Lively::spline_se3, Lively::spline_split_6,
                                         Lively::gp_wnoa, Lively::gp_wnoj, Lively::gp_singer));

struct Spaced {
  core::GpModel model;
  int spacing_ms;
  /// Of the covariance, in its own standard deviations. Normal equations square the condition of a process whose state
  /// has an acceleration: with closer knots digits are lost.
  double covariance = 1e-9;
};
void PrintTo(const Spaced& s, std::ostream* out) {
  const char* names[] = {"wnoa", "wnoj", "singer"};
  *out << names[static_cast<int>(s.model)] << "_" << s.spacing_ms << "ms";
}

/// LiDAR and IMU on a process with knots so far apart, at the minimum of its cost.
Window solved_window(const Spaced& spaced) {
  const auto motion = lively(Lively::spline_se3, 12, 1);
  core::GpPrior prior;
  prior.model = spaced.model;
  const double density[] = {5, 1000, 1e5};
  prior.qc.setConstant(density[static_cast<int>(spaced.model)]);
  if (spaced.model == core::GpModel::singer) prior.rate.setConstant(10);
  const Duration spacing = std::chrono::milliseconds(spaced.spacing_ms);
  std::vector<core::GpKnot> knots;
  for (Time t = kLivelyBegin; t <= motion->end(); t += spacing) knots.push_back(core::gp_knot(t, motion->at(t)));
  WindowModel model = imu_model();
  model.gyro_walk_rad_s2_rthz = 1e-3;
  model.accel_walk_m_s3_rthz = 1e-2;
  model.gravity_sigma_rad = 0.1;
  model.imu_offset_sigma_s = 0.01;
  if (spaced.model == core::GpModel::wnoa) {  // its acceleration jumps at knots
    model.accel_sigma_m_s2 = 0;
    model.free_gravity = false;
  }
  WindowState state;
  state.trajectory = std::make_unique<core::GpTrajectory>(prior, knots);
  for (const int ms : {0, 300, 600}) state.biases.push_back({kLivelyBegin + std::chrono::milliseconds(ms), kBias});
  state.gravity_map = Vector3d(0.05, -0.08, -1).normalized();
  state.imu_offset_s = kOffset_s;
  Window window(model, std::move(state));
  add_ideal_readings(window, *motion, window.state().gravity_map, kLivelyBegin, knots.back().t, Duration(5'000'000));
  window.set_lidar(0, lively_factors(*motion, kLivelyBegin, knots.back().t, 60, 4, 0.02, false, 1));
  window.add_anchor(kLivelyBegin, motion->at(kLivelyBegin), pose_sigma(0.01));
  window.add_bias_anchor(0, kBias, Vector6::Constant(0.5));
  EXPECT_TRUE(window.solve(kToTheEnd).ok);
  EXPECT_TRUE(window.solve({.max_iterations = 5, .relative_decrease = 0, .absolute_decrease = 0}).ok);
  return window;
}

class AtTheMinimum : public testing::TestWithParam<Spaced> {};

/// Everything is linearised where it was, so that only arithmetic can tell a window from the batch.
TEST_P(AtTheMinimum, WhatIsMarginalisedChangesNeitherMeanNorCovariance) {
  Window window = solved_window(GetParam());
  const Time t = kLivelyBegin + (window.trajectory().end() - kLivelyBegin) * 3 / 4;
  const core::Derivative upto = window.trajectory().has();
  const MatrixXd P = window.covariance(t, upto);
  const MatrixXd B_batch = window.border_covariance();
  const core::Kinematics before = window.trajectory().at(t);
  for (int part = 1; part <= 5; ++part)
    window.marginalise_before(kLivelyBegin + (t - kLivelyBegin) * part / 6, Marginalisation::plain);
  const MatrixXd P_window = window.covariance(t, upto);
  ASSERT_EQ(P_window.rows(), P.rows());
  ASSERT_TRUE(window.solve({.max_iterations = 3}).ok);
  const VectorXd moved = difference(before, window.trajectory().at(t)).head(P.rows());
  // Units differ from row to row: compared in standard deviations.
  const VectorXd sigma = P.diagonal().cwiseSqrt();
  const MatrixXd scale = sigma.cwiseInverse().asDiagonal();
  EXPECT_LT((scale * (P - P_window) * scale).cwiseAbs().maxCoeff(), GetParam().covariance);
  EXPECT_LT(moved.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 1e-7);
  // The last bias, gravity and the offset.
  EXPECT_LT(window.state().biases.size(), 3u);
  const MatrixXd B_window = window.border_covariance();
  const MatrixXd B = B_batch.bottomRightCorner(B_window.rows(), B_window.rows());
  const MatrixXd border_scale = B.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
  EXPECT_LT((border_scale * (B - B_window) * border_scale).cwiseAbs().maxCoeff(), GetParam().covariance);
}

INSTANTIATE_TEST_SUITE_P(Knots, AtTheMinimum,
                         testing::Values(Spaced{core::GpModel::wnoa, 100}, Spaced{core::GpModel::wnoa, 20},
                                         Spaced{core::GpModel::wnoj, 100}, Spaced{core::GpModel::wnoj, 50, 1e-8},
                                         Spaced{core::GpModel::wnoj, 20, 1e-7}, Spaced{core::GpModel::wnoj, 10, 3e-6},
                                         Spaced{core::GpModel::singer, 100}, Spaced{core::GpModel::singer, 50, 1e-8},
                                         Spaced{core::GpModel::singer, 20, 1e-7},
                                         Spaced{core::GpModel::singer, 10, 3e-6}));

TEST(Window, ModelsThatATrajectoryCannotServeAreRefused) {
  const auto refused = [](core::SweepwiseModel kind, const WindowModel& model) {
    auto sweepwise = std::make_unique<core::SweepwiseTrajectory>(kind, core::SE3::Identity());
    sweepwise->extend(kLivelyBegin, kLivelyBegin + std::chrono::milliseconds(100), {});
    WindowState state;
    state.trajectory = std::move(sweepwise);
    try {
      Window(model, std::move(state));
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  WindowModel gyro, accelerometer, smoothness;
  gyro.gyro_sigma_rad_s = 0.01;
  accelerometer.accel_sigma_m_s2 = 0.1;
  smoothness.smoothness_translation = 1;
  EXPECT_TRUE(refused(core::SweepwiseModel::rigid, gyro));
  EXPECT_FALSE(refused(core::SweepwiseModel::two_pose_slerp, gyro));
  EXPECT_TRUE(refused(core::SweepwiseModel::two_pose_slerp, accelerometer));
  EXPECT_TRUE(refused(core::SweepwiseModel::two_pose_slerp, smoothness));
  EXPECT_FALSE(refused(core::SweepwiseModel::rigid, WindowModel()));
}

TEST(Window, NonsenseIsRefused) {
  WindowState state;
  state.trajectory = lively(Lively::gp_wnoa, 4, 1);
  WindowModel model;
  model.smoothness_translation = 1;
  model.smoothness_samples = 7;
  Window window(model, std::move(state));
  EXPECT_THROW(window.solve({}), std::invalid_argument) << "no such quadrature";
  EXPECT_THROW(window.marginalise_before(window.trajectory().end() + Duration(1'000'000'000), Marginalisation::plain),
               std::invalid_argument);
}

/// Which knot an anchor is of does not depend on its place in the list.
TEST(Window, BiasAnchorsLeaveWithTheirKnots) {
  const auto covariance = [](bool swapped) {
    Window window = noisy_window(Lively::spline_split, 14, false);
    for (const int knot : swapped ? std::array{1, 0} : std::array{0, 1})
      window.add_bias_anchor(knot, Vector6::Zero(), Vector6::Constant(knot == 0 ? 0.01 : 0.02));
    EXPECT_TRUE(window.solve(kToTheEnd).ok);
    const MatrixXd before = window.border_covariance().bottomRightCorner(8, 8);
    window.marginalise_before(kLivelyBegin + std::chrono::milliseconds(600), Marginalisation::plain);
    EXPECT_EQ(window.state().biases.size(), 1u);
    EXPECT_LT((window.border_covariance() - before).norm(), 1e-8 * before.norm()) << "nothing lost, nothing twice";
    return before;
  };
  EXPECT_LT((covariance(false) - covariance(true)).norm(), 1e-12);
}

/// Each plane seen from both sides: summed before squaring nothing is left of it, squared each it counts twice.
TEST(Window, SummedResidualsOfAStampCancelWhereNormalsAreOpposite) {
  const auto step = [](bool summed, bool with_lidar) {
    Window window = noisy_window(Lively::gp_wnoa, 6, false);
    LidarFactors factors = *window.lidar(0), mirrored = factors;
    mirrored.factors.clear();
    for (std::uint32_t& first : mirrored.first) first *= 2;
    for (const LidarFactor& factor : factors.factors) {
      LidarFactor back = factor;
      back.n_map = -back.n_map;
      mirrored.factors.push_back(factor);
      mirrored.factors.push_back(back);
    }
    window.model().sum_stamp_residuals = summed;
    window.set_lidar(0, with_lidar ? mirrored : LidarFactors{});
    VectorXd x;
    EXPECT_TRUE(window.normal_equations().solve_with_identity(1, x));
    return x;
  };
  const VectorXd without = step(false, false);
  EXPECT_LT((step(true, true) - without).norm(), 1e-9 * without.norm());
  EXPECT_GT((step(false, true) - without).norm(), 0.1 * without.norm());
  Window window = noisy_window(Lively::gp_wnoa, 6, false);
  window.model().sum_stamp_residuals = true;
  window.model().lidar_loss = {Loss::cauchy, 2, 0};
  EXPECT_THROW(window.solve({}), std::invalid_argument);
}

TEST(Window, StampsThatTheTrajectoryDoesNotCoverAreCounted) {
  Window window = noisy_window(Lively::spline_split, 12, false);
  LidarFactors factors = *window.lidar(0);
  for (Time& t : factors.stamps) t += std::chrono::milliseconds(300);
  window.set_lidar(1, factors);
  const SolveReport report = window.solve({});
  ASSERT_TRUE(report.ok);
  int beyond = 0;
  for (const Time t : factors.stamps) beyond += t > window.trajectory().end() ? 1 : 0;
  EXPECT_GT(beyond, 0);
  EXPECT_EQ(report.uncovered, beyond);
  EXPECT_EQ(window.lidar(7), nullptr);
}

}  // namespace
}  // namespace tarmac::estimators
