// Acceptance: replayed truth gives every metric its floor, a known error its derived value.
#include "metrics/controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "metrics/registry.h"
#include "tests/metrics/fabricate.h"
#include "tests/metrics/known_answers.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

constexpr double kZero = 1e-6;  // what counts as nothing where nothing is derived

/// These drives are short, never brake and record no residuals: other families have tests of their own.
bool has_derived_value(const MetricEntry& metric) {
  const std::string family = metric.family, name = metric.name;
  const bool here = family == "coverage" || family == "trajectory" || family == "points";
  return here && name != "ate_none_rmse_m" && name != "deskew_error_braking_rms_m";
}

/// Quantiles come from a histogram whose bins are 0.05 % wide; the rest is exact but for the float32 of points (1e-7)
/// and the path's chords (1e-5 of its length on the circle).
double tolerance(const std::string& metric) {
  return metric == "point_error_p50_m" || metric == "point_error_p95_m" ? 1e-3 : 1e-4;
}

void expect_value(double value, double expected, double relative, const std::string& what) {
  if (expected < 1e-9)
    EXPECT_LT(std::abs(value), kZero) << what;
  else
    EXPECT_NEAR(value, expected, relative * expected) << what;
}

class KnownAnswers : public ::testing::TestWithParam<KnownAnswer (*)(TruthKind)> {
 protected:
  static void check(TruthKind kind) {
    const KnownAnswer answer = GetParam()(kind);
    // A map frame of its own, with z up: no metric may depend on it.
    const Estimate estimate = in_other_map(make_control(answer.drive.truth, answer.drive.source(), answer.error),
                                           pose({120, -75, 11}, {0, 0, 2.3}));
    const Evaluation evaluation = answer.drive.evaluate(estimate);
    EXPECT_EQ(evaluation.estimator, "truth-with-known-error");
    for (const MetricEntry& metric : metrics()) {
      if (!has_derived_value(metric)) continue;
      ASSERT_TRUE(answer.rows.contains(metric.name)) << metric.name << " has no derived value: add one";
      const Row* row = evaluation.row(metric.name);
      ASSERT_TRUE(row && row->value) << metric.name << (row ? ": " + row->status : "");
      expect_value(*row->value, answer.rows.at(metric.name), tolerance(metric.name), answer.name + ", " + metric.name);
    }
    for (const auto& [name, expected] : answer.phase) {
      const Series* series = evaluation.find(name);
      ASSERT_TRUE(series) << name;
      ASSERT_EQ(series->y.size(), expected.size()) << name;  // one column a bin
      for (std::size_t c = 0; c < expected.size(); ++c)
        expect_value(series->y[c], expected[c], 1e-4, answer.name + ", " + name + ", column " + std::to_string(c));
    }
  }
};

TEST_P(KnownAnswers, EveryMetricGivesItsDerivedValueOnAStraightLine) {
  check(TruthKind::straight);
}
TEST_P(KnownAnswers, EveryMetricGivesItsDerivedValueOnAConstantTwist) {
  check(TruthKind::circle);
}

std::string name_of_case(const ::testing::TestParamInfo<KnownAnswer (*)(TruthKind)>& info) {
  const char* const kNames[] = {"LeverArm", "YawRateError", "ShiftedSweep", "SpeedScale"};
  return kNames[info.index];
}
INSTANTIATE_TEST_SUITE_P(Controls, KnownAnswers,
                         ::testing::Values(&lever_arm, &yaw_rate_error, &shifted_sweep, &speed_scale), name_of_case);

/// A shifted sweep's derived values are mostly 0 or a single hit; see that the circle's are not nothing.
TEST(KnownAnswerTable, HoldsValuesThatAMetricCouldMiss) {
  const KnownAnswer answer = lever_arm(TruthKind::circle);
  EXPECT_GT(answer.rows.at("deskew_error_rms_m"), 0.01);
  EXPECT_GT(answer.rows.at("sweep_shear_rms_m"), 0.05);
  EXPECT_GT(answer.rows.at("point_error_se3_rms_m"), 0.05);
}

