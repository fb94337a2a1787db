// ATE, RPE and drift against closed forms, with maps turned and shifted against the world.
#include "metrics/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

constexpr double kPi = std::numbers::pi;
const SE3 kMapWorld = pose({120, -75, 11}, {0.3, -0.8, 2.3});  // a map frame tilted and far
const SE3 kMapWorldLevel = pose({120, -75, 11}, {0, 0, 2.3});

/// A full circle of N poses, radius r; the estimate's radius is r (1 + a) and its heading turns along.
std::vector<PosePair> circles(int n, double r, double a, const SE3& T_map_world) {
  std::vector<PosePair> pairs;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * kPi * k / n;
    const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0), turn(0, 0, angle);
    pairs.push_back({k, time_from_ns(k * 100'000'000LL), pose(Eigen::Vector3d(10, 20, 3) + r * radial, turn),
                     T_map_world * pose(Eigen::Vector3d(10, 20, 3) + r * (1 + a) * radial, turn), 2 * kPi * r * k / n});
  }
  return pairs;
}

double ate(const std::vector<PosePair>& pairs, Alignment a, bool gravity_aligned) {
  double sum = 0;
  for (const double e : position_errors_m(pairs, align(pairs, a, gravity_aligned)->A)) sum += e * e;
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

void expect_relative(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected));
}

/// Concentric circles: the best rigid fit leaves a r everywhere, a scale nothing. First pose aligned: the estimate's
/// circle, moved inward by a r along the first radius e0, so the error is a r |e_k - e_0| = 2 a r sin(pi k / N); its
/// mean square over a full turn is 2 (a r)^2.
TEST(Ate, ConcentricCirclesGiveTheirClosedFormsInEveryAlignment) {
  const double r = 17, a = 0.03;
  const std::vector<PosePair> tilted = circles(40, r, a, kMapWorld), level = circles(40, r, a, kMapWorldLevel);
  expect_relative(ate(tilted, Alignment::se3, false), a * r);
  expect_relative(ate(tilted, Alignment::first_pose, false), a * r * std::sqrt(2.0));
  EXPECT_LT(ate(tilted, Alignment::sim3, false), 1e-11);
  expect_relative(ate(level, Alignment::yaw_pos, true), a * r);
  expect_relative(ate(tilted, Alignment::yaw_pos, false), a * r);  // levelled by the first pose
  EXPECT_GT(ate(tilted, Alignment::yaw_pos, true), 10 * a * r);    // and wrong if the map is believed level
}

/// No alignment: |(M - 1) p| for a pure shift is the shift.
TEST(Ate, NoneTakesTheMapAsTheWorld) {
  const std::vector<PosePair> pairs = circles(40, 17, 0, pose({3, 4, 12}, Eigen::Vector3d::Zero()));
  expect_relative(ate(pairs, Alignment::none, true), 13);
}

/// The estimate turns by an angle that grows by g a pose: error k g after the first pose, whatever the map.
TEST(Ate, RotationErrorIsTheAngleAfterFirstPoseAlignment) {
  std::vector<PosePair> pairs = circles(40, 17, 0, kMapWorld);
  const double g = 1e-10;  // far below what acos of a trace could tell from 0
  double sum = 0;
  for (int k = 0; k < 40; ++k) {
    pairs[static_cast<std::size_t>(k)].T_map_body.rotate(Eigen::AngleAxisd(k * g, Eigen::Vector3d(0, 1, 0)));
    sum += k * g * k * g;
  }
  double squares = 0;
  for (const double angle : rotation_errors_rad(pairs, {1, first_pose_alignment(pairs)})) squares += angle * angle;
  EXPECT_NEAR(std::sqrt(squares / 40), std::sqrt(sum / 40), 1e-4 * std::sqrt(sum / 40));
}

/// Bodies on the circle face along +angle: the motion k -> k+n has a chord 2 r sin(pi n / N), the estimate's is (1 + a)
/// times it: the error is a 2 r sin(pi n / N), without rotation.
TEST(Rpe, ConcentricCirclesGiveTheChordsDifference) {
  const double r = 17, a = 0.03;
  const std::vector<PosePair> pairs = circles(40, r, a, kMapWorld);
  for (const int n : {1, 10}) {
    const std::vector<RelativeError> errors = relative_over_sweeps(pairs, n);
    ASSERT_EQ(errors.size(), 40u - static_cast<std::size_t>(n));
    for (const RelativeError& e : errors) {
      expect_relative(e.trans_m, a * 2 * r * std::sin(kPi * n / 40));
      EXPECT_LT(e.rot_rad, 1e-12);
    }
  }
}

