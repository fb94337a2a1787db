#include "estimators/kiss_icp_imu/kiss_icp_imu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "estimators/kiss_icp/kiss_icp.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::SweepStatus;
using core::Time;
using core::time_from_s;
using Eigen::Vector3d;

constexpr double kGravity = 9.80665, kRate = 200;

/// A level drive along a path of constant curvature; T_world_body by the distance travelled.
struct Drive {
  std::function<double(double)> distance_m;
  double curvature_per_m = 0.04;

  SE3 T_world_body(double t) const {
    const double s = distance_m(t), yaw = curvature_per_m * s;
    SE3 T = SE3::Identity();
    T.linear() = core::so3::exp({0, 0, yaw});
    T.translation() = Vector3d(std::sin(yaw), 1 - std::cos(yaw), 0) / curvature_per_m;
    return T;
  }
};

/// The integral of a quintic step from 0 to 1 over [0, 1]; beyond, a straight line.
double stepped(double u) {
  const double x = std::clamp(u, 0.0, 1.0);
  return x * x * x * x * (2.5 + x * (-3 + x)) + std::max(0.0, u - 1);
}

/// Rest for 1.2 s, then to 6 m/s within 1 s.
Drive cruise() {
  return {[](double t) { return 6 * stepped(t - 1.2); }};
}
/// The same, and from 3 s on down to 1 m/s within 0.8 s: up to 12 m/s^2.
Drive braking() {
  return {[](double t) { return 6 * stepped(t - 1.2) - 5 * 0.8 * stepped((t - 3) / 0.8); }};
}

core::Rig rig(double group_delay_s = 0) {
  core::Rig r;
  r.gravity_m_s2 = kGravity;
  r.lidars.resize(1);
  r.lidars[0].T_body_lidar = tests::some_pose(0.5, 1.3);
  r.imus.resize(1);
  r.imus[0].T_body_imu = tests::some_pose(0.9, 1.1);
  r.imus[0].rate_hz = kRate;
  r.imus[0].delay = core::duration_from_s(0.5 / kRate + group_delay_s);
  return r;
}

/// Means over [end - 1 / rate, end], stamped `group_delay_s` later. Rate by the attitude's change, which is exact about
/// one axis; specific force by differences of position around the middle, whose error is of fourth order in 1 ms.
core::ImuSample mean_sample(const Drive& drive, const SE3& T_body_imu, double end_s, double group_delay_s) {
  const double dt = 1 / kRate, h = 1e-3, middle = end_s - dt / 2;
  const auto pose = [&](double t) -> SE3 { return drive.T_world_body(t) * T_body_imu; };
  const auto at = [&](double t) -> Vector3d { return pose(t).translation(); };
  const Vector3d a =
      (-at(middle + 2 * h) + 16 * at(middle + h) - 30 * at(middle) + 16 * at(middle - h) - at(middle - 2 * h)) /
      (12 * h * h);
  core::ImuSample sample;
  sample.t = time_from_s(end_s + group_delay_s);
  sample.gyro_rad_s = core::so3::log((pose(end_s - dt).inverse() * pose(end_s)).linear()) / dt;
  sample.accel_m_s2 = pose(middle).linear().transpose() * (a + Vector3d(0, 0, kGravity));
  return sample;
}

struct Samples {
  double seconds = 4.5;
  double group_delay_s = 0;
  double hole_from_s = 1e9, hole_to_s = 1e9;  ///< samples left out
};

std::vector<SweepOutcome> run(Estimator& estimator, const Drive& drive, const core::Rig& sheet, const Samples& setup) {
  const std::vector<Vector3d> world = tests::landmarks(28, 3, 0.9);
  const tests::Motion lidar = [&](double t) -> SE3 { return drive.T_world_body(t) * sheet.lidars[0].T_body_lidar; };
  std::vector<SweepOutcome> outcomes;
  int next = 1;
  for (int k = 0; k < static_cast<int>(10 * setup.seconds); ++k) {
    const core::LidarSweep sweep = tests::sweep_at(k, world, lidar, {.noise_m = 0.002});
    for (;; ++next) {
      const double end_s = next / kRate;
      if (time_from_s(end_s + setup.group_delay_s) > sweep.end) break;
      if (end_s > setup.hole_from_s && end_s < setup.hole_to_s) continue;
      estimator.add(mean_sample(drive, sheet.imus[0].T_body_imu, end_s, setup.group_delay_s));
    }
    outcomes.push_back(estimator.add(sweep));
  }
  return outcomes;
}

