/// One front end, every motion model: each profile on the same drive through a furnished room.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstdio>
#include <functional>
#include <set>

#include "core/config.h"
#include "core/error.h"
#include "core/spline_trajectory.h"
#include "estimators/composed/options.h"
#include "estimators/steam/options.h"
#include "estimators/window_odometry/odometry.h"
#include "estimators/window_odometry/record.h"
#include "tests/estimators/inertial_room.h"

namespace tarmac::estimators {
namespace {

using core::SE3;

constexpr int kComposedSweeps = 28;

ComposedOptions composed_profile(const std::string& name) {
  ComposedOptions options;
  options.set_profile(name);
  // The room is small: a street's cells would leave a few dozen points.
  options.sampling.sample_cell_m = options.sampling.startup_sample_cell_m = 0.2;
  options.sampling.keypoint_cell_m = options.sampling.startup_keypoint_cell_m = 0.5;
  return options;
}

/// What came out of a drive: RMS over sweeps and times of how far a body point 8 m ahead is off, each sweep aligned to
/// truth at its end (deskewing), and how far the last end is off in the map.
struct Outcome {
  double deskew_rms_m = 0, end_error_m = 0;
  int ok = 0, lost = 0, initialising = 0;
};

class Drive {
 public:
  explicit Drive(double strength = 1, double imu_offset_s = 0, int columns = 128)
      : columns_(columns),
        motion_([strength](double t_s) { return tests::room_motion(t_s, strength); }),
        imu_(tests::room_imu(rig_, motion_, 0.1 * kComposedSweeps + 0.05, imu_offset_s)) {}

  using EachSweep = std::function<void(const WindowOdometry::Step&, const SE3& T_map_body_true, core::Time end)>;
  Outcome run(WindowOdometry& odometry, const EachSweep& each = {}, const std::set<int>& missing = {}) const {
    Outcome outcome;
    std::size_t next = 0;
    double sum = 0;
    int count = 0;
    SE3 T_map_world = SE3::Identity();
    bool first = true;
    for (int k = 0; k < kComposedSweeps; ++k) {
      if (missing.contains(k)) continue;
      const core::LidarSweep sweep = sweep_of(k);
      while (next < imu_.size() && imu_[next].t <= sweep.end) odometry.add(imu_[next++]);
      const WindowOdometry::Step step = odometry.add(sweep);
      if (!step.started) {
        ++outcome.initialising;
        continue;
      }
      ++(step.lost ? outcome.lost : outcome.ok);
      if (first) T_map_world = step.T_map_body_end * motion_(core::to_s(sweep.end)).inverse();
      first = false;
      if (each) each(step, T_map_world * motion_(core::to_s(sweep.end)), sweep.end);
      const SE3 T_align = step.T_map_body_end * motion_(core::to_s(sweep.end)).inverse();
      for (int i = 0; i < 10; ++i) {
        const core::Time t = sweep.begin + core::Duration(i * 10'000'000);
        const Eigen::Vector3d p(8, 0, 0);
        sum += (step.motion.pose(t) * p - T_align * motion_(core::to_s(t)) * p).squaredNorm();
        ++count;
      }
      outcome.end_error_m =
          (T_map_world.inverse() * step.T_map_body_end * motion_(core::to_s(sweep.end)).inverse()).translation().norm();
    }
    outcome.deskew_rms_m = std::sqrt(sum / std::max(1, count));
    return outcome;
  }
  const core::Rig& rig() const { return rig_; }
  core::LidarSweep sweep_of(int k) const {
    const tests::Motion lidar = [&](double t_s) -> SE3 { return motion_(t_s) * rig_.lidars[0].T_body_lidar; };
    return tests::sweep_of(room_, k, lidar, {.rings = 24, .columns = columns_});
  }

