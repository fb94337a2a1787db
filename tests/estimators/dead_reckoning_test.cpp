#include "estimators/dead_reckoning/dead_reckoning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::SweepStatus;
using core::Time;
using core::time_from_s;
using Eigen::Vector3d;

constexpr double kGravity = 9.80665;

/// Rest, then a smooth start into constant speed and turn rate: yaw(t) = w0 F(t), distance = v0 F(t) with F the
/// integral of a quintic step from 0 to 1 between 2 s and 3 s. Speed over rate is constant, hence the path is a circle.
struct Turn {
  double v0 = 8, w0 = 0.5;

  static double u(double t) { return std::clamp(t - 2, 0.0, 1.0); }
  static double rate(double t) { return u(t) * u(t) * u(t) * (10 + u(t) * (-15 + 6 * u(t))); }
  static double slope(double t) { return 30 * u(t) * u(t) * (1 - u(t)) * (1 - u(t)); }
  static double integral(double t) {
    const double x = u(t);
    return x * x * x * x * (2.5 + x * (-3 + x)) + std::max(0.0, t - 3);
  }
  SE3 T_world_body(double t) const {
    const double yaw = w0 * integral(t);
    SE3 T = SE3::Identity();
    T.linear() = core::so3::exp({0, 0, yaw});
    T.translation() = v0 / w0 * Vector3d(std::sin(yaw), 1 - std::cos(yaw), 0);
    return T;
  }
  /// Specific force at a point l of the body, in the body's axes.
  Vector3d specific_force(double t, const Vector3d& l) const {
    const Vector3d w(0, 0, w0 * rate(t)), alpha(0, 0, w0 * slope(t));
    return Vector3d(v0 * slope(t), v0 * rate(t) * w.z(), kGravity) + alpha.cross(l) + w.cross(w.cross(l));
  }
};

core::ImuSheet sheet_of(double rate_hz, double group_delay_s = 0) {
  core::ImuSheet sheet;
  sheet.rate_hz = rate_hz;
  sheet.T_body_imu = tests::some_pose(0.9, 1.1);
  sheet.delay = core::duration_from_s(0.5 / rate_hz + group_delay_s);
  return sheet;
}

