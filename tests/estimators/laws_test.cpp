/// Laws that hold for every estimator there is: a new one joins by being registered.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/files.h"
#include "estimators/registry.h"
#include "estimators/run.h"
#include "tests/estimators/recordings.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::SweepStatus;

/// Surfaces for the methods that need them, and points off them for those that match points.
std::vector<Eigen::Vector3d> world_points() {
  const std::vector<Eigen::Vector3d> points = tests::wall_points();
  const std::vector<Eigen::Vector3d> landmarks = tests::landmarks(18, 2.4, 0.8);
  // Mixed, so that firing order has nothing to do with which is which.
  std::vector<Eigen::Vector3d> mixed;
  for (std::size_t i = 0; i < std::max(points.size(), landmarks.size()); ++i) {
    if (i < points.size()) mixed.push_back(points[i]);
    if (i < landmarks.size()) mixed.push_back(landmarks[i]);
  }
  return mixed;
}

class EveryEstimator : public testing::TestWithParam<const EstimatorEntry*> {
 protected:
  RunResult run(const core::Recording& recording, int threads = 1) {
    return run_estimator(recording, *GetParam(), {},
                         {.rig = recording.rig(), .threads = threads, .diagnostics = core::DiagnosticsLevel::full}, {});
  }
  std::string bytes(const RunResult& result, const std::string& name) {
    core::save_estimate(folder_ / name, result.estimate);
    core::save_diagnostics(folder_ / (name + ".diagnostics"), result.diagnostics);
    return core::read_file(folder_ / name) + core::read_file(folder_ / (name + ".diagnostics"));
  }
  /// Rest for 1.5 s, then ahead on a bend, gathering speed evenly; the IMU's samples are exact up to the sampling.
  core::Recording drive(const std::string& name, const SE3& T_there_here = SE3::Identity(), double noise_m = 0.01) {
    const tests::Motion body = [&](double t_s) -> SE3 {
      const double u = std::max(0.0, t_s - 1.5);
      core::Vector6 xi = core::Vector6::Zero();
      xi << 0.6 * u * u, 0, 0, 0, 0, 0.05 * u * u;
      return T_there_here * core::se3::exp(xi);
    };
    const SE3 T_body_lidar = rig_.lidars[0].T_body_lidar;
    std::vector<Eigen::Vector3d> world = tests::wall_points();
    for (Eigen::Vector3d& p : world) p = T_there_here * p;
    std::vector<core::LidarSweep> sweeps;
    const tests::Motion lidar = [&](double t_s) -> SE3 { return body(t_s) * T_body_lidar; };
    for (int k = 0; k < 25; ++k) sweeps.push_back(tests::sweep_at(k, world, lidar, {.noise_m = noise_m}));
    return tests::write_recording(folder_ / name, rig_, sweeps, imu_of(body));
  }
  std::vector<core::ImuSample> imu_of(const tests::Motion& body) const {
    std::vector<core::ImuSample> samples;
    const SE3 T_body_imu = rig_.imus[0].T_body_imu;
    for (int k = 1; k <= 250; ++k) {
      // Differences over the interval, hence means.
      const double t1 = 0.01 * k, t0 = t1 - 0.01, h = 1e-3;
      const auto position = [&](double t) -> Eigen::Vector3d { return (body(t) * T_body_imu).translation(); };
      const auto velocity = [&](double t) -> Eigen::Vector3d { return (position(t + h) - position(t - h)) / (2 * h); };
      const SE3 middle = body(0.5 * (t0 + t1)) * T_body_imu;
      core::ImuSample& sample = samples.emplace_back();
      sample.t = core::time_from_ns(std::int64_t{k} * 10'000'000);
      sample.gyro_rad_s = core::so3::log(((body(t0) * T_body_imu).inverse() * (body(t1) * T_body_imu)).linear()) / 0.01;
      sample.accel_m_s2 = middle.linear().transpose() *
                          ((velocity(t1) - velocity(t0)) / 0.01 + Eigen::Vector3d(0, 0, rig_.gravity_m_s2));
    }
    return samples;
  }
  core::Rig rig_ = tests::rig_with_imu();
  tests::Folder folder_;
};

