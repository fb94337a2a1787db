#include "metrics/foreign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;

std::vector<StampedPose> samples(const Trajectory& motion, double from_s, double to_s, double step_s) {
  std::vector<StampedPose> poses;
  for (int k = 0; from_s + k * step_s <= to_s + 1e-9; ++k) {
    const Time t = time_from_s(from_s + k * step_s);
    poses.emplace_back(t, motion.pose(t));
  }
  return poses;
}

ConstantTwist circle() {
  Vector6 xi;
  xi << 5, 0.2, 0.1, 0.02, -0.05, 0.6;
  return {pose({40, -20, 3}, {0.1, 0.2, 0.6}), xi, Time{}, time_from_s(30)};
}

double value(const ForeignEvaluation& e, const std::string& metric) {
  for (const Row& row : e.rows)
    if (row.metric == metric) return row.value.value_or(std::nan(""));
  return std::nan("");
}

/// Truth and estimate are sampled at times that never meet. On a constant twist SE(3) interpolation is exact, while the
/// nearest neighbour would be up to 5 m/s x 50 ms = 25 cm off.
TEST(ForeignPoses, TheTruthIsInterpolatedNeverTakenFromTheNearestNeighbour) {
  const ConstantTwist motion = circle();
  const ForeignEvaluation e =
      evaluate_poses(samples(motion, 0, 20, 0.1), samples(motion, 1.037, 18, 0.1), ForeignSettings{});
  EXPECT_EQ(e.outside + e.in_gaps, 0u);
  for (const char* metric : {"ate_none_rmse_m", "ate_first_pose_rmse_m", "ate_se3_rmse_m", "ate_sim3_rmse_m",
                             "rpe_1sweep_trans_rmse_m", "rpe_10m_trans_rmse_m", "end_error_m"})
    EXPECT_LT(value(e, metric), 1e-9) << metric;
  EXPECT_NEAR(value(e, "path_length_m"), std::sqrt(25.05) * 16.9, 0.02);
}

/// The estimate in a frame of its own and 3 % too long: scale is what is left after SE(3), nothing after Sim(3).
TEST(ForeignPoses, AlignmentsAreAppliedAndOneCanBeAskedForAlone) {
  const ConstantTwist motion = circle();
  std::vector<StampedPose> estimate = samples(motion, 1.037, 18, 0.1);
  for (auto& [t, T] : estimate) {
    T = pose({9, 8, 7}, {1, 2, 0.5}) * T;
    T.translation() *= 1.03;
  }
  const std::vector<StampedPose> truth = samples(motion, 0, 20, 0.001);
  const ForeignEvaluation all = evaluate_poses(truth, estimate, ForeignSettings{});
  EXPECT_LT(value(all, "ate_sim3_rmse_m"), 1e-9);
  EXPECT_GT(value(all, "ate_se3_rmse_m"), 0.1);
  // Chords of the circle, 3 % longer.
  const double chord = (motion.pose(time_from_s(1)).inverse() * motion.pose(time_from_s(1.1))).translation().norm();
  EXPECT_NEAR(value(all, "rpe_1sweep_trans_rmse_m"), 0.03 * chord, 1e-6);
  const ForeignEvaluation one = evaluate_poses(truth, estimate, {.alignment = Alignment::sim3});
  EXPECT_FALSE(std::isnan(value(one, "ate_sim3_rmse_m")));
  EXPECT_TRUE(std::isnan(value(one, "ate_se3_rmse_m")));
  EXPECT_FALSE(std::isnan(value(one, "rpe_1sweep_trans_rmse_m")));
}

TEST(ForeignPoses, StampsOutsideTheTruthAndInItsGapsAreLeftOutAndCounted) {
  const ConstantTwist motion = circle();
  std::vector<StampedPose> truth = samples(motion, 5, 15, 0.01);
  std::erase_if(truth, [](const StampedPose& p) { return to_s(p.first) > 8.001 && to_s(p.first) < 9.999; });
  // 0.05, 0.15 ... 19.95: 50 before 5 s, 50 after 15 s, 20 in the gap from 8 to 10 s.
  const ForeignEvaluation e =
      evaluate_poses(truth, samples(motion, 0.05, 19.96, 0.1), {.max_gap = Duration(500'000'000)});
  EXPECT_EQ(e.outside, 100u);
  EXPECT_EQ(e.in_gaps, 20u);
  EXPECT_EQ(e.associated, 80u);
  EXPECT_DOUBLE_EQ(value(e, "coverage_percent"), 40);
  EXPECT_LT(value(e, "ate_first_pose_rmse_m"), 1e-9);
  // Of 79 steps between associated poses one leads over the gap: it is no step of one pose.
  EXPECT_LT(value(e, "rpe_1sweep_trans_rmse_m"), 1e-9);
  const ForeignEvaluation bridged =
      evaluate_poses(truth, samples(motion, 0.05, 19.96, 0.1), {.max_gap = Duration(3'000'000'000)});
  EXPECT_EQ(bridged.in_gaps, 0u);
}

void expect_refused(const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate, const char* word) {
  try {
    evaluate_poses(truth, estimate, {});
    FAIL() << word;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

TEST(ForeignPoses, WhatCannotBeComparedIsRefusedWithAReason) {
  const ConstantTwist motion = circle();
  const std::vector<StampedPose> early = samples(motion, 0, 5, 0.1), late = samples(motion, 10, 15, 0.1);
  expect_refused(early, late, "clocks");
  expect_refused({}, late, "the truth has no poses");
  expect_refused(early, {}, "the estimate has no poses");
  std::vector<StampedPose> unsorted = early;
  std::swap(unsorted[3], unsorted[4]);
  expect_refused(early, unsorted, "ascending");
  std::vector<StampedPose> nan = early;
  nan[7].second.translation().x() = std::nan("");
  expect_refused(early, nan, "pose 8");
}

}  // namespace
}  // namespace tarmac::metrics::tests