Drive long_wobbly_drive() {
  DriveShape shape{.sweeps = 60, .columns = 64, .column_spacing = Duration(1'500'000)};
  auto motion = std::make_shared<Wobbly>(Time{}, time_from_s(9));
  return make_drive(motion, shape, [&](int k) {
    std::vector<Target> targets =
        box(motion->pose(shape.end(k)).translation() + Eigen::Vector3d(40, 20, 2), {60, 50, 5});
    targets.push_back({targets.front().p_world + Eigen::Vector3d(1, 2, 0), true});
    return targets;
  });
}

TEST(TruthReplay, HasNoErrorInAnyMetricOnATruthOfNoEstimatorsClass) {
  const Drive drive = long_wobbly_drive();
  const Estimate replay = make_control(drive.truth, drive.source());
  EXPECT_EQ(replay.estimator, "truth-replay");
  const Evaluation evaluation = drive.evaluate(in_other_map(replay, pose({120, -75, 11}, {0, 0, 2.3})));
  EXPECT_EQ(evaluation.coverage, 1);
  // Asked for: points below 1 mm, ATE below 0.1 mm. Every error is rounding.
  for (const MetricEntry& metric : metrics()) {
    if (!has_derived_value(metric) || !metric.lower_is_better) continue;
    const Row* row = evaluation.row(metric.name);
    ASSERT_TRUE(row && row->value) << metric.name;
    EXPECT_LT(*row->value, 1e-10) << metric.name;
  }
  const Series* drift = evaluation.find("drift_cross_vs_duration");
  ASSERT_TRUE(drift && !drift->y.empty());
  for (const double y : drift->y) EXPECT_LT(y, 1e-10);
}

TEST(TruthReplay, StaysBelowAMicrometreBetweenItsSamples) {
  // Channels that fire 2.3 us apart: most stamps lie between the poses that the control keeps.
  Drive drive = long_wobbly_drive();
  const auto& motion = *drive.truth.motion;
  for (std::size_t k = 0; k < drive.sweeps.size(); ++k) {
    LidarSweep& sweep = drive.sweeps[k];
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const Eigen::Vector3d p_world = motion.pose(sweep.time(i)) * lidar_mount() * sweep.point(i);
      sweep.t_ns[i] =
          static_cast<std::int32_t>(drive.labels[k].t_ns[i] / 13 * 11 + static_cast<std::int64_t>(i) * 2304);
      drive.labels[k].t_ns[i] = sweep.t_ns[i];
      const Eigen::Vector3d p = (motion.pose(sweep.time(i)) * lidar_mount()).inverse() * p_world;
      sweep.x_m[i] = static_cast<float>(p.x());
      sweep.y_m[i] = static_cast<float>(p.y());
      sweep.z_m[i] = static_cast<float>(p.z());
    }
  }
  const Evaluation evaluation = drive.evaluate(make_control(drive.truth, drive.source()));
  EXPECT_LT(*evaluation.row("point_error_max_m")->value, 1e-6);
  EXPECT_GT(*evaluation.row("point_error_max_m")->value, 0);
}

TEST(TruthWithKnownError, RefusesAShiftOutOfTheTruthsSpan) {
  const Drive drive = long_wobbly_drive();
  KnownError error{.shifted_sweep = 59, .shift = duration_from_s(5)};
  EXPECT_THROW(make_control(drive.truth, drive.source(), error), InputError);
}

TEST(TruthReplay, LosesSweepsThatTheTruthDoesNotCover) {
  Drive drive = long_wobbly_drive();
  drive.truth.motion = std::make_shared<Wobbly>(drive.shape.begin(5), drive.shape.end(54));
  const Estimate replay = make_control(drive.truth, drive.source());
  EXPECT_EQ(replay.sweeps[4].status, SweepStatus::lost);
  EXPECT_EQ(replay.sweeps[5].status, SweepStatus::ok);
  EXPECT_EQ(replay.sweeps[55].status, SweepStatus::lost);
  EXPECT_DOUBLE_EQ(*drive.evaluate(replay).row("coverage_percent")->value, 100 * 50.0 / 60.0);
}

}  // namespace
}  // namespace tarmac::metrics::tests
