#include "sim/truth/road.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/numeric_jet.h"

namespace tarmac::sim::truth {
namespace {

using tests::derivative_of;

TEST(Road, DerivativesMatchDifferencesAlsoInsideJoints) {
  const Road road(RoadOptions{}, 3.0, 1.6, 1);
  for (const double s : {0.0, 0.31, 2.95, 3.02, 60.07, 123.4, 284.96, 285.03}) {
    for (int m = 0; m < 3; ++m) {
      const auto f = [&](double x) { return road.at(x)[m].f; };
      const auto d1 = [&](double x) { return road.at(x)[m].d1; };
      EXPECT_NEAR(road.at(s)[m].d1, derivative_of(f, s, 1e-4), 1e-9) << s << ", mode " << m;
      EXPECT_NEAR(road.at(s)[m].d2, derivative_of(d1, s, 1e-4), 1e-6) << s << ", mode " << m;
    }
  }
}

/// Spectral power of the heave at low wave numbers, where all four wheels move alike: the variance of each class is the
/// integral of G(n) over the band, G(0.1) 0.01 (1/n_min - 1/n_max); two classes on, 16 times more.
TEST(Road, HasTheVarianceOfItsClass) {
  RoadOptions options;
  options.joint_spacing_m = 0;
  options.waves = 400;
  const auto variance = [&](const char* roughness) {
    options.roughness = roughness;
    const Road road(options, 0.21, 0.21, 7);
    constexpr int n = 20000;
    double sum = 0, sum2 = 0;
    for (int k = 0; k < n; ++k) {
      const double z = road.at(k * 3.7)[heave].f;
      sum += z;
      sum2 += z * z;
    }
    return sum2 / n - sum / n * sum / n;
  };
  const double a = variance("A");
  EXPECT_NEAR(a / (16e-6 * 0.01 * (1 / 0.01 - 1 / 10.0)), 1, 0.06);
  EXPECT_NEAR(variance("C") / a, 16, 1e-6);
}

TEST(Road, RearAxleMeetsWhatTheFrontAxleMet) {
  RoadOptions options;
  options.roughness = "none";
  const Road road(options, 3.0, 1.6, 1);
  // Joints every 6 m, first at 3 m: at s = 0 the front axle stands in one, at s = 3 the rear axle.
  EXPECT_DOUBLE_EQ(road.at(0)[heave].f, -options.joint_depth_m / 2);
  EXPECT_DOUBLE_EQ(road.at(3)[heave].f, -options.joint_depth_m / 2);
  EXPECT_DOUBLE_EQ(road.at(0)[pitch].f, options.joint_depth_m / 3.0) << "front axle down is nose down is positive";
  EXPECT_DOUBLE_EQ(road.at(3)[pitch].f, -options.joint_depth_m / 3.0);
  EXPECT_EQ(road.at(1.5)[heave].f, 0);
}

TEST(Road, RoughnessUnderTheRearAxleIsWhatTheFrontAxleMetAWheelbaseBefore) {
  // Nose down is positive: front = heave - pitch L / 2, rear = heave + pitch L / 2.
  constexpr double L = 2.7;
  const Road road(RoadOptions{}, L, 1.6, 1);
  for (double s = 0; s < 100; s += 0.37) {
    const auto here = road.at(s), later = road.at(s + L);
    ASSERT_NEAR(here[heave].f - here[pitch].f * L / 2, later[heave].f + later[pitch].f * L / 2, 1e-13) << s;
  }
}

TEST(Road, AnotherSeedIsAnotherRoad) {
  EXPECT_EQ(Road(RoadOptions{}, 3, 1.6, 1).at(10)[roll].f, Road(RoadOptions{}, 3, 1.6, 1).at(10)[roll].f);
  EXPECT_NE(Road(RoadOptions{}, 3, 1.6, 1).at(10)[roll].f, Road(RoadOptions{}, 3, 1.6, 2).at(10)[roll].f);
}

}  // namespace
}  // namespace tarmac::sim::truth
