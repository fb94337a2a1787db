// Errors of points against closed forms and against a plain loop; gaps, jumps, boundaries, lost sweeps, moving points.
#include "metrics/point_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "metrics/controls.h"
#include "metrics/evaluate.h"
#include "metrics/firing_poses.h"
#include "metrics/pose_pairs.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

const SE3 kMapWorld = pose({120, -75, 11}, {0.3, -0.8, 2.3});

double value(const Evaluation& e, const std::string& metric, const std::string& estimate = "causal") {
  const Row* row = e.row(metric, estimate);
  return row && row->value ? *row->value : std::nan("");
}

std::shared_ptr<const ConstantTwist> straight(double speed_m_s) {
  Vector6 xi = Vector6::Zero();
  xi[0] = speed_m_s;
  return std::make_shared<ConstantTwist>(pose({40, -20, 3}, {0, 0, 0.6}), xi, Time{}, time_from_s(20));
}

/// One estimated pose held over each sweep, given by a function of the sweep.
Estimate held_estimate(const Drive& drive, const std::function<SE3(int)>& T_map_body) {
  Estimate estimate;
  estimate.estimator = "held";
  for (int k = 0; k < drive.shape.sweeps; ++k) {
    const DriveShape& s = drive.shape;
    estimate.causal.append(Segment::hold(s.begin(k), s.end(k), T_map_body(k)));
    estimate.sweeps.push_back({k, s.begin(k), s.end(k), s.end(k), SweepStatus::ok, T_map_body(k)});
  }
  return estimate;
}

Drive straight_drive(double speed, DriveShape shape = {.sweeps = 12}) {
  const auto motion = straight(speed);
  return make_drive(motion, shape, [=](int k) {
    std::vector<Target> targets = box(motion->pose(shape.end(k)).translation() + Eigen::Vector3d(3, 5, 1), {12, 7, 3});
    targets.push_back({targets.front().p_world + Eigen::Vector3d(1, 1, 1), true});
    return targets;
  });
}

/// Points and labels together in order of firing time, as recordings have them.
sim::truth::PointLabels sorted_by_time(LidarSweep& sweep, const sim::truth::PointLabels& labels) {
  std::vector<std::size_t> order(sweep.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return labels.t_ns[a] < labels.t_ns[b]; });
  const LidarSweep points = sweep;
  sim::truth::PointLabels sorted = labels;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    sweep.x_m[k] = points.x_m[i], sweep.y_m[k] = points.y_m[i], sweep.z_m[k] = points.z_m[i];
    sweep.t_ns[k] = points.t_ns[i], sweep.ring[k] = points.ring[i], sweep.intensity[k] = points.intensity[i];
    sorted.t_ns[k] = labels.t_ns[i], sorted.moving[k] = labels.moving[i], sorted.label[k] = labels.label[i];
    sorted.instance[k] = labels.instance[i], sorted.kind[k] = labels.kind[i];
  }
  return sorted;
}

/// A pose held over the sweep, true at its end: a point seen t before the end lies v t off. Columns are d apart, M of
/// them: RMS of v d j over j = 0..M-1 is v d sqrt((M-1)(2M-1)/6), and its spread about the mean, which is what a best
/// shift leaves, v d sqrt((M^2-1)/12). The motion from begin to end is missed whole.
TEST(PointError, OfAPoseHeldOverTheSweepIsItsMotion) {
  const double v = 8, d = 0.003, M = 32;
  const Drive drive = straight_drive(v);
  const Estimate estimate =
      held_estimate(drive, [&](int k) { return kMapWorld * drive.truth.motion->pose(drive.shape.end(k)); });
  const Evaluation e = drive.evaluate(estimate);
  EXPECT_NEAR(value(e, "point_error_rms_m"), v * d * std::sqrt((M - 1) * (2 * M - 1) / 6), 1e-6);
  EXPECT_NEAR(value(e, "deskew_error_rms_m"), v * d * std::sqrt((M * M - 1) / 12), 1e-6);
  EXPECT_NEAR(value(e, "sweep_shear_rms_m"), v * d * (M - 1), 1e-9);
  EXPECT_NEAR(value(e, "point_error_max_m"), v * d * (M - 1), 1e-6);
  EXPECT_LT(value(e, "ate_first_pose_rmse_m"), 1e-10);
  const Series* phase = e.find(kHeadlinePhaseSeries);
  ASSERT_TRUE(phase);
  for (std::size_t c = 0; c < 32; ++c) EXPECT_NEAR(phase->y[c], v * d * (31.0 - static_cast<double>(c)), 1e-6);
}

