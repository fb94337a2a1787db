// KITTI's segments and drift by direction against closed forms.
#include "metrics/drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

constexpr double kPi = std::numbers::pi;
const SE3 kMapWorld = pose({120, -75, 11}, {0.3, -0.8, 2.3});

/// n poses, one a metre and a tenth of a second, along a heading; the estimate stretches the path by `scale` and turns
/// by `yaw_rad_per_m` about the vertical, seen from the first pose.
std::vector<PosePair> straight(int n, double heading_rad, double scale, double yaw_rad_per_m) {
  std::vector<PosePair> pairs;
  const SE3 start = pose({10, 20, 3}, {0, 0, heading_rad});
  for (int k = 0; k < n; ++k) {
    const SE3 moved = pose({static_cast<double>(k), 0, 0}, {0, 0, 0});
    const SE3 believed = pose({scale * k, 0, 0}, {0, 0, yaw_rad_per_m * k});
    pairs.push_back(
        {k, time_from_ns(k * 100'000'000LL), start * moved, kMapWorld * start * believed, static_cast<double>(k)});
  }
  return pairs;
}

/// A segment of nominally L metres ends at the first pose beyond L: L + 1 metres. It begins at every tenth pose, and
/// exists while its end does: k + L + 1 <= n - 1. (Along the x axis, where the metres add up without rounding.)
TEST(Kitti, AStretchedStraightHasItsScaleErrorPerSegment) {
  constexpr int kPoses = 951;
  constexpr double kScale = 1.01, kYaw = 1e-4;
  const KittiSegments kitti = kitti_segments(straight(kPoses, 0, kScale, 0));
  double sum = 0, segments = 0;
  for (int length = 100; length <= 800; length += 100) {
    const int count = (kPoses - 1 - length - 1) / 10 + 1;
    EXPECT_EQ(kitti.count[static_cast<std::size_t>(length / 100 - 1)], static_cast<std::size_t>(count)) << length;
    sum += count * 0.01 * (length + 1) / length;
    segments += count;
  }
  EXPECT_DOUBLE_EQ(kitti.path_m, kPoses - 1);
  EXPECT_EQ(kitti.segments(), static_cast<std::size_t>(segments));
  EXPECT_NEAR(kitti.trans_fraction, sum / segments, 1e-12);
  EXPECT_NEAR(kitti.rot_rad_per_m, 0, 1e-12);

  const KittiSegments turning = kitti_segments(straight(kPoses, 0, 1, kYaw));
  EXPECT_NEAR(turning.rot_rad_per_m, kYaw * (sum / segments) / 0.01, 1e-12);
}

TEST(Kitti, IsNotStatedOfAShortPath) {
  RowSet rows("causal");
  add_drift_rows(straight(200, 0, 1.01, 0), rows);  // 199 m
  rows.all_missing("no value");
  for (const Row& row : rows.rows()) {
    if (row.metric != "kitti_trans_percent" && row.metric != "kitti_rot_deg_per_100m") continue;
    EXPECT_FALSE(row.value);
    EXPECT_NE(row.status.find("199 m"), std::string::npos) << row.status;
  }
}

TEST(Kitti, SaysHowManySegmentsOfEachLengthThereAre) {
  RowSet rows("causal");
  add_drift_rows(straight(252, 0, 1.01, 0), rows);
  rows.all_missing("no value");
  for (const Row& row : rows.rows())
    if (row.metric == "kitti_trans_percent") {
      EXPECT_EQ(row.status, "ok: 100 m: 16, 200 m: 6");
    }
}

TEST(Kitti, OfNothingIsNothing) {
  EXPECT_EQ(kitti_segments({}).segments(), 0U);
  EXPECT_EQ(kitti_segments(straight(1, 0, 1, 0)).segments(), 0U);
}

/// Each direction alone: an error of e along the true heading, its left, or up; and turned about the vertical or not.
TEST(SplitError, NamesTheDirectionsByTheTrueHeading) {
  for (const double heading : {0.0, 0.6, -2.9, kPi}) {
    const SE3 T_world_body = pose({5, -7, 2}, {0.03, -0.05, heading});  // rolled and pitched a little
    const Eigen::Vector3d forward(std::cos(heading), std::sin(heading), 0), left(-forward.y(), forward.x(), 0);
    // Heading of a rolled and pitched body is that of its x axis laid onto the ground.
    const Eigen::Vector3d x = T_world_body.linear().col(0);
    const double real = std::atan2(x.y(), x.x());
    const Eigen::Vector3d along(std::cos(real), std::sin(real), 0), across(-along.y(), along.x(), 0);
    SE3 estimate = T_world_body;
    estimate.translation() += 0.3 * along - 0.2 * across + Eigen::Vector3d(0, 0, 0.1);
    estimate.linear() = so3::exp(Eigen::Vector3d(0, 0, 0.05)) * estimate.linear();
    const SE3 T_world_map = pose({1, 2, 3}, {0.4, 0.5, 0.6});
    const SplitError e = split_of_pose({0, {}, T_world_body, T_world_map.inverse() * estimate, 0}, T_world_map);
    EXPECT_NEAR(e.along_m, 0.3, 1e-12);
    EXPECT_NEAR(e.cross_m, -0.2, 1e-12);
    EXPECT_NEAR(e.height_m, 0.1, 1e-12);
    EXPECT_NEAR(e.yaw_rad, 0.05, 1e-12);
    EXPECT_NEAR(e.tilt_rad, 0, 1e-12);
  }
}