/// Means over [end - 1 / rate, end] by Gauss-Legendre with 5 nodes, stamped `group_delay_s` after the end.
core::ImuSample mean_sample(const Turn& turn, const core::ImuSheet& sheet, double end_s, double group_delay_s) {
  constexpr double kNode[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
  constexpr double kWeight[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                                0.2369268850561891};
  const double dt = 1 / sheet.rate_hz;
  core::ImuSample sample;
  sample.t = time_from_s(end_s + group_delay_s);
  const Eigen::Matrix3d R_imu_body = sheet.T_body_imu.linear().transpose();
  const double yaw_step = turn.w0 * (Turn::integral(end_s) - Turn::integral(end_s - dt));
  sample.gyro_rad_s = R_imu_body * Vector3d(0, 0, yaw_step / dt);
  for (int k = 0; k < 5; ++k) {
    const double t = end_s + dt * (0.5 * kNode[k] - 0.5);
    sample.accel_m_s2 += 0.5 * kWeight[k] * (R_imu_body * turn.specific_force(t, sheet.T_body_imu.translation()));
  }
  return sample;
}

EstimatorContext context_of(const core::ImuSheet& sheet) {
  EstimatorContext context;
  context.rig.lidars.resize(1);
  context.rig.imus.push_back(sheet);
  context.rig.gravity_m_s2 = kGravity;
  return context;
}

core::LidarSweep empty_sweep(int k) {
  core::LidarSweep sweep;
  sweep.index = k;
  sweep.begin = time_from_s(0.1 * k);
  sweep.end = time_from_s(0.1 * (k + 1));
  return sweep;
}

struct Reckoned {
  std::vector<SweepOutcome> outcomes;
  core::Estimate end;
};

struct RunSetup {
  double rate_hz = 200;
  double group_delay_s = 0;
  double seconds = 10;
  double hole_from_s = 1e9, hole_to_s = 1e9;  ///< samples left out
  core::ImuSample error{};                    ///< added to every sample
};

Reckoned run(const Turn& turn, const EstimatorContext& context, const RunSetup& setup) {
  DeadReckoning estimator({}, context);
  Reckoned result;
  int next = 1;
  for (int k = 0; k < static_cast<int>(10 * setup.seconds); ++k) {
    const core::LidarSweep sweep = empty_sweep(k);
    for (;; ++next) {
      core::ImuSample sample = mean_sample(turn, context.rig.imus[0], next / setup.rate_hz, setup.group_delay_s);
      if (sample.t > sweep.end) break;
      if (next / setup.rate_hz > setup.hole_from_s && next / setup.rate_hz < setup.hole_to_s) continue;
      sample.gyro_rad_s += setup.error.gyro_rad_s;
      sample.accel_m_s2 += setup.error.accel_m_s2;
      estimator.add(sample);
    }
    result.outcomes.push_back(estimator.add(sweep));
  }
  estimator.finish(result.end);
  return result;
}

double end_error_m(const Turn& turn, const Reckoned& result) {
  const core::SweepResult& last = result.outcomes.back().result;
  return (last.T_map_body.translation() - turn.T_world_body(core::to_s(last.reference)).translation()).norm();
}

TEST(Propagate, IsExactForConstantRateAndForce) {
  // A body on a horizontal circle feels constant rate and force; so does it when the step is cut anywhere.
  const double v = 7, w = 0.8;
  InertialState start;
  start.v_map_m_s = {v, 0, 0};
  for (const double dt_s : {0.002, 0.1, 0.3, 2.0}) {
    const Time end = time_from_s(dt_s);
    const InertialState state = propagate(start, {0, 0, w}, {0, v * w, kGravity}, kGravity, end);
    const double yaw = w * dt_s;
    EXPECT_LT((state.p_map_m - v / w * Vector3d(std::sin(yaw), 1 - std::cos(yaw), 0)).norm(), 1e-12) << dt_s;
    EXPECT_LT((state.v_map_m_s - v * Vector3d(std::cos(yaw), std::sin(yaw), 0)).norm(), 1e-12) << dt_s;
    EXPECT_LT((state.R_map_imu - core::so3::exp({0, 0, yaw})).norm(), 1e-12) << dt_s;
    const InertialState back = propagate(state, {0, 0, w}, {0, v * w, kGravity}, kGravity, start.t);
    EXPECT_LT(back.p_map_m.norm(), 1e-12);
  }
}

TEST(Propagate, SecondIntegralIsThePowerSeriesOnBothSidesOfTheSwitch) {
  for (const double a : {0.0, 1e-9, 1e-3, 0.1999999, 0.2000001, 1.0, 3.0}) {
    const Vector3d phi = a * Vector3d(0.48, 0.6, -0.64);
    const Eigen::Matrix3d K = core::so3::hat(phi);
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero(), power = Eigen::Matrix3d::Identity();
    double factorial = 2;
    for (int n = 0; n < 40; ++n) {
      expected += power / factorial;
      power *= K;
      factorial *= n + 3;
    }
    EXPECT_LT((second_integral(phi) - expected).norm(), 1e-14) << a;
  }
}

TEST(DeadReckoning, FollowsAConstantTwistFromIntervalMeansThroughALeverArm) {
  const Turn turn;
  const Reckoned result = run(turn, context_of(sheet_of(200)), {});
  for (const SweepOutcome& outcome : result.outcomes) {
    if (outcome.result.status != SweepStatus::ok) continue;
    for (const double phase : {0.0, 0.37, 1.0}) {
      const Time t = outcome.result.begin + core::duration_from_s(0.1 * phase);
      const SE3 truth = turn.T_world_body(core::to_s(t));
      EXPECT_LT(tests::pose_difference(outcome.motion.at(0).pose(t), truth), 2e-3) << core::to_s(t);
    }
  }
  EXPECT_EQ(result.outcomes[9].result.status, SweepStatus::ok) << "one second at rest is over";
  EXPECT_EQ(result.outcomes[9].result.reference, result.outcomes[9].result.end);
  EXPECT_TRUE(result.end.gravity_aligned);
  EXPECT_EQ(result.end.status, core::RunStatus::ok);
}

TEST(DeadReckoning, ItsErrorFallsFourfoldPerHalvingOfTheStep) {
  const Turn turn{.v0 = 8, .w0 = 1.5};
  const double coarse = end_error_m(turn, run(turn, context_of(sheet_of(50)), {.rate_hz = 50}));
  const double fine = end_error_m(turn, run(turn, context_of(sheet_of(100)), {.rate_hz = 100}));
  EXPECT_GT(coarse, 1e-6) << "no error to judge the order by";
  EXPECT_GT(coarse / fine, 3.5);
}

TEST(DeadReckoning, HonoursTheStampsDelay) {
  const Turn turn;
  const RunSetup late{.group_delay_s = 0.02};
  EXPECT_LT(end_error_m(turn, run(turn, context_of(sheet_of(200, 0.02)), late)), 5e-3);
  // The same samples with a data sheet that does not tell: 20 ms at 8 m/s.
  EXPECT_NEAR(end_error_m(turn, run(turn, context_of(sheet_of(200, 0.0)), late)), 0.16, 0.02);
}

TEST(DeadReckoning, TakesConstantBiasesFromTheRest) {
  const Turn turn;
  core::ImuSample bias;
  bias.gyro_rad_s << 0.01, -0.02, 0.015;
  // Along gravity, where it can be told from attitude.
  bias.accel_m_s2 = 0.1 * (sheet_of(200).T_body_imu.linear().transpose() * Vector3d::UnitZ());
  EXPECT_LT(end_error_m(turn, run(turn, context_of(sheet_of(200)), {.error = bias})), 5e-3);
}

TEST(DeadReckoning, FindsRollAndPitchOfARestToTheNoisesLimit) {
  const double sigma_m_s2 = 0.05, rate_hz = 200;
  const core::ImuSheet sheet = sheet_of(rate_hz);
  Eigen::Matrix3d R_map_body =
      (Eigen::AngleAxisd(0.2, Vector3d::UnitY()) * Eigen::AngleAxisd(-0.1, Vector3d::UnitX())).matrix();
  const core::RandomStream random(5, "test/rest");
  StaticStart start({}, sheet.T_body_imu.linear(), kGravity, rate_hz);
  std::optional<StaticStart::Result> found;
  for (std::uint64_t k = 0; k < 200; ++k) {
    ASSERT_FALSE(found) << "before a whole second, at sample " << k;
    core::ImuSample sample;
    sample.t = time_from_s(static_cast<double>(k) / rate_hz);
    const Vector3d noise(random.normal(k, 0), random.normal(k, 1), random.normal(k, 2));
    sample.accel_m_s2 = sheet.T_body_imu.linear().transpose() * (R_map_body.transpose() * Vector3d(0, 0, kGravity)) +
                        sigma_m_s2 * noise;
    found = start.add(sample);
  }
  ASSERT_TRUE(found);
  const double limit_rad = sigma_m_s2 / (kGravity * std::sqrt(200.0));
  const Eigen::Matrix3d error = found->R_map_imu * (R_map_body * sheet.T_body_imu.linear()).transpose();
  // Roll, pitch and (through the levelled x axis) yaw are each a normal deviate of about that size.
  EXPECT_LT(core::so3::angle_rad(error), 4 * limit_rad);
  EXPECT_GT(core::so3::angle_rad(error), 0);
}

TEST(DeadReckoning, WithoutARestItIsNotInitialisedAndSaysWhy) {
  EstimatorContext context = context_of(sheet_of(200));
  DeadReckoning estimator({}, context);
  for (int k = 1; k < 2000; ++k) {
    core::ImuSample sample;
    sample.t = time_from_s(k / 200.0);
    // A rough road for the first 4 s: then it is too late.
    sample.accel_m_s2 = Vector3d(0, 0, kGravity + (k < 800 ? std::sin(0.3 * k) : 0.0));
    estimator.add(sample);
  }
  EXPECT_EQ(estimator.add(empty_sweep(90)).result.status, SweepStatus::initialising);
  core::Estimate estimate;
  estimator.finish(estimate);
  EXPECT_EQ(estimate.status, core::RunStatus::not_initialised);
  EXPECT_THAT(estimate.message, testing::HasSubstr("no rest in the first 3 s"));
}

TEST(DeadReckoning, ASteadyTurnIsNoRest) {
  DeadReckoning estimator({}, context_of(sheet_of(200)));
  for (int k = 1; k < 800; ++k) {
    core::ImuSample sample;
    sample.t = time_from_s(k / 200.0);
    sample.gyro_rad_s.z() = 0.2;
    sample.accel_m_s2.z() = kGravity;
    estimator.add(sample);
  }
  core::Estimate estimate;
  estimator.finish(estimate);
  EXPECT_EQ(estimate.status, core::RunStatus::not_initialised);
}

TEST(DeadReckoning, ARestThatComesWithinTheFirstThreeSecondsIsFound) {
  DeadReckoning estimator({}, context_of(sheet_of(200)));
  for (int k = 1; k <= 500; ++k) {
    core::ImuSample sample;
    sample.t = time_from_s(k / 200.0);
    sample.accel_m_s2 = Vector3d(0, 0, kGravity + (k <= 280 ? 2 * std::sin(0.9 * k) : 0.0));
    estimator.add(sample);
  }
  EXPECT_EQ(estimator.add(empty_sweep(12)).result.status, SweepStatus::initialising);
  EXPECT_EQ(estimator.add(empty_sweep(20)).result.status, SweepStatus::ok);
}

TEST(DeadReckoning, WithoutCalibrationImuOrRateItSaysWhatIsMissing) {
  const auto message = [](const EstimatorContext& context) {
    DeadReckoning estimator({}, context);
    estimator.add(core::ImuSample{});
    EXPECT_EQ(estimator.add(empty_sweep(0)).result.status, SweepStatus::initialising);
    core::Estimate estimate;
    estimator.finish(estimate);
    EXPECT_EQ(estimate.status, core::RunStatus::not_initialised);
    return estimate.message;
  };
  EstimatorContext context = context_of(sheet_of(200));
  context.rig.calibrated = false;
  EXPECT_THAT(message(context), testing::HasSubstr("no calibration"));
  context = context_of(sheet_of(200));
  context.rig.imus[0].rate_hz = 0;
  EXPECT_THAT(message(context), testing::HasSubstr("rate_hz"));
  context.rig.imus.clear();
  EXPECT_THAT(message(context), testing::HasSubstr("no IMU"));
}

TEST(DeadReckoning, AHoleInTheSamplesIsCrossedAndItsSweepsAreLost) {
  const Turn turn;
  const Reckoned result = run(turn, context_of(sheet_of(200)), {.hole_from_s = 5.02, .hole_to_s = 5.25});
  for (int k = 20; k < 100; ++k) {
    const SweepStatus expected = k >= 50 && k <= 52 ? SweepStatus::lost : SweepStatus::ok;
    EXPECT_EQ(result.outcomes[static_cast<std::size_t>(k)].result.status, expected) << k;
  }
  // Constant twist: the mean of the hole's two sides is what was missed.
  EXPECT_LT(end_error_m(turn, result), 5e-3);
}

TEST(DeadReckoning, OneLostSampleIsNoHole) {
  const Turn turn;
  const Reckoned result = run(turn, context_of(sheet_of(200)), {.hole_from_s = 5.0201, .hole_to_s = 5.0299});
  for (const SweepOutcome& outcome : result.outcomes) EXPECT_NE(outcome.result.status, SweepStatus::lost);
}

}  // namespace
}  // namespace tarmac::estimators
