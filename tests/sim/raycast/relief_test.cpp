#include "sim/raycast/relief.h"

#include <gtest/gtest.h>

#include "tests/sim/support/shapes.h"

namespace tarmac::sim::raycast {
namespace {

using Eigen::Vector3d;

/// A ray that comes down on z = 0 at p, `elevation` below the horizon.
Vector3d downward(double elevation_rad, double heading_rad) {
  return {std::cos(elevation_rad) * std::cos(heading_rad), std::cos(elevation_rad) * std::sin(heading_rad),
          -std::sin(elevation_rad)};
}

TEST(Relief, HitLiesOnTheHeightFieldFromSteepToGrazingRays) {
  for (const double wavelength_m : {2.0, 0.25, 0.05}) {
    tests::SineRelief relief;
    relief.wavelength_m = wavelength_m;
    for (const double elevation_rad : {1.5, 0.5, 0.1, 0.03, 0.011})
      for (int k = 0; k < 1000; ++k) {
        const Vector3d d = downward(elevation_rad, 0.1 * k), p(0.013 * k, -0.007 * k, 0);
        const ReliefHit hit = meet_relief(relief, p, d, Vector3d::UnitZ(), 50);
        const Vector3d on_relief = p + (hit.t_m - 50) * d;
        EXPECT_NEAR(on_relief.z(), relief.height_m(on_relief.x(), on_relief.y()), 60e-6)
            << wavelength_m << " " << elevation_rad << " " << k;
        // Heights are within twice the amplitude: that bounds where along the ray the relief can be met.
        EXPECT_LE(std::abs(hit.t_m - 50), (2 * relief.amplitude_m + 60e-6) / std::sin(elevation_rad));
      }
  }
}

TEST(Relief, IncidenceIsThatOfTheReliefsOwnNormalWhereItFacesTheSensor) {
  const tests::SineRelief relief;
  const Vector3d d = downward(0.8, 0.3), p(0.4, 0.2, 0);
  const ReliefHit hit = meet_relief(relief, p, d, Vector3d::UnitZ(), 10);
  Eigen::Vector2d gradient;
  const Vector3d on_relief = p + (hit.t_m - 10) * d;
  relief.height_m(on_relief.x(), on_relief.y(), &gradient);
  const double expected = -Vector3d(-gradient.x(), -gradient.y(), 1).normalized().dot(d);
  EXPECT_NEAR(hit.cos_incidence, expected, 1e-3);
  EXPECT_GT(std::abs(expected - std::sin(0.8)), 5e-3);  // not just the macro normal's
}

TEST(Relief, MacroSurfaceIsKeptWhereIncidenceIsTooGrazing) {
  const tests::SineRelief relief;
  const ReliefHit hit = meet_relief(relief, Vector3d(1, 2, 0), downward(0.009, 0), Vector3d::UnitZ(), 80);
  EXPECT_EQ(hit.t_m, 80);
  EXPECT_NEAR(hit.cos_incidence, std::sin(0.009), 1e-15);
}

}  // namespace
}  // namespace tarmac::sim::raycast
