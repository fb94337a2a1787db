#include <gtest/gtest.h>

#include "core/error.h"
#include "core/sweepwise_trajectory.h"
#include "tests/core/parametric_laws.h"

namespace tarmac::core {
namespace {

using Eigen::Vector3d;

SE3 somewhere() {
  Vector6 xi;
  xi << 4, -2, 1, 0.3, -0.4, 0.9;
  return se3::exp(xi);
}

/// Three sweeps of 0.1 s with gaps of 2 ms, moved off their prediction.
SweepwiseTrajectory three_sweeps(SweepwiseModel model) {
  SweepwiseTrajectory trajectory(model, somewhere());
  for (int k = 0; k < 3; ++k) {
    trajectory.extend(time_from_ns(102'000'000LL * k), time_from_ns(102'000'000LL * k + 100'000'000), {});
    Eigen::VectorXd step(trajectory.parameters());
    for (Eigen::Index i = 0; i < step.size(); ++i) step[i] = 0.2 * std::sin(2.3 * static_cast<double>(i + k));
    trajectory.retract(step);
  }
  return trajectory;
}

class Sweepwise : public testing::TestWithParam<SweepwiseModel> {};
INSTANTIATE_TEST_SUITE_P(Models, Sweepwise,
                         testing::Values(SweepwiseModel::rigid, SweepwiseModel::constant_velocity,
                                         SweepwiseModel::two_pose_slerp, SweepwiseModel::two_pose_screw));

TEST_P(Sweepwise, JetAndRateAreExact) {
  const SweepwiseTrajectory trajectory = three_sweeps(GetParam());
  for (const std::int64_t t_ns : {1'000'000LL, 35'000'000LL, 150'000'000LL, 290'000'000LL}) {
    expect_exact_jet(trajectory, time_from_ns(t_ns));
    expect_exact_rate(trajectory, time_from_ns(t_ns));
  }
  expect_consistent_difference(trajectory);
}

TEST_P(Sweepwise, GapsAreNotCoveredAndBoundariesBelongToTheLaterSweep) {
  const SweepwiseTrajectory trajectory = three_sweeps(GetParam());
  EXPECT_TRUE(trajectory.covers(time_from_ns(100'000'000)));
  EXPECT_FALSE(trajectory.covers(time_from_ns(101'000'000)));
  EXPECT_TRUE(trajectory.covers(time_from_ns(102'000'000)));
  StateJet jet;
  EXPECT_THROW(trajectory.jet(time_from_ns(101'000'000), Derivative::pose, jet), OutOfSpan);
  EXPECT_THROW(trajectory.at(time_from_ns(305'000'000)), OutOfSpan);
}

TEST_P(Sweepwise, TheSavedSegmentIsTheSameMotion) {
  const SweepwiseTrajectory trajectory = three_sweeps(GetParam());
  const Segment segment = trajectory.segment(time_from_ns(110'000'000), time_from_ns(200'000'000));
  for (std::int64_t t_ns = 110'000'000; t_ns <= 200'000'000; t_ns += 9'000'000) {
    const SE3 difference = segment.pose(time_from_ns(t_ns)).inverse() * trajectory.at(time_from_ns(t_ns)).T_world_body;
    EXPECT_LT(se3::log(difference).norm(), 1e-12);
  }
}

TEST_P(Sweepwise, WhatIsDroppedIsStillThePredictionsPast) {
  SweepwiseTrajectory whole = three_sweeps(GetParam()), cut = three_sweeps(GetParam());
  const Time t = time_from_ns(204'000'000);
  const int gone = cut.first_block_at(t);
  EXPECT_EQ(gone, 2 * cut.reach());
  cut.drop(gone);
  EXPECT_EQ(cut.begin(), t);
  for (SweepwiseTrajectory* trajectory : {&whole, &cut})
    trajectory->extend(time_from_ns(306'000'000), time_from_ns(406'000'000), {});
  for (const std::int64_t t_ns : {204'000'000LL, 306'000'000LL, 400'000'000LL}) {
    EXPECT_EQ(whole.at(time_from_ns(t_ns)).T_world_body.matrix(), cut.at(time_from_ns(t_ns)).T_world_body.matrix());
  }
}

TEST(SweepwiseSpan, ASharedInstantBelongsToTheLaterSweep) {
  SweepwiseTrajectory trajectory(SweepwiseModel::rigid, SE3::Identity());
  trajectory.extend(time_from_ns(0), time_from_ns(100), {});
  EXPECT_EQ(trajectory.first_block_at(time_from_ns(100)), 0);
  trajectory.extend(time_from_ns(100), time_from_ns(200), {});
  EXPECT_EQ(trajectory.first_block_at(time_from_ns(100)), 1);
  EXPECT_EQ(trajectory.first_block_at(time_from_ns(99)), 0);
  StateJet jet;
  trajectory.jet(time_from_ns(100), Derivative::pose, jet);
  EXPECT_EQ(jet.first, 6);
}

/// A sweep's segment ends where that sweep says, not where the next one begins.
TEST(SweepwiseSpan, ASegmentOfASweepEndsWithItsOwnPose) {
  SweepwiseTrajectory trajectory(SweepwiseModel::two_pose_screw, SE3::Identity());
  trajectory.extend(time_from_ns(0), time_from_ns(100), {});
  trajectory.extend(time_from_ns(100), time_from_ns(200), {});
  Eigen::VectorXd step = Eigen::VectorXd::Zero(trajectory.parameters());
  step[12] = 0.5;  // the second sweep begins half a metre further on
  trajectory.retract(step);
  const Segment segment = trajectory.segment(time_from_ns(0), time_from_ns(100));
  EXPECT_LT(segment.pose(time_from_ns(100)).translation().norm(), 1e-12);
  EXPECT_NEAR(trajectory.pose(time_from_ns(100)).translation().x(), 0.5, 1e-12) << "the instant belongs to the later";
}

TEST(SweepwisePrediction, ASweepOfNoDurationAddsNoMotion) {
  for (const SweepwiseModel model : {SweepwiseModel::rigid, SweepwiseModel::constant_velocity,
                                     SweepwiseModel::two_pose_slerp, SweepwiseModel::two_pose_screw}) {
    SweepwiseTrajectory trajectory(model, SE3::Identity());
    trajectory.extend(time_from_ns(0), time_from_ns(100), {});
    trajectory.extend(time_from_ns(100), time_from_ns(100), {});
    trajectory.extend(time_from_ns(100), time_from_ns(200), {});
    EXPECT_TRUE(se3::all_finite(trajectory.pose(time_from_ns(150)))) << static_cast<int>(model);
  }
}

TEST(SweepwisePrediction, RepeatsTheLastMotion) {
  Vector6 twist;
  twist << 3, 0.2, 0, 0, 0.1, 0.7;
  for (const SweepwiseModel model : {SweepwiseModel::constant_velocity, SweepwiseModel::two_pose_screw}) {
    SweepwiseTrajectory trajectory(model, somewhere());
    const SE3 T0 = somewhere();
    for (int k = 0; k < 4; ++k) {
      const Time begin = time_from_ns(100'000'000LL * k), end = begin + Duration(99'000'000);
      trajectory.extend(begin, end, {});
      if (k >= 2) {
        // From the third sweep on, nothing is left to correct.
        const SE3 expected = T0 * se3::exp(to_s(end) * twist);
        EXPECT_LT(se3::log(expected.inverse() * trajectory.at(end).T_world_body).norm(), 1e-10);
        continue;
      }
      Eigen::VectorXd step = Eigen::VectorXd::Zero(trajectory.parameters());
      const int blocks = trajectory.blocks(), per_sweep = trajectory.reach();
      const auto correct = [&](int block, Time t) {
        const SE3 have = trajectory.at(t).T_world_body;
        step.segment<6>(6 * block) = se3::log(have.inverse() * (T0 * se3::exp(to_s(t) * twist)));
      };
      if (per_sweep == 2) correct(blocks - 2, begin);
      correct(blocks - 1, end);
      trajectory.retract(step);
    }
  }
}

TEST(SweepwisePrediction, RefusesASweepThatDoesNotFollow) {
  SweepwiseTrajectory trajectory(SweepwiseModel::rigid, SE3::Identity());
  trajectory.extend(time_from_ns(0), time_from_ns(100), {});
  EXPECT_THROW(trajectory.extend(time_from_ns(50), time_from_ns(150), {}), InputError);
  EXPECT_THROW(trajectory.extend(time_from_ns(150), time_from_ns(120), {}), InputError);
}

}  // namespace
}  // namespace tarmac::core
