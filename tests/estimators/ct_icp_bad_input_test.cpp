/// CT-ICP where a sweep is not as it should be, and its second attempts.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "estimators/ct_icp/ct_icp.h"
#include "tests/estimators/room_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::LidarSweep;
using core::SE3;
using core::SweepStatus;

core::Rig rig() {
  core::Rig r;
  r.lidars.resize(1);
  r.lidars[0].T_body_lidar = tests::some_pose(0.3, 0.8);
  return r;
}

/// 0.3 m and two degrees a sweep after a rest of `rest` sweeps.
tests::Motion bend(int rest, double metres = 0.3, double degrees = 2) {
  return [=](double t_s) -> SE3 {
    const double u = std::max(0.0, t_s / 0.1 - rest);
    core::Vector6 xi = core::Vector6::Zero();
    xi[0] = metres * u;
    xi[5] = degrees * M_PI / 180 * u;
    return core::se3::exp(xi);
  };
}

class CtIcpBadInput : public testing::Test {
 protected:
  void make(const CtIcpOptions& options = {}) {
    estimator_ = std::make_unique<CtIcp>(options, EstimatorContext{.rig = rig()});
  }
  LidarSweep sweep(std::int64_t k, const tests::Motion& body = tests::still()) const {
    const SE3 T_body_lidar = rig().lidars[0].T_body_lidar;
    return tests::sweep_of(room_, k, [&](double t_s) -> SE3 { return body(t_s) * T_body_lidar; });
  }
  SweepOutcome feed_until(std::int64_t k, const tests::Motion& body = tests::still()) {
    SweepOutcome outcome;
    for (; next_ <= k; ++next_) outcome = estimator_->add(sweep(next_, body));
    return outcome;
  }
  tests::Room room_;
  std::int64_t next_ = 0;
  std::unique_ptr<CtIcp> estimator_;
};

LidarSweep with_points(const LidarSweep& sweep, const std::function<bool(std::size_t)>& keep) {
  LidarSweep out;
  out.index = sweep.index;
  out.begin = sweep.begin;
  out.end = sweep.end;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    if (keep(i)) out.push_back(sweep.point(i).cast<float>(), sweep.t_ns[i], sweep.ring[i], sweep.intensity[i]);
  }
  return out;
}

TEST_F(CtIcpBadInput, EqualStampsAreRegisteredAsARigidSweep) {
  for (const std::int32_t stamp_ns : {0, 50'000'000, 100'000'000}) {
    make();
    next_ = 0;
    feed_until(4);
    LidarSweep flash = sweep(5);
    std::fill(flash.t_ns.begin(), flash.t_ns.end(), stamp_ns);
    const SweepOutcome outcome = estimator_->add(flash);
    EXPECT_EQ(outcome.result.status, SweepStatus::ok);
    ASSERT_EQ(outcome.motion.size(), 1U);
    EXPECT_EQ(outcome.motion[0].model, core::SegmentModel::held);
    EXPECT_EQ(outcome.motion[0].t0, flash.begin);
    EXPECT_EQ(outcome.result.reference, flash.end);
    EXPECT_LT(tests::pose_difference(outcome.result.T_map_body, SE3::Identity()), 0.01);
    EXPECT_EQ(outcome.diagnostics.H_prior.norm(), 0);
  }
}

