/// The faithfulness checks of KISS-ICP's sheet, on worlds whose answer is known.
#include "estimators/kiss_icp/kiss_icp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "estimators/registry.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::SweepStatus;
using Eigen::Vector3d;
using tests::constant_twist;
using tests::landmarks;
using tests::sweep_at;

EstimatorContext context_of(const SE3& T_body_lidar = SE3::Identity(), int threads = 1) {
  EstimatorContext context;
  context.rig.lidars.resize(1);
  context.rig.lidars[0].T_body_lidar = T_body_lidar;
  context.threads = threads;
  context.diagnostics = core::DiagnosticsLevel::full;
  return context;
}

core::Vector6 gentle_twist() {
  core::Vector6 twist;  // per second: 3 m/s ahead, some slip and heave; 10 deg/s of yaw, some roll and pitch
  twist << 3, 0.3, -0.2, 0.02, -0.03, 0.17;
  return twist;
}

/// One landmark in the middle of each 2 m cell: alone in every voxel and sampling cell, hence nothing is thinned out
/// differently from sweep to sweep.
std::vector<Vector3d> sparse_world() {
  return landmarks(30, 4, 0.3);
}

TEST(KissIcp, StandsStillInAStillNoisyWorldAndNeverTouchesTheThreshold) {
  KissOdometry odometry(KissIcpOptions{});
  const std::vector<Vector3d> world = landmarks(14, 1.6, 0.6);
  for (int k = 0; k < 100; ++k) {
    const KissOdometry::Step step = odometry.add(sweep_at(k, world, tests::still(), {.noise_m = 0.01}));
    EXPECT_EQ(step.sigma_m, 2.0) << "sweep " << k;
    EXPECT_LT(odometry.T_map_lidar().translation().norm(), 0.01) << "sweep " << k;
  }
  EXPECT_EQ(odometry.threshold().sigma_m(), 2.0);
}

/// The first two sweeps see everything at one instant, so that the map and the first increment are exact; from then on
/// every sweep is distorted by constant twist, which is what the method assumes.
TEST(KissIcp, AConstantTwistIsPredictedDeskewedAndFollowedExactly) {
  const std::vector<Vector3d> world = sparse_world();
  const tests::Motion motion = constant_twist(gentle_twist());
  KissOdometry odometry(KissIcpOptions{});
  const SE3 T_world_map = motion(0.1);
  for (int k = 0; k < 30; ++k) {
    const core::LidarSweep sweep = sweep_at(k, world, motion, {.flash = k < 2});
    const KissOdometry::Step step = odometry.add(sweep);
    if (k < 2) continue;
    const SE3 truth = T_world_map.inverse() * motion(0.1 * (k + 1));
    EXPECT_LT((odometry.T_map_lidar().translation() - truth.translation()).norm(), 1e-3) << "sweep " << k;
    EXPECT_LE(step.icp.iterations, 3) << "sweep " << k;
    EXPECT_LT(odometry.threshold().last_deviation_m(), 0.01) << "sweep " << k;
    // Deskewed points are where the landmarks are, seen from the sweep's end.
    double worst_m = 0;
    for (std::size_t i = 0; i < world.size(); ++i) {
      worst_m = std::max(worst_m, (odometry.deskewed_m()[i] - motion(0.1 * (k + 1)).inverse() * world[i]).norm());
    }
    EXPECT_LT(worst_m, 1e-3) << "sweep " << k;
  }
}

TEST(KissIcp, WithoutDeskewingTheSameMotionLeavesTheSweepsDistorted) {
  const std::vector<Vector3d> world = sparse_world();
  const tests::Motion motion = constant_twist(gentle_twist());
  KissIcpOptions rigid;
  rigid.deskew = false;
  KissOdometry odometry(rigid);
  for (int k = 0; k < 10; ++k) odometry.add(sweep_at(k, world, motion, {.flash = k < 2}));
  // The first landmark was seen 0.1 s and hence at least 0.25 m before the last one.
  EXPECT_GT((odometry.deskewed_m()[0] - motion(1.0).inverse() * world[0]).norm(), 0.25);
}

