#include "scenes/paths/smooth_step.h"

#include <gtest/gtest.h>

#include <vector>

#include "scenes/paths/quadrature.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::scenes {
namespace {

using tests::derivative_of;

TEST(SmoothStep, DerivativesMatchDifferencesAlsoNearItsEnds) {
  const auto f = [](double u) { return smooth_step(u).f; };
  const auto d1 = [](double u) { return smooth_step(u).d1; };
  const auto d2 = [](double u) { return smooth_step(u).d2; };
  for (const double u : {0.02, 0.1, 0.3, 0.5, 0.61, 0.9, 0.97}) {
    const Jet h = smooth_step(u);
    EXPECT_NEAR(h.d1, derivative_of(f, u, 1e-3), 1e-7) << u;
    EXPECT_NEAR(h.d2, derivative_of(d1, u, 1e-3), 1e-5) << u;
    EXPECT_NEAR(h.d3, derivative_of(d2, u, 1e-3), 1e-3) << u;
  }
}

TEST(SmoothStep, IsExactlyConstantOutsideAndSteepestInTheMiddle) {
  for (const double u : {-1.0, 0.0, 1e-300, 1e-4}) EXPECT_EQ(smooth_step(u).f + smooth_step(u).d1, 0) << u;
  for (const double u : {1.0, 1.5, 1 - 1e-4}) {
    EXPECT_EQ(smooth_step(u).f, 1) << u;
    EXPECT_EQ(smooth_step(u).d1, 0) << u;
  }
  EXPECT_DOUBLE_EQ(smooth_step(0.5).d1, smooth_step_peak_slope);
  for (double u = 0.01; u < 1; u += 0.01) EXPECT_LE(smooth_step(u).d1, smooth_step_peak_slope) << u;
}

TEST(SmoothStep, IntegralMatchesAMuchFinerQuadrature) {
  const auto f = [](double u) { return smooth_step(u).f; };
  constexpr int parts = 5000;
  double sum = 0;
  for (int k = 0; k < parts; ++k) {
    sum += Gauss3::integrate(f, k / double{parts}, (k + 1) / double{parts});
    ASSERT_NEAR(smooth_step_integral((k + 1) / double{parts}), sum, 1e-14) << k;
  }
  double twice = 0;
  for (int k = 0; k < parts; ++k) {
    twice += Gauss3::integrate(smooth_step_integral, k / double{parts}, (k + 1) / double{parts});
    ASSERT_NEAR(smooth_step_second_integral((k + 1) / double{parts}), twice, 1e-14) << k;
  }
  EXPECT_EQ(smooth_step_second_integral(-0.5), 0);
  EXPECT_NEAR(smooth_step_second_integral(3), twice + (9 - 1) / 2.0 - (3 - 1) / 2.0, 1e-14);
  EXPECT_EQ(smooth_step_integral(-0.5), 0);
  EXPECT_EQ(smooth_step_integral(3), 2.5);
}

}  // namespace
}  // namespace tarmac::scenes
