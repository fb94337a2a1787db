#include <gtest/gtest.h>

#include <cmath>

#include "core/lie.h"
#include "estimators/kiss_icp/adaptive_threshold.h"

namespace tarmac::estimators {
namespace {

using core::SE3;

SE3 moved(double x_m) {
  SE3 T = SE3::Identity();
  T.translation().x() = x_m;
  return T;
}

TEST(AdaptiveThreshold, HundredDeviationsOfHalfAMetreGiveTheRootMeanSquareWithTheInitialValue) {
  AdaptiveThreshold threshold(2.0, 0.1, 100);
  EXPECT_DOUBLE_EQ(threshold.sigma_m(), 2.0);
  for (int k = 0; k < 100; ++k) threshold.update(moved(0.5));
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt((2.0 * 2.0 + 100 * 0.5 * 0.5) / 101), 1e-12);
  EXPECT_NEAR(threshold.sigma_m(), 0.536, 0.001);  // the publication's sheet, computed independently
}

TEST(AdaptiveThreshold, DeviationsUpToTheMinimumMotionLeaveItUntouched) {
  AdaptiveThreshold threshold(2.0, 0.1, 100);
  for (int k = 0; k < 100; ++k) threshold.update(moved(0.1));
  EXPECT_EQ(threshold.sigma_m(), 2.0);
  threshold.update(moved(0.1000001));
  EXPECT_LT(threshold.sigma_m(), 2.0);
}

TEST(AdaptiveThreshold, ARotationCountsAsTheChordAtMaximumRange) {
  AdaptiveThreshold threshold(2.0, 0.1, 100);
  SE3 M = moved(0.3);
  M.linear() = core::so3::exp(Eigen::Vector3d(0, 0.02, 0));
  threshold.update(M);
  // A point 100 m away moves along a chord of 2 * 100 * sin(0.01).
  EXPECT_NEAR(threshold.last_deviation_m(), 0.3 + 200 * std::sin(0.01), 1e-9);
}

TEST(AdaptiveThreshold, ATenthOfADegreeAloneIsEnoughToCount) {
  AdaptiveThreshold threshold(2.0, 0.1, 100);
  SE3 M = SE3::Identity();
  M.linear() = core::so3::exp(Eigen::Vector3d(0.1 * M_PI / 180, 0, 0));
  threshold.update(M);
  EXPECT_LT(threshold.sigma_m(), 2.0);
}

}  // namespace
}  // namespace tarmac::estimators