TEST(KissIcp, AStepOfTwoMetresInOneSweepIsRecordedAsTheDeviationAndWidensTheNextSearch) {
  KissIcpOptions options;
  options.voxel_size_m = 5;  // so that the 27 voxels reach over the step
  options.initial_threshold_m = 1.2;
  KissOdometry odometry(options);
  const std::vector<Vector3d> world = landmarks(60, 10, 0.5);
  SE3 T_world_lidar = SE3::Identity();
  const tests::Motion motion = [&](double) { return T_world_lidar; };
  odometry.add(sweep_at(0, world, motion, {.flash = true}));
  EXPECT_EQ(odometry.add(sweep_at(1, world, motion, {.flash = true})).sigma_m, 1.2);
  T_world_lidar.translation().x() = 2;
  odometry.add(sweep_at(2, world, motion, {.flash = true}));
  EXPECT_NEAR(odometry.threshold().last_deviation_m(), 2, 1e-3);
  T_world_lidar.translation().x() = 4;
  const double sigma_m = odometry.add(sweep_at(3, world, motion, {.flash = true})).sigma_m;
  EXPECT_NEAR(sigma_m, std::sqrt((1.2 * 1.2 + 2 * 2) / 2), 1e-3);
  EXPECT_NEAR(odometry.T_map_lidar().translation().x(), 4, 1e-3);
}

TEST(KissIcp, AFixedThresholdStays) {
  KissIcpOptions options;
  options.fixed_threshold_m = 0.7;
  KissOdometry odometry(options);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(odometry.add(sweep_at(k, sparse_world(), constant_twist(gentle_twist()))).sigma_m, 0.7);
  }
}

TEST(KissIcp, KeepsTheMapsInvariantsAlongAMotion) {
  KissIcpOptions options;
  options.max_range_m = 8;
  KissOdometry odometry(options);
  const std::vector<Vector3d> world = landmarks(10, 0.5, 0.24);
  const tests::Motion motion = constant_twist(gentle_twist());
  for (int k = 0; k < 12; ++k) odometry.add(sweep_at(k, world, motion, {.noise_m = 0.02}));
  ASSERT_GT(odometry.map().voxel_count(), 1000U);
  for (const std::vector<Vector3d>& points : odometry.map().voxels()) {
    EXPECT_LE(points.size(), 20U);
    EXPECT_LT((points[0] - odometry.T_map_lidar().translation()).norm(), 8);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((points[i] - points[j]).norm(), 1 / std::sqrt(20.0));
    }
  }
}

TEST(KissIcp, SamplesAreNestedSubsetsOfTheDeskewedSweep) {
  KissOdometry odometry(KissIcpOptions{});
  const core::LidarSweep sweep = sweep_at(0, landmarks(10, 0.5, 0.24), constant_twist(gentle_twist()));
  odometry.add(sweep);
  std::vector<std::uint32_t> fine = odometry.map_sample(), coarse = odometry.icp_sample();
  std::sort(fine.begin(), fine.end());
  std::sort(coarse.begin(), coarse.end());
  EXPECT_TRUE(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
  EXPECT_LT(coarse.size(), fine.size());
  EXPECT_LT(fine.size(), sweep.size());
  EXPECT_EQ(std::adjacent_find(fine.begin(), fine.end()), fine.end());
  EXPECT_LT(fine.back(), sweep.size());
}

TEST(KissIcp, GatesRangesStrictly) {
  KissIcpOptions options;
  options.min_range_m = 2;
  options.max_range_m = 4;
  KissOdometry odometry(options);
  core::LidarSweep sweep;
  sweep.end = core::time_from_ns(1000);
  for (const float x : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F}) sweep.push_back({x, 0, 0}, 0, 0, 0);
  odometry.add(sweep);
  EXPECT_THAT(odometry.map_sample(), testing::ElementsAre(2U));
}

