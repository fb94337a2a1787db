// Windows over a chain whose states are linear in its parameters: every answer has a dense twin.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>

#include "core/random.h"
#include "estimators/window/window.h"
#include "tests/estimators/hermite_chain.h"

namespace tarmac::estimators {
namespace {

using core::Duration;
using core::Time;
using core::Vector6;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr Duration kSpacing = std::chrono::milliseconds(100);
const Time kBegin = core::time_from_ns(1'700'000'000'000'000'000);

/// Planes of three directions seen from points of the body: linear in the position, as nothing turns.
LidarFactors planes(std::uint64_t seed, Time begin, Duration length, int stamps) {
  const core::RandomStream stream(seed, "test/planes");
  LidarFactors factors;
  std::uint64_t draw = 0;
  for (int i = 0; i < stamps; ++i) {
    factors.stamps.push_back(begin + length * i / stamps);
    const double t_s = core::to_s(factors.stamps.back() - kBegin);
    for (int k = 0; k < 4; ++k) {
      LidarFactor f;
      f.n_map = Vector3d(stream.normal(draw, 0), stream.normal(draw, 1), stream.normal(draw, 2)).normalized();
      f.p_body = 5 * Vector3d(stream.normal(draw, 3), stream.normal(draw, 4), stream.normal(draw, 5));
      f.q_map = f.p_body + Vector3d(2 * t_s, std::sin(t_s), 0) + 0.05 * stream.normal(draw, 6) * f.n_map;
      f.weight = 0.5 + stream.uniform(draw, 7);
      factors.factors.push_back(f);
      ++draw;
    }
    factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
  }
  return factors;
}

WindowState chain_state(int knots) {
  WindowState state;
  state.trajectory = std::make_unique<HermiteChain>(kBegin, kSpacing, knots, 2.0);
  return state;
}

/// A sensor that does not turn: its gyro reads the bias and noise, its accelerometer the chain's acceleration.
WindowModel model_with_imu() {
  WindowModel model;
  model.gyro_sigma_rad_s = 0.01;
  model.accel_sigma_m_s2 = 0.1;
  model.gyro_walk_rad_s2_rthz = 1e-3;
  model.accel_walk_m_s3_rthz = 1e-2;
  return model;
}

void add_readings(Window& window, Time begin, Time end) {
  const core::RandomStream stream(1, "test/readings");
  for (Time t = kBegin + Duration(2'345'678); t < end; t += std::chrono::milliseconds(10)) {
    if (t < begin) continue;
    const auto i = static_cast<std::uint64_t>((t - kBegin).count() / 1'000'000);
    const double t_s = core::to_s(t - kBegin);
    const Vector3d noise(stream.normal(i, 0), stream.normal(i, 1), stream.normal(i, 2));
    window.add(ImuReading{t, 0.01 * noise + Vector3d(0.02, 0.01, -0.03),
                          Vector3d(0, -std::sin(t_s), 9.80665) + Vector3d(0.1, -0.2, 0.05) + 0.1 * noise});
  }
}

core::StateVector start_sigma() {
  core::StateVector sigma = core::StateVector::Zero();
  sigma.segment<3>(core::state_row::pose).setConstant(0.1);
  sigma.segment<3>(core::state_row::velocity).setConstant(1.0);
  return sigma;
}

constexpr int kLinearSweeps = 12;

/// Everything that is ever known, sweep after sweep; whoever slides marginalises in between.
void grow(Window& window, int sweep) {
  const Time begin = kBegin + sweep * kSpacing, end = begin + kSpacing;
  window.trajectory().extend(begin, end, {});
  if (sweep == 0) {
    window.add_bias_knot(kBegin);
    window.add_bias_anchor(0, Vector6::Zero(), Vector6::Constant(0.3));
    window.add_anchor(kBegin, {}, start_sigma());
  } else if (sweep % 3 == 0) {
    window.add_bias_knot(begin);
  }
  add_readings(window, begin, end);
  window.set_lidar(sweep, planes(static_cast<std::uint64_t>(sweep) + 1, begin, kSpacing, 16));
}

const SolveSettings kOneStep{.max_iterations = 1};

TEST(LinearWindow, OneStepIsTheDenseLeastSquaresSolution) {
  Window window(model_with_imu(), chain_state(2));
  for (int sweep = 0; sweep < 6; ++sweep) grow(window, sweep);
  const BandedSystem system = window.normal_equations();
  const VectorXd expected = -system.dense().ldlt().solve(system.g());
  const WindowState before = window.state();
  const double cost = window.cost();
  const SolveReport report = window.solve(kOneStep);
  ASSERT_TRUE(report.ok);
  EXPECT_EQ(report.initial_cost, cost);
  EXPECT_EQ(report.uncovered, 0);
  for (int block = 0; block < window.trajectory().blocks(); ++block) {
    const VectorXd moved = window.trajectory().value(block) - before.trajectory->value(block);
    EXPECT_LT((moved - expected.segment<6>(6 * block)).norm(), 1e-9) << block;
  }
  // The gradient is that of the cost: a quadratic's fall is half the predicted first-order one.
  EXPECT_NEAR(report.final_cost - cost, system.g().dot(expected) / 2, 1e-8 * cost);
  EXPECT_LT(window.normal_equations().g().norm(), 1e-8 * system.g().norm());
}

TEST(LinearWindow, SlidingIsTheBatch) {
  Window batch(model_with_imu(), chain_state(2)), sliding(model_with_imu(), chain_state(2));
  for (int sweep = 0; sweep < kLinearSweeps; ++sweep) {
    grow(batch, sweep);
    grow(sliding, sweep);
    ASSERT_TRUE(sliding.solve(kOneStep).ok);
    if (sweep >= 4) sliding.marginalise_before(kBegin + (sweep - 3) * kSpacing, Marginalisation::plain);
  }
  ASSERT_TRUE(sliding.solve(kOneStep).ok);
  ASSERT_TRUE(batch.solve(kOneStep).ok);
  ASSERT_LT(sliding.trajectory().blocks(), 7);
  ASSERT_LT(sliding.state().biases.size(), batch.state().biases.size());
  EXPECT_EQ(sliding.trajectory().end(), batch.trajectory().end());

  const Time end = batch.trajectory().end();
  for (const Duration back : {Duration(0), kSpacing / 3, 3 * kSpacing}) {
    const Time t = end - back;
    const MatrixXd P = batch.covariance(t, core::Derivative::velocity);
    const MatrixXd P_sliding = sliding.covariance(t, core::Derivative::velocity);
    const core::Kinematics a = batch.trajectory().at(t), b = sliding.trajectory().at(t);
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma_p = std::sqrt(P(axis, axis)), sigma_v = std::sqrt(P(6 + axis, 6 + axis));
      EXPECT_LT(std::abs((a.T_world_body.translation() - b.T_world_body.translation())[axis]), 1e-7 * sigma_p);
      EXPECT_LT(std::abs((a.v_world - b.v_world)[axis]), 1e-7 * sigma_v);
    }
    EXPECT_LT((P - P_sliding).norm(), 1e-9 * P.norm());
  }
  const MatrixXd B = batch.border_covariance().bottomRightCorner(6, 6);
  EXPECT_LT((B - sliding.border_covariance().bottomRightCorner(6, 6)).norm(), 1e-9 * B.norm());
  const Vector6 bias_error = batch.state().biases.back().gyro_accel - sliding.state().biases.back().gyro_accel;
  EXPECT_LT(bias_error.cwiseQuotient(B.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(LinearWindow, WithoutTheMarginalPriorSlidingIsNotTheBatch) {
  Window plain(model_with_imu(), chain_state(2)), fixed(model_with_imu(), chain_state(2));
  for (Window* window : {&plain, &fixed}) {
    for (int sweep = 0; sweep < kLinearSweeps; ++sweep) {
      grow(*window, sweep);
      ASSERT_TRUE(window->solve(kOneStep).ok);
      if (sweep >= 4)
        window->marginalise_before(kBegin + (sweep - 3) * kSpacing,
                                   window == &plain ? Marginalisation::plain : Marginalisation::fix);
    }
  }
  const Time t = plain.trajectory().begin();
  EXPECT_LT(fixed.covariance(t, core::Derivative::pose)(0, 0), 1e-9) << "held where it is";
  EXPECT_GT(plain.covariance(t, core::Derivative::pose)(0, 0), 1e-6);
}

TEST(LinearWindow, SameBytesAtAnyNumberOfThreads) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Window window(model_with_imu(), chain_state(2));
    for (int sweep = 0; sweep < kLinearSweeps; ++sweep) {
      grow(window, sweep);
      EXPECT_TRUE(window.solve({.levenberg_marquardt = true, .max_iterations = 3}).ok);
      if (sweep >= 6) window.marginalise_before(kBegin + (sweep - 5) * kSpacing, Marginalisation::eigenvalue);
    }
    std::vector<double> values = {window.cost()};
    for (int block = 0; block < window.trajectory().blocks(); ++block)
      for (const double v : window.trajectory().value(block)) values.push_back(v);
    for (const BiasKnot& knot : window.state().biases)
      for (const double v : knot.gyro_accel) values.push_back(v);
    return values;
  };
  const std::vector<double> one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(5));
}

TEST(LinearWindow, RobustLossIgnoresOutliers) {
  const auto error = [](RobustLoss loss) {
    WindowModel model;
    model.lidar_loss = loss;
    Window window(model, chain_state(2));
    window.trajectory().extend(kBegin, kBegin + 3 * kSpacing, {});
    window.add_anchor(kBegin, {}, start_sigma());
    LidarFactors factors = planes(1, kBegin, 3 * kSpacing, 48);
    for (std::size_t i = 0; i < factors.factors.size(); i += 7) factors.factors[i].q_map.x() += 3;
    window.set_lidar(0, std::move(factors));
    EXPECT_TRUE(window.solve({.max_iterations = 30, .relative_decrease = 0, .absolute_decrease = 1e-9}).ok);
    const double t_s = core::to_s(kSpacing);
    return (window.trajectory().pose(kBegin + kSpacing).translation() - Vector3d(2 * t_s, std::sin(t_s), 0)).norm();
  };
  const double squares = error({Loss::standard, 1, 0});
  EXPECT_GT(squares, 0.2);
  EXPECT_LT(error({Loss::cauchy, 1, 0}), 0.05);
  EXPECT_LT(error({Loss::huber, 1, 0}), squares / 2);
}

TEST(LinearWindow, WhatIsSingularIsLeftAlone) {
  WindowState state;
  state.trajectory = std::make_unique<HermiteChain>(kBegin, kSpacing, 4, 0.0);  // no prior of its own
  Window window({}, std::move(state));
  window.set_lidar(0, planes(1, kBegin, kSpacing, 8));  // of the first interval alone
  VectorXd step = VectorXd::Constant(24, 0.25);
  window.trajectory().retract(step);
  for (const bool lm : {false, true}) {
    const SolveReport report = window.solve({.levenberg_marquardt = lm, .max_iterations = 4});
    EXPECT_FALSE(report.ok);
    EXPECT_EQ(report.final_cost, report.initial_cost);
    for (int block = 0; block < 4; ++block) EXPECT_EQ(window.trajectory().value(block), VectorXd::Constant(6, 0.25));
  }
  EXPECT_EQ(window.covariance(kBegin, core::Derivative::pose).size(), 0);
}

TEST(LinearWindow, ReadingsWaitUntilTheTrajectoryCoversThem) {
  Window window(model_with_imu(), chain_state(2));
  window.add_bias_knot(kBegin);
  window.add_bias_anchor(0, Vector6::Zero(), Vector6::Constant(0.3));
  window.add_anchor(kBegin, {}, start_sigma());
  const auto readings = [&] {
    int n = 0;
    const WindowProblem now = window.problem();
    for (const WindowProblem::Item& item : now.items()) n += item.kind == WindowProblem::Item::Kind::reading ? 1 : 0;
    return n;
  };
  add_readings(window, kBegin, kBegin + 3 * kSpacing);
  EXPECT_EQ(readings(), 10) << "100 Hz, and one interval of 0.1 s";
  window.trajectory().extend(kBegin, kBegin + 3 * kSpacing, {});
  EXPECT_EQ(readings(), 30);
  ASSERT_TRUE(window.solve(kOneStep).ok);
  window.marginalise_before(kBegin + 2 * kSpacing, Marginalisation::plain);
  EXPECT_EQ(readings(), 10) << "those before have gone into the prior";
}

TEST(LinearWindow, BordersOfWhichNothingIsKnownStay) {
  WindowModel model = model_with_imu();
  model.accel_sigma_m_s2 = 0;
  model.free_gravity = true;
  Window window(model, chain_state(2));
  for (int sweep = 0; sweep < 2; ++sweep) grow(window, sweep);
  const Vector3d gravity = window.state().gravity_map;
  ASSERT_TRUE(window.solve(kOneStep).ok);
  EXPECT_EQ(window.state().gravity_map, gravity);
  const MatrixXd P = window.border_covariance();
  ASSERT_EQ(P.rows(), 8);
  EXPECT_TRUE(std::isinf(P(window.gravity_column(), window.gravity_column())));
  EXPECT_LT(P(0, 0), 0.01);
}

TEST(LinearWindow, BadInputIsRefused) {
  Window window(model_with_imu(), chain_state(2));
  window.add(ImuReading{.t = kBegin + kSpacing});
  EXPECT_THROW(window.add(ImuReading{.t = kBegin}), std::invalid_argument);
  EXPECT_THROW(window.add_anchor(kBegin - kSpacing, {}, start_sigma()), core::OutOfSpan);
  EXPECT_THROW(window.add_bias_anchor(0, Vector6::Zero(), Vector6::Ones()), std::invalid_argument);
  window.add_bias_knot(kBegin + kSpacing);
  EXPECT_THROW(window.add_bias_knot(kBegin), std::invalid_argument);
  window.add_bias_knot(kBegin + kSpacing);
  EXPECT_EQ(window.state().biases.size(), 1U);
  EXPECT_THROW(window.set_lidar(0, LidarFactors{false, {kBegin}, {0}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace tarmac::estimators