TEST(SplitError, TiltIsRollAndPitchTogether) {
  SE3 estimate = SE3::Identity();
  estimate.linear() = so3::exp(Eigen::Vector3d(0.003, -0.004, 0));
  const SplitError e = split_of_pose({0, {}, SE3::Identity(), estimate, 0}, SE3::Identity());
  EXPECT_NEAR(e.tilt_rad, 0.005, 1e-12);
  EXPECT_NEAR(e.yaw_rad, 0, 1e-12);
}

/// Over 50 m a scale error of 1 % is 0.5 m along and nothing else. A turn of w per metre, with straight steps seen from
/// the first pose: from pose k on the estimate moves 50 m along the start's axis, so in its own frame at k it has
/// turned by w k: an error across of 50 sin(w k), seen at the end.
TEST(Drift, OverFiftyMetresFallsIntoTheRightRows) {
  const auto value = [](const std::vector<PosePair>& pairs, const std::string& metric) {
    RowSet rows("causal");
    add_drift_rows(pairs, rows);
    rows.all_missing("no value");
    for (const Row& row : rows.rows())
      if (row.metric == metric) return row.value.value();
    return std::nan("");
  };
  const std::vector<PosePair> stretched = straight(300, -1.1, 1.01, 0);
  EXPECT_NEAR(value(stretched, "drift_50m_along_rms_m"), 0.5, 1e-9);
  EXPECT_NEAR(value(stretched, "drift_50m_cross_rms_m"), 0, 1e-9);
  EXPECT_NEAR(value(stretched, "drift_50m_height_rms_m"), 0, 1e-9);
  EXPECT_NEAR(value(stretched, "drift_50m_yaw_rms_deg"), 0, 1e-9);
  constexpr double kYaw = 1e-4;
  const std::vector<PosePair> turned = straight(300, -1.1, 1, kYaw);
  EXPECT_NEAR(value(turned, "drift_50m_yaw_rms_deg"), 50 * kYaw * 180 / kPi, 1e-9);
  EXPECT_NEAR(value(turned, "drift_50m_tilt_rms_deg"), 0, 1e-9);
  double squares = 0;
  for (int k = 0; k + 50 < 300; ++k) squares += std::pow(50 * std::sin(kYaw * k), 2);
  EXPECT_NEAR(value(turned, "drift_50m_cross_rms_m"), std::sqrt(squares / 250), 1e-9);
}

TEST(Drift, SeriesGoOverDistanceAndDurationAndEndWhereNoStretchFits) {
  const std::vector<PosePair> pairs = straight(101, 0.4, 1.02, 0);  // 100 m, 10 s
  std::vector<Series> series;
  add_drift_series(pairs, pairs.front().t, series);
  const auto find = [&](const std::string& name) -> const Series& {
    for (const Series& s : series)
      if (s.name == name) return s;
    throw std::runtime_error(name);
  };
  const Series& by_distance = find("drift_along_vs_distance");
  EXPECT_EQ(by_distance.x, (std::vector<double>{1, 2, 3, 5, 7, 10, 20, 30, 50, 70, 100}));
  for (std::size_t i = 0; i < by_distance.x.size(); ++i) EXPECT_NEAR(by_distance.y[i], 0.02 * by_distance.x[i], 1e-9);
  const Series& by_duration = find("drift_along_vs_duration");
  EXPECT_EQ(by_duration.x, (std::vector<double>{1, 2, 3, 5, 7, 10}));
  for (std::size_t i = 0; i < by_duration.x.size(); ++i) EXPECT_NEAR(by_duration.y[i], 0.2 * by_duration.x[i], 1e-9);
  const Series& signed_error = find("error_along_vs_time");
  EXPECT_NEAR(signed_error.y.back(), 2.0, 1e-9);
  EXPECT_NEAR(signed_error.x.back(), 10.0, 1e-9);
}

}  // namespace
}  // namespace tarmac::metrics::tests