TEST(KissIcp, StampsOfNoSpanSkipDeskewing) {
  KissOdometry odometry(KissIcpOptions{});
  const std::vector<Vector3d> world = sparse_world();
  const tests::Motion motion = constant_twist(gentle_twist());
  for (int k = 0; k < 3; ++k) odometry.add(sweep_at(k, world, motion));
  const core::LidarSweep flash = sweep_at(3, world, motion, {.flash = true});
  EXPECT_FALSE(odometry.add(flash).motion.moves());
  for (std::size_t i = 0; i < flash.size(); ++i) EXPECT_EQ(odometry.deskewed_m()[i], flash.point(i));
}

TEST(KissIcp, StampsInAnyOrderGiveTheSameDeskewing) {
  core::LidarSweep sweep = sweep_at(0, sparse_world(), constant_twist(gentle_twist()));
  const SE3 D = tests::some_pose(0.1, 0.4);
  std::vector<Vector3d> ascending, descending;
  deskew(sweep, SweepMotion(sweep, D, true), ascending);
  for (auto* column : {&sweep.x_m, &sweep.y_m, &sweep.z_m}) std::reverse(column->begin(), column->end());
  std::reverse(sweep.t_ns.begin(), sweep.t_ns.end());
  deskew(sweep, SweepMotion(sweep, D, true), descending);
  std::reverse(descending.begin(), descending.end());
  EXPECT_EQ(ascending, descending);
}

class Bodied : public testing::Test {
 protected:
  /// A run over the first sweeps of a constant twist; the estimator is kept for more.
  void run(int sweeps) {
    for (int k = 0; k < sweeps; ++k) outcomes_.push_back(estimator_.add(sweep(k)));
  }
  core::LidarSweep sweep(int k) const { return sweep_at(k, world_, motion_, {.flash = k < 2}); }
  std::vector<Vector3d> world_ = sparse_world();
  tests::Motion motion_ = constant_twist(gentle_twist());
  SE3 T_body_lidar_ = tests::some_pose();
  KissIcp estimator_{KissIcpOptions{}, context_of(T_body_lidar_)};
  std::vector<SweepOutcome> outcomes_;
};

TEST_F(Bodied, ReportsTheBodyByTheNominalExtrinsicAtTheLastPoint) {
  run(5);
  // map is the LiDAR's frame at the first sweep's end.
  const SE3 truth = motion_(0.1).inverse() * motion_(0.5) * T_body_lidar_.inverse();
  EXPECT_LT(tests::pose_difference(outcomes_[4].result.T_map_body, truth), 1e-3);
  EXPECT_EQ(outcomes_[4].result.reference, sweep(4).end);
  EXPECT_EQ(outcomes_[4].result.status, SweepStatus::ok);
}

TEST_F(Bodied, SaysOfEveryPointByWhichPoseItWasPlaced) {
  run(4);
  KissOdometry odometry(KissIcpOptions{});
  for (int k = 0; k < 4; ++k) odometry.add(sweep(k));
  const core::LidarSweep last = sweep(3);
  const core::Segment& segment = outcomes_[3].motion.at(0);
  EXPECT_EQ(segment.t0, last.begin);
  EXPECT_EQ(segment.t1, last.end);
  for (std::size_t i = 0; i < last.size(); i += 7) {
    const Vector3d placed = odometry.T_map_lidar() * odometry.deskewed_m()[i];
    const Vector3d by_segment = segment.pose(last.time(i)) * (T_body_lidar_ * last.point(i));
    EXPECT_LT((placed - by_segment).norm(), 1e-9);
  }
}

TEST_F(Bodied, AnEmptySweepKeepsThePredictionAndSaysSo) {
  run(5);
  core::LidarSweep empty = sweep(5);
  const SE3 before = outcomes_[4].result.T_map_body;
  const SE3 increment = outcomes_[3].result.T_map_body.inverse() * before;
  empty.x_m.clear(), empty.y_m.clear(), empty.z_m.clear(), empty.t_ns.clear(), empty.ring.clear(),
      empty.intensity.clear();
  const SweepOutcome outcome = estimator_.add(empty);
  EXPECT_EQ(outcome.result.status, SweepStatus::empty);
  EXPECT_LT(tests::pose_difference(outcome.result.T_map_body, before * increment), 1e-9);
  // And it carries on.
  const SweepOutcome next = estimator_.add(sweep(6));
  EXPECT_EQ(next.result.status, SweepStatus::ok);
  const SE3 truth = motion_(0.1).inverse() * motion_(0.7) * T_body_lidar_.inverse();
  EXPECT_LT(tests::pose_difference(next.result.T_map_body, truth), 1e-3);
}