/// Error of the motion from the sweep's begin to its end, as the method placed its points [m].
double shear_m(const SweepOutcome& outcome, const Drive& drive) {
  const core::Segment& motion = outcome.motion.at(0);
  const double t0 = core::to_s(motion.t0), t1 = core::to_s(motion.t1);
  const SE3 estimated = motion.pose(motion.t0).inverse() * motion.pose(motion.t1);
  const SE3 truth = drive.T_world_body(t0).inverse() * drive.T_world_body(t1);
  return (truth.inverse() * estimated).translation().norm();
}

double pose_error(const SweepOutcome& outcome, const Drive& drive) {
  return tests::pose_difference(outcome.result.T_map_body, drive.T_world_body(core::to_s(outcome.result.reference)));
}

EstimatorContext context(const core::Rig& sheet) {
  return {.rig = sheet, .threads = 1, .diagnostics = core::DiagnosticsLevel::full};
}

TEST(KissIcpImu, FollowsADriveThroughExtrinsicsAndPlacesPointsByIt) {
  const core::Rig sheet = rig();
  KissIcpImu estimator({}, context(sheet));
  const std::vector<SweepOutcome> outcomes = run(estimator, cruise(), sheet, {});
  EXPECT_EQ(outcomes[8].result.status, SweepStatus::initialising);
  for (std::size_t k = 9; k < outcomes.size(); ++k) {
    ASSERT_EQ(outcomes[k].result.status, SweepStatus::ok) << k;
    EXPECT_LT(pose_error(outcomes[k], cruise()), 0.02) << k;
    EXPECT_EQ(outcomes[k].note, "") << k;
    const core::Segment& motion = outcomes[k].motion.at(0);
    EXPECT_EQ(motion.t0, outcomes[k].result.begin);
    EXPECT_EQ(motion.t1, outcomes[k].result.end);
    EXPECT_LT(tests::pose_difference(motion.pose(motion.t1), outcomes[k].result.T_map_body), 1e-9);
  }
  core::Estimate estimate;
  estimator.finish(estimate);
  EXPECT_TRUE(estimate.gravity_aligned);
  EXPECT_EQ(estimate.status, core::RunStatus::ok);
}

TEST(KissIcpImu, UnderHardBrakingItBendsSweepsFarLessThanKissIcp) {
  const core::Rig sheet = rig();
  KissIcpImu with_imu({}, context(sheet));
  KissIcp without(KissIcpOptions{}, context(sheet));
  const auto a = run(with_imu, braking(), sheet, {}), b = run(without, braking(), sheet, {});
  double worst_with = 0, worst_without = 0;
  for (std::size_t k = 30; k < 38; ++k) {
    worst_with = std::max(worst_with, shear_m(a[k], braking()));
    worst_without = std::max(worst_without, shear_m(b[k], braking()));
  }
  // kiss-icp places points by the motion of the sweep before: at 12 m/s^2 that is off by a T^2 = 12 cm a sweep.
  EXPECT_GT(worst_without, 0.08);
  EXPECT_LT(worst_with, 0.25 * worst_without);
}

TEST(KissIcpImu, HonoursTheStampsDelay) {
  const Samples late{.group_delay_s = 0.03};
  const core::Rig told = rig(0.03), untold = rig(0);
  KissIcpImu knows({}, context(told)), does_not({}, context(untold));
  const auto a = run(knows, braking(), told, late), b = run(does_not, braking(), untold, late);
  double with_sheet = 0, without = 0;
  for (std::size_t k = 30; k < 38; ++k) {
    with_sheet = std::max(with_sheet, shear_m(a[k], braking()));
    without = std::max(without, shear_m(b[k], braking()));
  }
  EXPECT_LT(with_sheet, 0.5 * without);
}