/// 2.9 cm per m/s at 10 Hz, as v T / sqrt(12) over a full sweep of many columns.
TEST(PointError, OfAHeldPoseFollowsTheRuleOfThumb) {
  const Drive drive = straight_drive(8, {.sweeps = 3, .columns = 1000, .column_spacing = Duration(100'000)});
  const Estimate estimate = held_estimate(drive, [&](int k) { return drive.truth.motion->pose(drive.shape.end(k)); });
  EXPECT_NEAR(value(drive.evaluate(estimate), "deskew_error_rms_m"), 8 * 0.1 / std::sqrt(12.0), 1e-4);
}

/// A jump of the map by J between sweeps moves each later point by |J|, bends no sweep, and counts in the step across.
TEST(PointError, JumpsBetweenSweepsBendNone) {
  const Drive drive = straight_drive(8);
  Estimate estimate = make_control(drive.truth, drive.source());
  std::vector<Segment> segments = estimate.causal.segments();
  const SE3 jump = pose({0.3, 0.4, 1.2}, Eigen::Vector3d::Zero());  // 1.3 m
  for (std::size_t k = 6; k < 12; ++k) {
    for (SE3& T : segments[k].poses) T = jump * T;
    estimate.sweeps[k].T_map_body = jump * estimate.sweeps[k].T_map_body;
  }
  estimate.causal = PiecewiseTrajectory(segments);
  const Evaluation e = drive.evaluate(in_other_map(estimate, kMapWorld));
  EXPECT_NEAR(value(e, "point_error_rms_m"), 1.3 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(value(e, "point_error_moving_rms_m"), 1.3 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(value(e, "rpe_1sweep_trans_rmse_m"), 1.3 / std::sqrt(11.0), 1e-9);
  EXPECT_LT(value(e, "deskew_error_rms_m"), 1e-9);
  EXPECT_LT(value(e, "sweep_shear_rms_m"), 1e-9);
}

/// Sweeps that touch: the last column of one is fired when the next begins. That point belongs to the later segment,
/// the sweep's own shear to the earlier.
TEST(PointError, ABoundaryInstantBelongsToTheLaterSegmentButNotForTheShear) {
  const DriveShape shape{.sweeps = 4, .columns = 11, .column_spacing = Duration(10'000'000)};
  ASSERT_EQ(shape.end(0), shape.begin(1));
  const Drive drive = straight_drive(0, shape);
  const Estimate estimate = held_estimate(drive, [&](int k) {  // sweep 0 true, the others 1, 2, 3 m off
    return pose({0, 0, 1.0 * k}, Eigen::Vector3d::Zero()) * drive.truth.motion->pose(shape.end(k));
  });
  const Evaluation e = drive.evaluate(estimate);
  // Of 11 columns each: 10 of sweep 0 at 0 m, its last at 1 m with 10 of sweep 1, and so on; all 11 of sweep 3 at 3 m
  // or its own last one, which has no later segment.
  const double sum = 10 * 0 + 11 * 1 + 11 * 4 + 12 * 9;
  EXPECT_NEAR(value(e, "point_error_rms_m"), std::sqrt(sum / 44), 1e-9);
  EXPECT_LT(value(e, "sweep_shear_rms_m"), 1e-12);
}

TEST(PointError, PointsInAGapOfTheEstimateAreLeftOutAndCounted) {
  const Drive drive = straight_drive(8);
  Estimate estimate = make_control(drive.truth, drive.source());
  std::vector<Segment> segments = estimate.causal.segments();
  // Sweep 5 keeps its second half only: columns 16 to 31 of 32.
  Segment& half = segments[5];
  half = Segment::sampled(SegmentModel::sampled_screw, {half.times.begin() + 16, half.times.end()},
                          {half.poses.begin() + 16, half.poses.end()});
  estimate.causal = PiecewiseTrajectory(segments);
  const Evaluation e = drive.evaluate(estimate);
  EXPECT_DOUBLE_EQ(value(e, "coverage_percent"), 100);
  EXPECT_DOUBLE_EQ(value(e, "point_coverage_percent"), 100 * 11.5 / 12);
  EXPECT_LT(value(e, "point_error_rms_m"), 1e-9);
}

/// A sweep that the method calls lost, initialising, empty or out of order is in no metric, however wrong.
TEST(PointError, SweepsThatAreNotOkAreScoredNowhere) {
  for (const SweepStatus status :
       {SweepStatus::lost, SweepStatus::initialising, SweepStatus::empty, SweepStatus::out_of_order}) {
    const Drive drive = straight_drive(8);
    Estimate estimate = make_control(drive.truth, drive.source());
    std::vector<Segment> segments = estimate.causal.segments();
    const SE3 wrong = pose({50, 0, 0}, {0, 0, 1});
    for (const std::size_t k : {std::size_t{0}, std::size_t{7}}) {  // the first too: alignment is by the first scored
      for (SE3& T : segments[k].poses) T = wrong * T;
      estimate.sweeps[k].T_map_body = wrong * estimate.sweeps[k].T_map_body;
      estimate.sweeps[k].status = status;
    }
    estimate.causal = PiecewiseTrajectory(segments);
    const Evaluation e = drive.evaluate(in_other_map(estimate, kMapWorld));
    EXPECT_DOUBLE_EQ(e.coverage, 10.0 / 12);
    EXPECT_DOUBLE_EQ(value(e, "point_coverage_percent"), 100 * 10.0 / 12);
    for (const char* metric : {"point_error_max_m", "point_error_moving_rms_m", "deskew_error_rms_m",
                               "sweep_shear_rms_m", "ate_first_pose_max_m", "rpe_1sweep_trans_rmse_m", "end_error_m"})
      EXPECT_LT(value(e, metric), 1e-9) << metric << " with status " << name_of(status);
    EXPECT_EQ(e.map.p_world_m.size(), 10u * 9 * 32);
    // Two gaps in the line of the path: one NaN between sweeps 6 and 8; sweep 0 leaves none before the first.
    EXPECT_EQ(e.find("path_estimate")->x.size(), 11u);
    EXPECT_TRUE(std::isnan(e.find("path_estimate")->x[6]));
  }
}

TEST(PointError, APoseThatIsNotFiniteIsNotScored) {
  const Drive drive = straight_drive(8);
  Estimate estimate = make_control(drive.truth, drive.source());
  estimate.sweeps[3].T_map_body.translation().x() = std::nan("");
  EXPECT_DOUBLE_EQ(drive.evaluate(estimate).coverage, 11.0 / 12);
}

/// Moving points do not pull at the sweep's fit, and static ones are not in the moving RMS: a wrong mount moves a point
/// p by (B^ - B) p, so give moving points another distance and see each kind's own value.
TEST(PointError, StaticAndMovingPointsAreApart) {
  Drive drive = straight_drive(8);
  const double angle = 0.01;
  drive.nominal.lidars[0].T_body_lidar = lidar_mount() * pose({0, 0, 0}, {0, 0, angle});
  double static_sum = 0, moving_sum = 0, n_static = 0, n_moving = 0;
  for (std::size_t k = 0; k < drive.sweeps.size(); ++k)
    for (std::size_t i = 0; i < drive.sweeps[k].size(); ++i) {
      const Eigen::Vector3d p = drive.sweeps[k].point(i);
      const double e = 2 * std::sin(angle / 2) * std::hypot(p.x(), p.y());
      (drive.labels[k].moving[i] ? moving_sum : static_sum) += e * e;
      ++(drive.labels[k].moving[i] ? n_moving : n_static);
    }
  const Evaluation e = drive.evaluate(make_control(drive.truth, drive.source()));
  EXPECT_NEAR(value(e, "point_error_rms_m"), std::sqrt(static_sum / n_static), 1e-9 * std::sqrt(static_sum / n_static));
  EXPECT_NEAR(value(e, "point_error_moving_rms_m"), std::sqrt(moving_sum / n_moving),
              1e-9 * std::sqrt(moving_sum / n_moving));
  EXPECT_GT(std::abs(static_sum / n_static / (moving_sum / n_moving) - 1), 0.1);
}

/// An injected clock fault: stamps of one sweep read 5 ms late. Both motions are asked at the true firing time, so an
/// estimate that replays the truth has no error.
TEST(PointError, ComparesAtTheTrueFiringTimeWhateverTheStampSays) {
  Drive drive = straight_drive(8);
  const Estimate replay = make_control(drive.truth, drive.source());
  for (std::int32_t& t_ns : drive.sweeps[4].t_ns) t_ns += 5'000'000;
  EXPECT_LT(value(drive.evaluate(replay), "point_error_max_m"), 1e-9);
}

TEST(PointError, PointsThatAreNotFiniteAreLeftOut) {
  Drive drive = straight_drive(8);
  drive.sweeps[2].x_m[5] = std::nanf("");
  drive.sweeps[2].y_m[6] = INFINITY;
  const Evaluation e = drive.evaluate(make_control(drive.truth, drive.source()));
  EXPECT_DOUBLE_EQ(value(e, "point_coverage_percent"), 100);
  EXPECT_LT(value(e, "point_error_max_m"), 1e-9);
}

/// A method that has gone wrong by an angle is off by that angle times the distance: ghosts far away would show it
/// most.
TEST(PointError, GhostsTheOwnVehicleAndNoiseAreInNoFigure) {
  using sim::truth::ReturnKind;
  const Drive plain = straight_drive(8);
  const auto with_stray_points = [&](ReturnKind kind) {
    Drive drive = plain;
    for (std::size_t k = 0; k < drive.sweeps.size(); ++k) {
      drive.labels[k].kind.assign(drive.sweeps[k].size(), ReturnKind::surface);
      for (int c = 0; c < drive.shape.columns; ++c) {
        const auto t_ns = static_cast<std::int32_t>((c * drive.shape.column_spacing).count());
        drive.sweeps[k].push_back(Eigen::Vector3f(90, 0, 0), t_ns, 0, 1);
        drive.labels[k].t_ns.push_back(t_ns);
        drive.labels[k].moving.push_back(0);
        drive.labels[k].label.push_back(scenes::Label::building);
        drive.labels[k].instance.push_back(0);
        drive.labels[k].kind.push_back(kind);
      }
      drive.labels[k] = sorted_by_time(drive.sweeps[k], drive.labels[k]);
    }
    return drive;
  };
  const auto rms_of = [&](const Drive& drive) {
    const Estimate estimate = held_estimate(drive, [&](int k) {
      return kMapWorld * drive.truth.motion->pose(drive.shape.end(k)) * pose({0, 0, 0}, {0, 0, 0.01 * k});
    });
    const Evaluation e = drive.evaluate(estimate);
    return std::pair(value(e, "point_error_rms_m"), value(e, "deskew_error_rms_m"));
  };
  const auto [point, deskew] = rms_of(plain);
  for (const ReturnKind kind : {ReturnKind::ghost, ReturnKind::self, ReturnKind::noise, ReturnKind::retro_halo}) {
    const auto [with_point, with_deskew] = rms_of(with_stray_points(kind));
    EXPECT_NEAR(with_point, point, 1e-12) << name_of(kind);
    EXPECT_NEAR(with_deskew, deskew, 1e-12) << name_of(kind);
  }
  for (const ReturnKind kind : {ReturnKind::mixed, ReturnKind::edge, ReturnKind::transmitted})
    EXPECT_GT(rms_of(with_stray_points(kind)).first, 1.01 * point) << name_of(kind);
}

TEST(PointError, LabelsOfAnotherRecordingAreRefused) {
  Drive drive = straight_drive(8);
  const Estimate replay = make_control(drive.truth, drive.source());
  drive.labels[3].t_ns.pop_back();
  EXPECT_THROW(drive.evaluate(replay), InputError);
  drive.labels.pop_back();
  EXPECT_THROW(drive.evaluate(replay), InputError);
}

/// All families against a plain loop in double over the same points, on a truth of no simple form, with a bent
/// estimate.
TEST(PointError, EqualsAPlainLoopOverPoints) {
  const DriveShape shape{.sweeps = 8, .columns = 40, .column_spacing = Duration(2'000'000)};
  const auto motion = std::make_shared<Wobbly>(Time{}, time_from_s(9));
  const Drive drive = make_drive(motion, shape, [&](int k) {
    return box(motion->pose(shape.end(k)).translation() + Eigen::Vector3d(4, 2, 1), {20, 9, 3});
  });
  const KnownError error{.C_right = pose({0.1, 0.2, 0.05}, {0.01, -0.02, 0.03}), .yaw_rate_error_rad_s = 0.05};
  const Estimate estimate = in_other_map(make_control(drive.truth, drive.source(), error), kMapWorld);
  const Evaluation e = drive.evaluate(estimate);

  const SE3 A = motion->pose(shape.end(0)) * estimate.sweeps[0].T_map_body.inverse();
  double sum = 0, largest = 0, bend_sum = 0, n = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    Eigen::Matrix3Xd x(3, drive.sweeps[k].size()), y = x;
    for (std::size_t i = 0; i < drive.sweeps[k].size(); ++i) {
      const Time t = drive.sweeps[k].time(i);
      const auto column = static_cast<Eigen::Index>(i);
      x.col(column) = A * (estimate.causal.pose(t) * (lidar_mount() * drive.sweeps[k].point(i)));
      y.col(column) = motion->pose(t) * (lidar_mount() * drive.sweeps[k].point(i));
    }
    sum += (x - y).squaredNorm();
    largest = std::max(largest, (x - y).colwise().norm().maxCoeff());
    // Eigen's own Umeyama as the second opinion.
    const Eigen::Matrix4d fit = Eigen::umeyama(x, y, false);
    bend_sum +=
        (((fit.topLeftCorner<3, 3>() * x).colwise() + Eigen::Vector3d(fit.topRightCorner<3, 1>())) - y).squaredNorm();
    n += static_cast<double>(x.cols());
  }
  EXPECT_NEAR(value(e, "point_error_rms_m"), std::sqrt(sum / n), 1e-9 * std::sqrt(sum / n));
  EXPECT_NEAR(value(e, "point_error_max_m"), largest, 1e-9 * largest);
  EXPECT_NEAR(value(e, "deskew_error_rms_m"), std::sqrt(bend_sum / n), 1e-9 * std::sqrt(bend_sum / n));
  EXPECT_GT(std::sqrt(bend_sum / n), 1e-3);
}

TEST(TruthPoses, ExpandedAboutAnchorsEqualExactQueries) {
  const Wobbly motion(Time{}, time_from_s(3));
  TruthPoses expanded(motion, TruthPoses::kExactQueries + 1);
  for (std::int64_t t_ns = 1'000'000'000; t_ns < 1'002'000'000; t_ns += 2304) {
    const SE3 T = motion.pose(time_from_ns(t_ns)), T_expanded = expanded.pose(time_from_ns(t_ns));
    EXPECT_LT((T.translation() - T_expanded.translation()).norm(), 1e-10);
    EXPECT_LT(so3::angle_rad(T.linear().transpose() * T_expanded.linear()), 1e-10);
  }
  EXPECT_LT((expanded.pose(motion.begin()).matrix() - motion.pose(motion.begin()).matrix()).norm(), 1e-10);
  EXPECT_LT((expanded.pose(motion.end()).matrix() - motion.pose(motion.end()).matrix()).norm(), 1e-10);
}

TEST(PoseFromBefore, TakesTheEarlierOfTwoTouchingSegmentsAndRespectsGaps) {
  const SE3 a = pose({1, 0, 0}, {0, 0, 0}), b = pose({2, 0, 0}, {0, 0, 0});
  const PiecewiseTrajectory motion(
      {Segment::hold(time_from_ns(0), time_from_ns(10), a), Segment::hold(time_from_ns(10), time_from_ns(20), b)});
  EXPECT_EQ(motion.pose(time_from_ns(10)).translation().x(), 2);
  EXPECT_EQ(pose_from_before(motion, time_from_ns(10))->translation().x(), 1);
  EXPECT_EQ(pose_from_before(motion, time_from_ns(0))->translation().x(), 1);
  EXPECT_EQ(pose_from_before(motion, time_from_ns(20))->translation().x(), 2);
  EXPECT_FALSE(pose_from_before(motion, time_from_ns(21)));
}

}  // namespace
}  // namespace tarmac::metrics::tests