TEST_F(Bodied, AllPointsOutOfRangeIsAsEmptyAsNone) {
  run(3);
  core::LidarSweep far = sweep(3);
  for (float& x : far.x_m) x += 1000;
  EXPECT_EQ(estimator_.add(far).result.status, SweepStatus::empty);
}

TEST_F(Bodied, ASweepThatNothingInTheMapFitsIsLost) {
  run(3);
  core::LidarSweep elsewhere = sweep(3);
  for (float& z : elsewhere.z_m) z += 60;
  EXPECT_EQ(estimator_.add(elsewhere).result.status, SweepStatus::lost);
}

TEST_F(Bodied, PointsInASmallPartOfTheSweepLeaveTheRestUncovered) {
  run(3);
  core::LidarSweep part = sweep(3);
  for (std::int32_t& t_ns : part.t_ns) t_ns = 40'000'000 + t_ns / 10;
  const SweepOutcome outcome = estimator_.add(part);
  EXPECT_EQ(outcome.motion.at(0).t0, part.begin + core::Duration(40'000'000));
  EXPECT_EQ(outcome.motion.at(0).t1, part.begin + core::Duration(50'000'000));
  EXPECT_EQ(outcome.result.reference, part.begin + core::Duration(50'000'000));
}

TEST_F(Bodied, StampsBeyondTheSweepsEndKeepTheReferenceInside) {
  run(3);
  core::LidarSweep late = sweep(3);
  for (std::int32_t& t_ns : late.t_ns) t_ns += 10'000'000;
  const SweepOutcome outcome = estimator_.add(late);
  EXPECT_EQ(outcome.result.reference, late.end);
  EXPECT_EQ(outcome.motion.at(0).t1, late.end);
  EXPECT_LT(tests::pose_difference(outcome.result.T_map_body, outcome.motion.at(0).pose(late.end)), 1e-9);
}

TEST(RigidIcp, HoldsOnePoseOverTheSweep) {
  RigidIcp estimator(RigidIcpOptions{}, context_of(tests::some_pose()));
  const tests::Motion motion = constant_twist(gentle_twist());
  const std::vector<Vector3d> world = sparse_world();
  for (int k = 0; k < 3; ++k) {
    const SweepOutcome outcome = estimator.add(sweep_at(k, world, motion));
    EXPECT_EQ(outcome.motion.at(0).model, core::SegmentModel::held);
    EXPECT_EQ(outcome.motion.at(0).pose(outcome.result.begin).matrix(), outcome.result.T_map_body.matrix());
  }
}

TEST(KissIcpOptions, ContradictionsAreRefusedWithTheFieldsName) {
  KissIcpOptions options;
  options.min_range_m = 200;
  try {
    KissIcp(options, context_of());
    FAIL() << "accepted";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("min_range_m: 200"));
  }
}

TEST(RigidIcpOptions, HaveNoDeskewSwitch) {
  const EstimatorEntry* rigid = find_estimator("rigid-icp");
  const EstimatorEntry* kiss = find_estimator("kiss-icp");
  const auto has_deskew = [](const EstimatorEntry& entry) {
    const auto options = entry.describe();
    return std::any_of(options.begin(), options.end(), [](const auto& o) { return o.name == "deskew"; });
  };
  EXPECT_TRUE(has_deskew(*kiss));
  EXPECT_FALSE(has_deskew(*rigid));
  EXPECT_THROW(rigid->make(core::ConfigNode::parse("deskew: true", "t.yaml"), context_of()), core::InputError);
}

}  // namespace
}  // namespace tarmac::estimators