TEST(KissIcpImu, AHoleInTheSamplesIsCrossedAtConstantVelocityAndNoted) {
  const core::Rig sheet = rig();
  KissIcpImu estimator({}, context(sheet));
  const auto outcomes = run(estimator, cruise(), sheet, {.hole_from_s = 3.02, .hole_to_s = 3.25});
  double noted_s = 0;
  for (std::size_t k = 9; k < outcomes.size(); ++k) {
    EXPECT_EQ(outcomes[k].result.status, SweepStatus::ok) << k;
    // Speed and rate of turn are constant here: what the hole hides is what stands in for it.
    EXPECT_LT(pose_error(outcomes[k], cruise()), 0.02) << k;
    EXPECT_EQ(!outcomes[k].note.empty(), k >= 30 && k <= 32) << k << ": " << outcomes[k].note;
    if (!outcomes[k].note.empty()) noted_s += std::stod(outcomes[k].note);
  }
  // Samples of spans that end in (3.02, 3.25) are missing: 45 of them and the one up to 3.245.
  EXPECT_NEAR(noted_s, 0.23, 0.03);
}

TEST(KissIcpImu, OneLostSampleIsBridgedSilently) {
  const core::Rig sheet = rig();
  KissIcpImu estimator({}, context(sheet));
  for (const SweepOutcome& outcome : run(estimator, cruise(), sheet, {.hole_from_s = 3.021, .hole_to_s = 3.027}))
    EXPECT_EQ(outcome.note, "");
}

TEST(KissIcpImu, WithoutARestOrAnImuItIsNotInitialisedAndSaysWhy) {
  const auto message = [](const core::Rig& sheet) {
    KissIcpImu estimator({}, context(sheet));
    for (int k = 1; k < 800; ++k) {
      core::ImuSample sample;
      sample.t = time_from_s(k / kRate);
      sample.accel_m_s2 = Vector3d(0, 0, kGravity + 3 * std::sin(0.3 * k));
      estimator.add(sample);
    }
    EXPECT_EQ(estimator.add(tests::empty_sweep(0, time_from_s(3.9), time_from_s(4))).result.status,
              SweepStatus::initialising);
    core::Estimate estimate;
    estimator.finish(estimate);
    EXPECT_EQ(estimate.status, core::RunStatus::not_initialised);
    return estimate.message;
  };
  core::Rig sheet = rig();
  EXPECT_THAT(message(sheet), testing::HasSubstr("no rest in the first 3 s"));
  sheet.calibrated = false;
  EXPECT_THAT(message(sheet), testing::HasSubstr("no calibration"));
  sheet.imus.clear();
  EXPECT_THAT(message(sheet), testing::HasSubstr("no IMU"));
}

/// Stamps that run beyond the sweep's end, as by a wrong unit, are the sensor's fault: nothing breaks.
TEST(KissIcpImu, StampsFarOutsideTheSweepAreHeldAtTheEndsOfWhatIsKnown) {
  const core::Rig sheet = rig();
  KissIcpImu estimator({}, context(sheet));
  run(estimator, cruise(), sheet, {.seconds = 2.5});
  const std::vector<Vector3d> world = tests::landmarks(28, 3, 0.9);
  core::LidarSweep sweep = tests::sweep_at(25, world, tests::still());
  for (std::int32_t& t_ns : sweep.t_ns) t_ns = t_ns > 50'000'000 ? 2'000'000'000 : -2'000'000'000;
  const SweepOutcome outcome = estimator.add(sweep);
  EXPECT_TRUE(core::se3::all_finite(outcome.result.T_map_body));
  EXPECT_EQ(outcome.result.reference, sweep.end);
  EXPECT_EQ(outcome.motion.at(0).t1, sweep.end);
}

}  // namespace
}  // namespace tarmac::estimators