 private:
  int columns_;
  tests::Room room_;
  core::Rig rig_ = tests::room_rig();
  tests::Motion motion_;
  std::vector<core::ImuSample> imu_;
};

Outcome outcome_of(const WindowOdometrySettings& settings, const Drive& drive) {
  WindowOdometry odometry(settings, drive.rig());
  return drive.run(odometry);
}

class EveryProfile : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Composed, EveryProfile, testing::ValuesIn(ComposedOptions::profiles()),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST_P(EveryProfile, FollowsADriveThroughARoom) {
  const Outcome outcome = outcome_of(composed_profile(GetParam()), Drive());
  EXPECT_EQ(outcome.lost, 0);
  const bool with_imu = GetParam().find("imu") != std::string::npos;
  // Without an IMU the first sweep starts it; with one, the first that begins a second of rest later.
  EXPECT_EQ(outcome.initialising, with_imu ? 10 : 0);
  EXPECT_EQ(outcome.ok, kComposedSweeps - outcome.initialising);
  // A rigid sweep is wrong by the motion within it, 0.1 to 0.2 m here, one with the last twist by how that changes; the
  // others are to see most of it.
  const bool blind = GetParam() == "rigid" || GetParam() == "constant-velocity";
  EXPECT_LT(outcome.end_error_m, blind ? 0.3 : 0.1);
  EXPECT_LT(outcome.deskew_rms_m, blind ? 0.5 : 0.1);
}

TEST(Composed, ModelsThatMoveWithinASweepDeskewBetterThanARigidOne) {
  const Drive drive;
  const double rigid = outcome_of(composed_profile("rigid"), drive).deskew_rms_m;
  for (const char* name : {"two-pose-slerp", "spline-50ms", "wnoa", "singer"})
    EXPECT_LT(outcome_of(composed_profile(name), drive).deskew_rms_m, 0.5 * rigid) << name;
}

TEST(Composed, TheImuHelpsWhereMotionChangesWithinASweep) {
  const Drive drive(1.5);
  const auto ratio = [&](const char* with, const char* without) {
    return outcome_of(composed_profile(with), drive).deskew_rms_m /
           outcome_of(composed_profile(without), drive).deskew_rms_m;
  };
  EXPECT_LT(ratio("spline-50ms-imu", "spline-50ms"), 1);
  EXPECT_LT(ratio("singer-imu", "singer"), 1);
}

TEST(Composed, FindsTheTimeOffsetOfTheImu) {
  const Drive drive(1.5, 0.008);
  const ComposedOptions options = composed_profile("spline-25ms-imu-offset");
  WindowOdometry odometry(options, drive.rig());
  drive.run(odometry);
  const double offset_s = odometry.window().state().imu_offset_s;
  const Eigen::MatrixXd covariance = odometry.window().border_covariance();
  ASSERT_GT(covariance.rows(), 0);
  const int column = odometry.window().offset_column();
  const double sigma_s = std::sqrt(covariance(column, column));
  // Two seconds of a small room: what its own deviation says, and no worse than a millisecond.
  EXPECT_NEAR(offset_s, 0.008, 1e-3);
  EXPECT_LT(std::abs(offset_s - 0.008), 3 * sigma_s);
  EXPECT_EQ(offset_message(odometry.window()).find("unobservable"), std::string::npos);
}

/// At rest nothing tells when the IMU was read.
TEST(Composed, SaysThatAnOffsetIsUnobservable) {
  const Drive drive(0);
  WindowOdometry odometry(composed_profile("spline-25ms-imu-offset"), drive.rig());
  drive.run(odometry);
  EXPECT_EQ(offset_message(odometry.window()).find("IMU time offset unobservable"), 0u)
      << offset_message(odometry.window());
}

TEST(Composed, WorksOnDistributions) {
  ComposedOptions options = composed_profile("wnoa");
  options.lidar.residual = "point-to-distribution";
  options.map.kind = "distributions";
  options.map.max_points_per_voxel = 200;
  // A distribution needs some points in its voxel.
  const Outcome outcome = outcome_of(options, Drive(1, 0, 512));
  EXPECT_EQ(outcome.lost, 0);
  EXPECT_LT(outcome.end_error_m, 0.1);
}

TEST(Composed, RulesOfMarginalisationAllFollowAnEasyDriveAndHoldingIsAnotherThing) {
  const auto end_of = [](const char* rule) {
    ComposedOptions options = composed_profile("spline-50ms-imu");
    options.window.marginalisation = rule;
    const Drive drive;
    WindowOdometry odometry(options, drive.rig());
    const Outcome outcome = drive.run(odometry);
    EXPECT_EQ(outcome.lost, 0) << rule;
    EXPECT_LT(outcome.end_error_m, 0.1) << rule;
    return odometry.window().trajectory().pose(odometry.window().trajectory().end() - core::Duration(50'000'000));
  };
  const SE3 plain = end_of("plain"), without_weakest = end_of("eigenvalue"), held = end_of("fix");
  const auto apart = [](const SE3& a, const SE3& b) { return core::se3::log(a.inverse() * b).norm(); };
  EXPECT_LT(apart(plain, without_weakest), 1e-3) << "a share of 1e-8 of the largest eigenvalue says little";
  EXPECT_GT(apart(plain, held), 1e-5);
}

/// At 20 Hz there is a knot every 50 ms.
TEST(Composed, KnotsPerSweepFollowTheRateOfSweeps) {
  const Drive drive;
  WindowOdometry odometry(composed_profile("spline-per-sweep"), drive.rig());
  core::Time end;
  for (int k = 0; k < 12; ++k) {
    core::LidarSweep sweep = drive.sweep_of(k);
    const core::Time first = sweep.begin;
    sweep.begin = first - core::Duration(k * 50'000'000LL);
    sweep.end = sweep.begin + (sweep.end - first) / 2;
    for (std::int32_t& t_ns : sweep.t_ns) t_ns /= 2;
    odometry.add(sweep);
    end = sweep.end;
  }
  const auto& spline = dynamic_cast<const core::SplineTrajectory&>(odometry.window().trajectory());
  const std::vector<core::Time>& knots = spline.knots();
  for (std::size_t i = knots.size() - 6; i + 1 < knots.size(); ++i)
    EXPECT_NEAR(core::to_s(knots[i + 1] - knots[i]), 0.05, 0.002) << i;
  EXPECT_LT(knots.back() - end, core::Duration(300'000'000));
}

TEST(Composed, ASweepWithoutPointsIsLostAndTheNextOneIsNot) {
  const Drive drive;
  WindowOdometry odometry(composed_profile("wnoa"), drive.rig());
  for (int k = 0; k < 12; ++k) {
    core::LidarSweep sweep = drive.sweep_of(k);
    if (k == 8) {
      const core::Time begin = sweep.begin, end = sweep.end;
      sweep = {};
      sweep.index = k;
      sweep.begin = begin;
      sweep.end = end;
    }
    const WindowOdometry::Step step = odometry.add(sweep);
    EXPECT_EQ(step.lost, k == 8) << k;
    EXPECT_TRUE(core::se3::all_finite(step.T_map_body_end));
  }
}

TEST(Composed, RecordsWhatItSolved) {
  const Drive drive;
  WindowOdometry odometry(composed_profile("wnoa"), drive.rig());
  WindowOdometry::Step step;
  core::LidarSweep sweep;
  for (int k = 0; k < 10; ++k) {
    sweep = drive.sweep_of(k);
    step = odometry.add(sweep);
  }
  const core::SweepDiagnostics record = record_of(sweep, odometry, step, core::DiagnosticsLevel::full);
  EXPECT_EQ(record.residuals, step.residuals);
  EXPECT_EQ(record.rows.size(), static_cast<std::size_t>(step.residuals));
  EXPECT_TRUE(record.rows_are_surface);
  // Every direction is seen in a room, and the window knows something without this sweep's points too.
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<core::Matrix6>(record.H_data).eigenvalues()[0], 1);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<core::Matrix6>(record.H_prior).eigenvalues()[0], 0);
  EXPECT_EQ(record.covariance, odometry.window().covariance(sweep.end, core::Derivative::pose));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<core::Matrix6>(record.covariance).eigenvalues()[0], 0);
}