TEST(Rpe, AMissingSweepLeavesAHoleAndNeverALongerStep) {
  std::vector<PosePair> pairs = circles(40, 17, 0.03, kMapWorld);
  pairs.erase(pairs.begin() + 20);
  for (const RelativeError& e : relative_over_sweeps(pairs, 1)) EXPECT_EQ(pairs[e.to].index, pairs[e.from].index + 1);
  EXPECT_EQ(relative_over_sweeps(pairs, 1).size(), 37u);
  EXPECT_EQ(relative_over_sweeps(pairs, 10).size(), 28u);
  // A second later is 10 sweeps: those that would end or start at the hole have none within half a sweep.
  EXPECT_EQ(relative_over_time(pairs, Duration(1'000'000'000)).size(), 28u);
}

TEST(Rpe, OverTimeTakesTheNearestInstantWithinHalfASpacing) {
  std::vector<PosePair> pairs = circles(40, 17, 0.03, kMapWorld);
  for (const RelativeError& e : relative_over_time(pairs, Duration(1'040'000'000))) EXPECT_EQ(e.to - e.from, 10u);
  for (const RelativeError& e : relative_over_time(pairs, Duration(1'060'000'000))) EXPECT_EQ(e.to - e.from, 11u);
  EXPECT_TRUE(relative_over_time(pairs, Duration(60'000'000'000)).empty());
}

TEST(Rpe, OverDistanceTakesTheFirstPoseNotBefore) {
  const double r = 17, step = 2 * kPi * r / 40;  // 2.67 m: 10 m is reached by the 4th
  const std::vector<PosePair> pairs = circles(40, r, 0.03, kMapWorld);
  const std::vector<RelativeError> errors = relative_over_distance(pairs, 10);
  ASSERT_EQ(static_cast<int>(std::ceil(10 / step)), 4);
  ASSERT_EQ(errors.size(), 36u);
  for (const RelativeError& e : errors) EXPECT_EQ(e.to - e.from, 4u);
}

TEST(Rpe, HalfATurnOfErrorIsPi) {
  std::vector<PosePair> pairs = circles(2, 17, 0, kMapWorld);
  pairs[1].T_map_body.rotate(Eigen::AngleAxisd(kPi, Eigen::Vector3d(1, 0, 0)));
  EXPECT_NEAR(relative_over_sweeps(pairs, 1).front().rot_rad, kPi, 1e-12);
}

Row row_of(const std::vector<PosePair>& pairs, const std::string& metric) {
  RowSet rows("causal");
  add_trajectory_rows(pairs, {}, rows);
  for (const Row& row : rows.rows())
    if (row.metric == metric) return row;
  return {};
}

TEST(TrajectoryRows, SayWhenThePathLeavesARotationFree) {
  std::vector<PosePair> pairs;
  for (int k = 0; k < 30; ++k) {
    const SE3 T = pose({1.5 * k, 0.3 * k, 0}, {0, 0, 0.2});
    pairs.push_back({k, time_from_ns(k * 100'000'000LL), T, kMapWorld * T, 1.53 * k});
  }
  EXPECT_TRUE(row_of(pairs, "ate_se3_rmse_m").status.starts_with("ok: the positions lie on a line"));
  EXPECT_LT(*row_of(pairs, "ate_se3_rmse_m").value, 1e-11);
  EXPECT_EQ(row_of(pairs, "ate_first_pose_rmse_m").status, "ok");
  EXPECT_EQ(row_of(pairs, "ate_none_rmse_m").status, "n/a: the method is given no initial pose");
}

TEST(TrajectoryRows, AStandingVehicleHasNoEndErrorInPercentAndNoScale) {
  std::vector<PosePair> pairs;
  for (int k = 0; k < 30; ++k) pairs.push_back({k, time_from_ns(k * 100'000'000LL), kMapWorld, SE3::Identity(), 0});
  EXPECT_EQ(row_of(pairs, "end_error_percent").status, "n/a: the path is shorter than 1 m");
  EXPECT_TRUE(row_of(pairs, "ate_sim3_rmse_m").status.starts_with("n/a: "));
  EXPECT_EQ(row_of(pairs, "rpe_10m_trans_rmse_m").status, "n/a: no two scored sweeps are ten metres apart");
  EXPECT_LT(*row_of(pairs, "ate_se3_rmse_m").value, 1e-12);
}

/// A straight drive whose estimate is q times as long: every stretch of L steps of h has the error (q - 1) h ceil(L /
/// h).
TEST(Drift, GrowsWithTheLengthOfTheStretchAndEndsWhereNoneFits) {
  std::vector<PosePair> pairs;
  const double h = 0.4, q = 1.02;
  for (int k = 0; k <= 100; ++k)
    pairs.push_back({k, time_from_ns(k * 100'000'000LL), pose({h * k, 0, 0}, {0, 0, 0}),
                     kMapWorld * pose({q * h * k, 0, 0}, {0, 0, 0}), h * k});
  std::vector<Series> series;
  add_trajectory_series(pairs, Time{}, series);
  const Series& drift = series.back();
  ASSERT_EQ(drift.name, "drift_vs_distance");
  EXPECT_EQ(drift.x, (std::vector<double>{1, 2, 3, 5, 7, 10, 20, 30}));  // of 40 m
  EXPECT_NEAR(drift.y.front(), (q - 1) * 3 * h, 1e-9);                   // 1 m is reached by the third step
  EXPECT_NEAR(drift.y.back(), (q - 1) * 30, 0.02 * h);
  EXPECT_EQ(series[0].name, "error_vs_time");
  EXPECT_NEAR(series[0].y.back(), (q - 1) * 40, 1e-9);
  EXPECT_NEAR(series[1].x.back(), 40, 1e-9);
}

/// Chords of 10 ms on a circle fall short of the arc by (angle per chord)^2 / 24.
TEST(PathLength, IsTheArcToTheChordsPrecision) {
  Vector6 xi;
  xi << 5, 0, 0, 0, 0, 0.9;
  const ConstantTwist motion(kMapWorld, xi, Time{}, time_from_s(10));
  const double length = path_length_m(motion, time_from_s(1.003), time_from_s(9));
  EXPECT_NEAR(length, 5 * 7.997, 5 * 7.997 * (0.009 * 0.009 / 24) * 1.01);
  EXPECT_LT(length, 5 * 7.997);
  EXPECT_EQ(path_length_m(motion, time_from_s(2), time_from_s(2)), 0);
}

}  // namespace
}  // namespace tarmac::metrics::tests
