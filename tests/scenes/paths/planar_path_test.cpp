#include "scenes/paths/planar_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/paths/quadrature.h"
#include "tests/support/numeric_jet.h"

namespace tarmac::scenes {
namespace {

using tests::derivative_of;

const std::vector<PathPiece> corner{{.straight_m = 10},
                                    {.turn_deg = 90, .radius_m = 5.5, .blend_m = 4.5},
                                    {.straight_m = 6},
                                    {.turn_deg = -120, .radius_m = 8, .blend_m = 3}};

PlanarPath make_path(const StartOptions& start, const std::vector<PathPiece>& pieces, double wander_rms_m) {
  std::vector<PlanarPath::Problem> problems;
  const Waves wander(wander_rms_m, 22, 70, 3, core::RandomStream(1, "test/wander"));
  PlanarPath path(start, pieces, wander, problems);
  EXPECT_TRUE(problems.empty());
  path.tabulate(path.length_m() + 20);
  return path;
}

TEST(PlanarPath, PositionMatchesATenTimesFinerQuadrature) {
  const PlanarPath path = make_path({.x_m = -60, .y_m = -30, .heading_deg = 20}, corner, 0.06);
  const auto cosine = [&](double s) { return std::cos(path.heading(s).f); };
  const auto sine = [&](double s) { return std::sin(path.heading(s).f); };
  double x = -60, y = -30;
  for (int k = 0; k * 0.005 < path.length_m() + 19; ++k) {
    x += Gauss3::integrate(cosine, k * 0.005, (k + 1) * 0.005);
    y += Gauss3::integrate(sine, k * 0.005, (k + 1) * 0.005);
    const PlanarPath::Point p = path.at((k + 1) * 0.005);
    ASSERT_NEAR(p.x_m, x, 1e-12) << k;
    ASSERT_NEAR(p.y_m, y, 1e-12) << k;
  }
}

TEST(PlanarPath, HeadingDerivativesMatchDifferences) {
  const PlanarPath path = make_path({}, corner, 0.06);
  const auto psi = [&](double s) { return path.heading(s).f; };
  const auto d1 = [&](double s) { return path.heading(s).d1; };
  const auto d2 = [&](double s) { return path.heading(s).d2; };
  for (double s = 0.37; s < path.length_m(); s += 0.61) {
    const Jet heading = path.heading(s);
    EXPECT_NEAR(heading.d1, derivative_of(psi, s, 3e-3), 1e-9) << s;
    EXPECT_NEAR(heading.d2, derivative_of(d1, s, 3e-3), 1e-7) << s;
    EXPECT_NEAR(heading.d3, derivative_of(d2, s, 3e-3), 1e-5) << s;
  }
}

TEST(PlanarPath, TurnsTakeExactlyTheirAngleAndRadius) {
  const PlanarPath path = make_path({}, corner, 0);
  const double turn_m = std::numbers::pi / 2 * 5.5 + 4.5;
  EXPECT_EQ(path.heading(9.9).f, 0);
  EXPECT_NEAR(path.heading(10 + turn_m).f, std::numbers::pi / 2, 1e-14);
  EXPECT_NEAR(path.heading(10 + turn_m / 2).d1, 1 / 5.5, 1e-15);
  EXPECT_NEAR(path.heading(path.length_m() + 10).f, radians(90 - 120), 1e-14);
  EXPECT_EQ(path.heading(path.length_m() + 10).d1, 0);
  EXPECT_NEAR(path.length_m(), 10 + turn_m + 6 + radians(120) * 8 + 3, 1e-12);
}

TEST(PlanarPath, WanderMovesTheVehicleSidewaysByItsRms) {
  const PlanarPath path = make_path({}, {{.straight_m = 5000}}, 0.06);
  double sum = 0, sum2 = 0;
  constexpr int n = 20000;
  for (int k = 0; k < n; ++k) {
    const double y = path.at(k * 0.25).y_m;
    sum += y;
    sum2 += y * y;
  }
  const double rms = std::sqrt(sum2 / n - sum / n * sum / n);
  EXPECT_NEAR(rms, 0.06, 0.002);
}

TEST(PlanarPath, RefusesABlendThatDoesNotFitAndPiecesOfNoKind) {
  std::vector<PlanarPath::Problem> problems;
  const std::vector<PathPiece> pieces{
      {.straight_m = 5}, {.turn_deg = 30, .radius_m = 5, .blend_m = 4}, {.straight_m = 5, .turn_deg = 10}, {}};
  const PlanarPath path({}, pieces, Waves(), problems);
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].piece, 1u);
  EXPECT_NE(problems[0].message.find("at most 2.62 m"), std::string::npos) << problems[0].message;
  EXPECT_EQ(problems[1].piece, 2u);
  EXPECT_EQ(problems[2].piece, 3u);
}

}  // namespace
}  // namespace tarmac::scenes