// How far the poses are off in terms of the window's own covariance: reported, without a bound. No covariance knows of
// the map's errors; in this room the residuals' 5 cm, meant for scenes, are far more than what points are off.
TEST(Composed, ReportsHowConsistentItIsWithAMapOfItsOwn) {
  const Drive drive(1, 0, 256);
  for (const char* name : {"two-pose-slerp", "spline-100ms", "wnoa", "singer", "spline-50ms-imu", "singer-imu"}) {
    WindowOdometry odometry(composed_profile(name), drive.rig());
    double nees = 0;
    int sweeps = 0, covered = 0;
    drive.run(odometry, [&](const WindowOdometry::Step& step, const SE3& T_map_body_true, core::Time end) {
      const Eigen::MatrixXd covariance = odometry.window().covariance(end, core::Derivative::pose);
      if (step.first || covariance.rows() != 6) return;
      const core::Vector6 error = core::se3::log(T_map_body_true.inverse() * step.T_map_body_end);
      const double e = error.dot(core::Matrix6(covariance).ldlt().solve(error));
      nees += e;
      covered += e < 12.592;  // 95 % of chi-squared with 6 degrees of freedom
      ++sweeps;
    });
    ASSERT_GT(sweeps, 10) << name;
    EXPECT_TRUE(std::isfinite(nees) && nees > 0) << name;
    std::printf("%-16s ANEES/6 %.2f, 95 %% ellipsoids cover %.2f of %d sweeps\n", name, nees / sweeps / 6,
                static_cast<double>(covered) / sweeps, sweeps);
  }
}