TEST_P(EveryEstimator, AStillRigGivesAStillTrajectory) {
  std::vector<core::LidarSweep> sweeps;
  const std::vector<Eigen::Vector3d> world = world_points();
  for (int k = 0; k < 30; ++k) sweeps.push_back(tests::sweep_at(k, world, tests::still(), {.noise_m = 0.005}));
  const RunResult result = run(tests::write_recording(folder_ / "still", rig_, sweeps, tests::imu_at_rest(rig_, 3)));
  std::vector<SE3> poses;
  for (const core::SweepResult& sweep : result.estimate.sweeps) {
    if (sweep.status == SweepStatus::ok) poses.push_back(sweep.T_map_body);
  }
  ASSERT_GE(poses.size(), 20U);
  for (const SE3& T : poses) EXPECT_LT(tests::pose_difference(T, poses.front()), 0.01);
}

TEST_P(EveryEstimator, FollowsADriveOfSomeMetres) {
  const RunResult result = run(drive("drive"));
  ASSERT_EQ(result.estimate.status, core::RunStatus::ok) << result.estimate.message;
  const core::SweepResult &from = result.estimate.sweeps[14], &to = result.estimate.sweeps[24];
  ASSERT_EQ(from.status, SweepStatus::ok);
  ASSERT_EQ(to.status, SweepStatus::ok);
  core::Vector6 xi = core::Vector6::Zero();
  xi << 0.6, 0, 0, 0, 0, 0.05;  // from rest at 1.5 s to 2.5 s
  EXPECT_LT(tests::pose_difference(from.T_map_body.inverse() * to.T_map_body, core::se3::exp(xi)), 0.1);
}

TEST_P(EveryEstimator, MovingTheWorldChangesNothing) {
  // Gravity stays where it is: the move is a turn about the vertical and a shift.
  SE3 T_there_here = SE3::Identity();
  T_there_here.linear() = core::so3::exp({0, 0, 2.2});
  T_there_here.translation() << 300, -170, 20;
  const RunResult here = run(drive("here")), there = run(drive("there", T_there_here));
  ASSERT_EQ(here.estimate.sweeps.size(), there.estimate.sweeps.size());
  for (std::size_t k = 0; k < here.estimate.sweeps.size(); ++k) {
    EXPECT_EQ(here.estimate.sweeps[k].status, there.estimate.sweeps[k].status);
    EXPECT_LT(tests::pose_difference(here.estimate.sweeps[k].T_map_body, there.estimate.sweeps[k].T_map_body), 1e-4)
        << "sweep " << k;
  }
}

TEST_P(EveryEstimator, SameInputSameBytesWithOneThreadOrMore) {
  const core::Recording recording = drive("drive");
  const std::string one = bytes(run(recording, 1), "one");
  EXPECT_EQ(one, bytes(run(recording, 1), "again"));
  EXPECT_EQ(one, bytes(run(recording, 2), "two threads"));
}

TEST_P(EveryEstimator, ReferencePosesLieOnTheMotionThatItReports) {
  const RunResult result = run(drive("drive"));
  for (const core::SweepResult& sweep : result.estimate.sweeps) {
    if (sweep.status != SweepStatus::ok) continue;
    // A boundary instant belongs to the later sweep: ask the segment that ends there.
    for (const core::Segment& segment : result.estimate.causal.segments()) {
      if (segment.t0 != sweep.begin) continue;
      EXPECT_EQ(segment.t1, sweep.end);
      EXPECT_LT(tests::pose_difference(segment.pose(sweep.reference), sweep.T_map_body), 1e-9);
    }
  }
}

TEST_P(EveryEstimator, DescribesAndResolvesEveryOption) {
  const std::string resolved = GetParam()->resolve({});
  const auto options = GetParam()->describe();
  ASSERT_FALSE(options.empty());
  for (const core::OptionDescription& option : options) {
    EXPECT_FALSE(option.meaning.empty()) << option.name;
    // Options of a group are described by their path and written one below the other.
    const std::string leaf = option.name.substr(option.name.rfind('.') + 1);
    EXPECT_NE(resolved.find(leaf + ":"), std::string::npos) << option.name;
  }
  // What is written can be read again.
  EXPECT_EQ(GetParam()->resolve(core::ConfigNode::parse(resolved, "resolved.yaml")), resolved);
}

std::string test_name(const testing::TestParamInfo<const EstimatorEntry*>& entry) {
  std::string name = entry.param->name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Registered, EveryEstimator, testing::ValuesIn(estimators().begin(), estimators().end()),
                         test_name);

}  // namespace
}  // namespace tarmac::estimators
