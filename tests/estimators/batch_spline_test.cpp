/// All data at once: better than the odometry that it starts from, whoever solves it.
#include "estimators/batch_spline/batch_spline.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/estimators/inertial_room.h"

namespace tarmac::estimators {
namespace {

using core::SE3;

constexpr int kBatchSweeps = 26;

BatchSplineOptions room_options() {
  BatchSplineOptions options;
  options.sampling.sample_cell_m = options.sampling.startup_sample_cell_m = 0.2;
  options.sampling.keypoint_cell_m = options.sampling.startup_keypoint_cell_m = 0.5;
  options.rounds = 4;
  return options;
}

/// A drive through the room, fed as it happens; the IMU's clock is `offset_s` ahead.
struct Survey {
  explicit Survey(const BatchSplineOptions& options, double offset_s = 0, bool with_imu = true) {
    core::Rig rig = tests::room_rig();
    const tests::Motion body = [](double t_s) { return tests::room_motion(t_s, 1.5); };
    const tests::Motion lidar = [&](double t_s) -> SE3 { return body(t_s) * rig.lidars[0].T_body_lidar; };
    const std::vector<core::ImuSample> imu = tests::room_imu(rig, body, 0.1 * kBatchSweeps + 0.05, offset_s);
    if (!with_imu) rig.imus.clear();
    method = std::make_unique<BatchSpline>(options, EstimatorContext{.rig = rig});
    const tests::Room room;
    std::size_t next = 0;
    for (int k = 0; k < kBatchSweeps; ++k) {
      const core::LidarSweep sweep = tests::sweep_of(room, k, lidar, {.rings = 24, .columns = 256});
      for (; with_imu && next < imu.size() && imu[next].t <= sweep.end; ++next) method->add(imu[next]);
      estimate.sweeps.push_back(method->add(sweep).result);
    }
    method->finish(estimate);
    const SE3 T_map_world =
        estimate.final.pose(estimate.final.begin()) * body(core::to_s(estimate.final.begin())).inverse();
    for (const core::Segment& segment : estimate.final.segments())
      for (const core::Time t : {segment.t0, segment.t1 - core::Duration(30'000'000)})
        worst_m = std::max(worst_m,
                           (estimate.final.pose(t).inverse() * T_map_world * body(core::to_s(t))).translation().norm());
  }
  std::unique_ptr<BatchSpline> method;
  core::Estimate estimate;
  double worst_m = 0;
};

TEST(BatchSpline, PlacesTheWholeDriveToCentimetres) {
  const Survey run(room_options());
  EXPECT_FALSE(run.estimate.has_causal);
  EXPECT_TRUE(run.estimate.has_final);
  EXPECT_TRUE(run.estimate.gravity_aligned);
  // Upright as the truth is at the end, gravity's direction having been an unknown.
  const core::Time end = run.estimate.final.end() - core::Duration(1'000'000);
  const Eigen::Vector3d up = run.estimate.final.pose(end).linear().transpose() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_true =
      tests::room_motion(core::to_s(end), 1.5).linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((up - up_true).norm(), 2e-3);
  EXPECT_GE(run.method->rounds(), 1);
  EXPECT_LT(run.worst_m, 0.03);
}

TEST(BatchSpline, CeresEndsWhereTheBandedSolverDoes) {
  BatchSplineOptions options = room_options();
  options.rounds = 2;
  options.lidar.loss = "standard";  // the two correct for robust losses to different order on the way
  const Survey banded(options);
  options.solver = "ceres";
  const Survey ceres(options);
  double apart_m = 0;
  for (const core::SweepResult& sweep : banded.estimate.sweeps) {
    if (sweep.status != core::SweepStatus::ok) continue;
    const SE3 difference = banded.estimate.final.pose(sweep.end).inverse() * ceres.estimate.final.pose(sweep.end);
    apart_m = std::max(apart_m, difference.translation().norm());
  }
  EXPECT_LT(apart_m, 2e-3);
}

TEST(BatchSpline, FindsTheTimeOffset) {
  BatchSplineOptions options = room_options();
  options.imu.free_time_offset = true;
  const Survey run(options, 0.006);
  EXPECT_NEAR(run.method->window()->state().imu_offset_s, 0.006, 5e-4);
  EXPECT_NE(run.estimate.message.find("IMU time offset"), std::string::npos);
}

TEST(BatchSpline, WorksWithoutAnImu) {
  const Survey run(room_options(), 0, false);
  EXPECT_FALSE(run.estimate.gravity_aligned);
  EXPECT_LT(run.worst_m, 0.1);
}

TEST(BatchSpline, RefusesAStartThatKnowsNoAttitude) {
  BatchSplineOptions options = room_options();
  options.odometry = "wnoa";
  EXPECT_THROW(BatchSpline(options, EstimatorContext{.rig = tests::room_rig()}), core::InputError);
}

TEST(BatchSpline, RefusesOptionsOfOdometriesThatHaveNoEffectOnIt) {
  const auto message = [](auto change) -> std::string {
    BatchSplineOptions options;
    change(options);
    try {
      BatchSpline(options, EstimatorContext{.rig = tests::room_rig()});
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(message([](BatchSplineOptions&) {}), "taken");
  EXPECT_EQ(message([](BatchSplineOptions& o) { o.map.radius_m = 50; }).find("map.radius_m"), 0u);
  EXPECT_EQ(message([](BatchSplineOptions& o) { o.map.delay_sweeps = 1; }).find("map.delay_sweeps"), 0u);
  EXPECT_EQ(message([](BatchSplineOptions& o) { o.lidar.startup_voxel_reach = 3; }).find("lidar.startup_voxel"), 0u);
  EXPECT_EQ(message([](BatchSplineOptions& o) {
              o.imu.use = "none";
              o.imu.free_time_offset = true;
            }).find("imu.free_time_offset"),
            0u);
}

}  // namespace
}  // namespace tarmac::estimators