TEST(Composed, AHoleOfThreeSweepsEndsWithAWayBack) {
  for (const char* name : {"rigid", "two-pose-slerp", "spline-50ms", "spline-50ms-imu", "wnoa", "singer-imu"}) {
    const Drive drive(0.3);
    WindowOdometry odometry(composed_profile(name), drive.rig());
    const Outcome outcome = drive.run(odometry, {}, {20, 21, 22});
    EXPECT_LT(outcome.end_error_m, 0.15) << name;
  }
}

TEST(Composed, WaitsForASweepThatCanStartAMap) {
  const Drive drive;
  WindowOdometry odometry(composed_profile("wnoa"), drive.rig());
  core::LidarSweep thin = drive.sweep_of(0);
  for (auto* column : {&thin.x_m, &thin.y_m, &thin.z_m, &thin.intensity}) column->resize(20);
  thin.t_ns.resize(20);
  thin.ring.resize(20);
  EXPECT_FALSE(odometry.add(thin).started);
  core::LidarSweep instant = drive.sweep_of(1);
  instant.end = instant.begin;
  EXPECT_FALSE(odometry.add(instant).started);
  EXPECT_TRUE(odometry.add(drive.sweep_of(2)).started);
  EXPECT_FALSE(odometry.add(drive.sweep_of(3)).lost);
}

struct Contradiction {
  const char* yaml;
  const char* names;
};
class ComposedRefuses : public testing::TestWithParam<Contradiction> {};
INSTANTIATE_TEST_SUITE_P(
    Contradictions, ComposedRefuses,
    testing::Values(Contradiction{"{profile: rigid, imu: {use: gyro}}", "imu.use"},
                    Contradiction{"{profile: rigid, window: {sweeps: 3}}", "window.sweeps"},
                    Contradiction{"{profile: two-pose-slerp, imu: {use: gyro-accel}}", "imu.use"},
                    Contradiction{"{profile: wnoa-imu, imu: {accel_as_increments: false}}", "accel_as_increments"},
                    Contradiction{"{profile: wnoa, motion: {knots: imu-excitation}}", "motion.knots"},
                    Contradiction{"{profile: spline-50ms, motion: {knots: imu-excitation}}", "motion.knots"},
                    Contradiction{"{profile: rigid, motion: {knots: uniform}}", "motion.knots"},
                    Contradiction{"{profile: two-pose-slerp-imu, imu: {omit_transport: true}}", "imu.omit_transport"},
                    Contradiction{"{profile: two-pose-slerp-imu, imu: {accel_as_increments: true}}", "imu.accel_as"},
                    Contradiction{"{lidar: {sum_stamp_residuals: true}}", "lidar.loss"},
                    Contradiction{"{lidar: {sum_stamp_residuals: true, residual: point-to-distribution}, "
                                  "map: {kind: distributions}}",
                                  "lidar.sum_stamp_residuals"},
                    Contradiction{"{map: {kind: distributions}}", "map.kind"},
                    Contradiction{"{map: {delay_sweeps: 2}, window: {sweeps: 2}}", "map.delay_sweeps"},
                    Contradiction{"{lidar: {min_neighbours: 30}}", "lidar.min_neighbours"},
                    Contradiction{"{sampling: {min_range_m: 200}}", "sampling.min_range_m"},
                    Contradiction{"{imu: {use: auto}}", "imu.use"},
                    Contradiction{"{imu: {free_time_offset: true}}", "imu.free_time_offset"}));