TEST_F(CtIcpBadInput, StampsInTheWrongUnitStillTellBeginFromEnd) {
  make();
  const tests::Motion body = bend(4);
  feed_until(6, body);
  LidarSweep micro = sweep(7, body);
  for (std::int32_t& t_ns : micro.t_ns) t_ns /= 1000;
  const SweepOutcome outcome = estimator_->add(micro);
  EXPECT_EQ(outcome.result.status, SweepStatus::ok);
  const core::Segment& motion = outcome.motion.at(0);
  EXPECT_EQ(motion.t0, micro.begin);
  EXPECT_EQ(motion.t1, micro.begin + core::Duration(100'000));
  ASSERT_EQ(motion.poses.size(), 2U);
  EXPECT_LT(tests::pose_difference(motion.poses[0], body(0.7)), 0.03);
  EXPECT_LT(tests::pose_difference(motion.poses[1], body(0.8)), 0.03);
}

TEST(SweepSpan, StampsOutsideAreMovedToTheNearerEndAndCounted) {
  LidarSweep sweep;
  sweep.end = core::time_from_ns(1000);
  for (const std::int32_t t_ns : {-5, 0, 250, 1000, 1001, 4000}) sweep.push_back({1, 2, 3}, t_ns, 0, 0);
  const SweepSpan span(sweep);
  EXPECT_TRUE(span.elastic());
  EXPECT_EQ(span.clipped(), 3);
  EXPECT_EQ(span.alpha(-5), 0);
  EXPECT_EQ(span.alpha(250), 0.25);
  EXPECT_EQ(span.alpha(4000), 1);
}

TEST(SweepSpan, AnEmptySweepAndOneWithoutLengthAreNotElastic) {
  LidarSweep sweep;
  EXPECT_FALSE(SweepSpan(sweep).elastic());
  sweep.push_back({1, 2, 3}, 0, 0, 0);
  sweep.push_back({1, 2, 3}, 5, 0, 0);
  EXPECT_FALSE(SweepSpan(sweep).elastic());
  EXPECT_EQ(SweepSpan(sweep).alpha(5), 1);
}

TEST_F(CtIcpBadInput, TooFewPointsKeepThePredictionAndLeaveTheMapAlone) {
  make();
  const tests::Motion body = bend(3);
  feed_until(6, body);
  const SweepOutcome poor = estimator_->add(with_points(sweep(7, body), [](std::size_t i) { return i % 200 == 0; }));
  EXPECT_EQ(poor.result.status, SweepStatus::lost);
  // The motion of the sweep before once more.
  EXPECT_LT(tests::pose_difference(poor.result.T_map_body, body(0.8)), 0.03);
  EXPECT_EQ(poor.diagnostics.residuals, 0);
  next_ = 8;
  const SweepOutcome after = feed_until(8, body);
  EXPECT_EQ(after.result.status, SweepStatus::ok);
  EXPECT_LT(tests::pose_difference(after.result.T_map_body, body(0.9)), 0.03);
}

TEST_F(CtIcpBadInput, ALostSweepIsNotInserted) {
  CtOdometry odometry({}, SE3::Identity());
  for (std::int64_t k = 0; k < 4; ++k) odometry.add(tests::sweep_of(room_, k, tests::still()));
  const std::size_t before = odometry.map().voxel_count();
  // Elsewhere, so that inserting it would show.
  LidarSweep poor = with_points(tests::sweep_of(room_, 4, tests::still()), [](std::size_t i) { return i % 200 == 0; });
  for (float& z : poor.z_m) z += 30;
  EXPECT_TRUE(odometry.add(poor).lost);
  EXPECT_EQ(odometry.map().voxel_count(), before);
  EXPECT_FALSE(odometry.add(tests::sweep_of(room_, 5, tests::still())).lost);
}

TEST_F(CtIcpBadInput, EmptySweepsKeepThePrediction) {
  make();
  const tests::Motion body = bend(3);
  feed_until(6, body);
  const LidarSweep full = sweep(7, body);
  const SweepOutcome outcome = estimator_->add(tests::empty_sweep(7, full.begin, full.end));
  EXPECT_EQ(outcome.result.status, SweepStatus::empty);
  EXPECT_LT(tests::pose_difference(outcome.result.T_map_body, body(0.8)), 0.03);
}

TEST_F(CtIcpBadInput, TheMapStartsWithTheFirstSweepThatHasEnoughPoints) {
  make();
  const LidarSweep first = sweep(0);
  EXPECT_EQ(estimator_->add(tests::empty_sweep(0, first.begin, first.end)).result.status, SweepStatus::empty);
  EXPECT_EQ(estimator_->add(with_points(sweep(1), [](std::size_t i) { return i < 50; })).result.status,
            SweepStatus::lost);
  next_ = 2;
  const SweepOutcome outcome = feed_until(5);
  EXPECT_EQ(outcome.result.status, SweepStatus::ok);
  EXPECT_LT(tests::pose_difference(outcome.result.T_map_body, SE3::Identity()), 0.01);
}

TEST_F(CtIcpBadInput, MotionBeyondTheLimitsIsLost) {
  for (const bool turning : {false, true}) {
    CtIcpOptions options;
    (turning ? options.max_rotation_deg : options.max_translation_m) = turning ? 1.0 : 0.2;
    make(options);
    next_ = 0;
    EXPECT_EQ(feed_until(2).result.status, SweepStatus::ok);
    const SweepOutcome outcome = feed_until(4, bend(3));
    EXPECT_EQ(outcome.result.status, SweepStatus::lost);
  }
}

TEST_F(CtIcpBadInput, RobustTriesAgainWithMoreEffortWhereItTurnsFast) {
  CtIcpOptions options;
  options.robust = true;
  options.robust_checks_map = false;
  CtOdometry odometry(options, SE3::Identity());
  const tests::Motion body = bend(5, 0.3, 5);
  CtOdometry::Step step;
  for (std::int64_t k = 0; k <= 5; ++k) step = odometry.add(tests::sweep_of(room_, k, body));
  EXPECT_EQ(step.attempts, 2);
  EXPECT_EQ(step.level, 1);
  EXPECT_FALSE(step.lost);
  EXPECT_FALSE(step.inserted);
  EXPECT_LT(tests::pose_difference(step.motion.poses[1], body(0.6)), 0.05);
  // The next starts where this one had to go.
  step = odometry.add(tests::sweep_of(room_, 6, body));
  EXPECT_EQ(step.level, 1);
  EXPECT_EQ(step.attempts, 1);
}

TEST_F(CtIcpBadInput, RobustGivesUpAfterItsAttemptsAndSaysSo) {
  CtIcpOptions options;
  options.robust = true;
  options.robust_checks_map = false;
  options.robust_attempts = 3;
  options.robust_max_translation_m = 0.2;
  CtOdometry odometry(options, SE3::Identity());
  CtOdometry::Step step;
  for (std::int64_t k = 0; k <= 5; ++k) step = odometry.add(tests::sweep_of(room_, k, bend(5)));
  EXPECT_EQ(step.attempts, 3);
  EXPECT_EQ(step.level, 2);
  EXPECT_FALSE(step.lost) << "doubtful, and believed when no attempt is left";
}

TEST(Effort, RaisesSearchIterationsSamplingAndGates) {
  CtIcpOptions options;
  options.set_profile("master");
  options.max_plane_distance_m = 0.4;
  Effort effort = Effort::from(options, false);
  effort.raise(options);
  EXPECT_EQ(effort.level, 1);
  EXPECT_EQ(effort.settings.association.search.reach, 2);
  EXPECT_EQ(effort.settings.association.max_residuals, 1800);
  EXPECT_DOUBLE_EQ(effort.settings.association.max_plane_distance_m, 0.6);
  EXPECT_DOUBLE_EQ(effort.settings.loss.scale, 0.12);
  EXPECT_EQ(effort.settings.ceres_max_iterations, 35);
  EXPECT_EQ(effort.settings.max_iterations, 25);
  EXPECT_DOUBLE_EQ(effort.keypoint_cell_m, 1.0);
  EXPECT_DOUBLE_EQ(effort.settings.convergence_m, 0.001);
  for (int k = 0; k < 8; ++k) effort.raise(options);
  EXPECT_EQ(effort.settings.association.search.reach, options.robust_max_voxel_reach);
  EXPECT_EQ(effort.settings.max_iterations, 50);
  EXPECT_DOUBLE_EQ(effort.keypoint_cell_m, options.startup_sample_cell_m);
}

TEST(MapOverlap, CountsPointsInEmptyAndInWellFilledVoxels) {
  VoxelMap map(1, 4, 0.01);
  for (const double x : {0.1, 0.3, 0.5}) map.add({x, 0.5, 0.5});
  map.add({1.5, 0.5, 0.5});
  const MapOverlap overlap = MapOverlap::of(map, {{0.9, 0.9, 0.9}, {1.1, 0, 0}, {2.5, 0, 0}, {0.2, 0, 0}});
  EXPECT_DOUBLE_EQ(overlap.empty, 0.25);
  EXPECT_DOUBLE_EQ(overlap.half_full, 0.5);
  CtIcpOptions options;
  EXPECT_EQ(judge(options, overlap), Verdict::doubtful);
  options.robust_max_empty_ratio = 0.3;
  options.robust_min_half_full_ratio = 0.4;
  EXPECT_EQ(judge(options, overlap), Verdict::good);
}

TEST(CtIcpOptions, RefusesWhatContradictsItself) {
  const EstimatorContext context{.rig = rig()};
  const auto refuses = [&](const std::function<void(CtIcpOptions&)>& change) {
    CtIcpOptions options;
    change(options);
    EXPECT_THROW(CtIcp(options, context), core::InputError);
  };
  refuses([](CtIcpOptions& o) { o.min_range_m = 100; });
  refuses([](CtIcpOptions& o) { o.min_neighbours = 30; });
  refuses([](CtIcpOptions& o) { o.planarity_weight = 0; });
  refuses([](CtIcpOptions& o) { o.max_range_m = 1e9; });
  refuses([](CtIcpOptions& o) {
    o.gauss_newton_quirk = true;
    o.solver = "ceres";
  });
  EXPECT_NO_THROW(CtIcp({}, context));
}

}  // namespace
}  // namespace tarmac::estimators