TEST_P(ComposedRefuses, SettingsThatContradictEachOther) {
  ComposedOptions options;
  core::ConfigNode::parse(GetParam().yaml, "test.yaml").read(options);
  try {
    WindowOdometry odometry(options, tests::room_rig());
    FAIL() << "was taken: " << GetParam().yaml;
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().names), std::string::npos) << error.what();
  }
}

TEST(SteamLo, FollowsADriveWithAMapThatIsOneSweepBehind) {
  const Drive drive;
  SteamLoOptions options;
  options.set_profile("newer-college");
  WindowOdometry odometry(options, drive.rig());
  EXPECT_EQ(options.map.delay_sweeps, 1);
  const Outcome outcome = drive.run(odometry);
  EXPECT_EQ(outcome.lost, 0);
  EXPECT_LT(outcome.end_error_m, 0.15);
}

/// The first sweep sees half of the room. It is the map of the second and, one sweep behind, of the third too.
TEST(SteamLo, ASweepEntersTheMapOneSweepLater) {
  const Drive drive;
  const auto matched = [&](int delay_sweeps) {
    SteamLoOptions options;
    options.set_profile("newer-college");
    options.map.delay_sweeps = delay_sweeps;
    WindowOdometry odometry(options, drive.rig());
    std::vector<int> residuals;
    for (int k = 0; k < 4; ++k) {
      core::LidarSweep sweep = drive.sweep_of(k);
      if (k == 0)
        for (std::size_t i = 0; i < sweep.size(); ++i)
          if (sweep.y_m[i] < 0) sweep.x_m[i] = sweep.y_m[i] = sweep.z_m[i] = 0;  // below the least range
      residuals.push_back(odometry.add(sweep).residuals);
    }
    return residuals;
  };
  const std::vector<int> behind = matched(1), at_once = matched(0);
  EXPECT_GT(behind[1], 100);
  EXPECT_EQ(behind[1], at_once[1]);
  EXPECT_LT(behind[2], 1.2 * behind[1]);
  EXPECT_GT(behind[3], 1.5 * behind[1]);
  EXPECT_GT(at_once[2], 1.5 * at_once[1]);
}

/// A sweep that is lost does not keep the one before it out of the map.
TEST(SteamLo, ALostSweepCostsTheMapNothingButItself) {
  const Drive drive;
  SteamLoOptions options;
  options.set_profile("newer-college");
  WindowOdometry odometry(options, drive.rig());
  int before = 0, after = 0;
  for (int k = 0; k < 4; ++k) {
    core::LidarSweep sweep = drive.sweep_of(k);
    // The first sees half of the room, the second all of it, the third nothing.
    for (std::size_t i = 0; i < sweep.size(); ++i)
      if ((k == 0 && sweep.y_m[i] < 0) || k == 2) sweep.x_m[i] = sweep.y_m[i] = sweep.z_m[i] = 0;
    const WindowOdometry::Step step = odometry.add(sweep);
    EXPECT_EQ(step.lost, k == 2) << k;
    if (k == 1) before = step.residuals;
    if (k == 3) after = step.residuals;
  }
  EXPECT_GT(after, 1.5 * before) << "the second sweep is in the map";
}

TEST(SteamLio, UsesTheImuInEveryProfile) {
  for (const char* name : {"boreas", "newer-college", "newer-college-singer"}) {
    SteamLioOptions options;
    options.set_profile(name);
    if (std::string(name) == "boreas") {  // a car's sampling leaves too little of a room
      SteamLioOptions handheld;
      handheld.set_profile("newer-college");
      options.sampling = handheld.sampling;
      options.lidar.min_neighbours = 10;
    }
    const Outcome outcome = outcome_of(options, Drive());
    EXPECT_EQ(outcome.lost, 0) << name;
    EXPECT_EQ(outcome.initialising, 10) << name;
    EXPECT_LT(outcome.end_error_m, 0.15) << name;
  }
}

}  // namespace
}  // namespace tarmac::estimators
