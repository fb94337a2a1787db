#include "sim/lidar/prism.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/lidar/firing.h"
#include "tests/support/constants.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using tests::rad;

Profile mid40() {
  return profile("livox-mid-40");
}
double off_axis(const Vector3d& d) {
  return std::atan2(std::hypot(d.y(), d.z()), d.x());
}

TEST(Prism, LeaningTheSameWayBendsAsSnellsLawDoesInThePlane) {
  // In the plane that holds both slants, angles to the axis, positive towards the wedges' thick side: the slanted
  // face's normal stands at w, so a ray at angle a goes on at w + asin(sin(a - w) / n), and leaves at asin(n sin(.)).
  const Profile p = mid40();
  const double n = p.prism_refractive_index;
  double angle = 0;
  for (const double wedge_deg : p.prism_wedge_deg) {
    const double w = wedge_deg * rad;
    const double inside = w + std::asin(std::sin(angle - w) / n);
    angle = std::asin(n * std::sin(inside));
  }
  const Vector3d d = Prism(p).direction(0);  // both bend towards +y
  EXPECT_NEAR(std::atan2(d.y(), d.x()), angle, 1e-12);
  EXPECT_NEAR(d.z(), 0, 1e-15);
  EXPECT_GT(angle, 19 * rad);
}

TEST(Prism, IsTheSumOfDeviationsForThinWedges) {
  Profile p = mid40();
  p.prism_wedge_deg = {0.5, 0.3};
  const Prism prism(p);
  for (int k = 0; k < 50; ++k) {
    const double t_s = 1.7e-3 * k;
    Vector3d expected(1, 0, 0);
    for (std::size_t i = 0; i < 2; ++i) {
      const double bend = (p.prism_refractive_index - 1) * p.prism_wedge_deg[i] * rad;
      const double turn = 2 * M_PI * p.prism_hz[i] * t_s;
      expected += bend * Vector3d(0, std::cos(turn), std::sin(turn));
    }
    const Vector3d d = prism.direction(1e9 * t_s);
    // Third order in the wedges.
    EXPECT_LT((d - expected.normalized()).norm(), 5 * std::pow(0.8 * rad, 3)) << (d - expected).transpose();
  }
}

TEST(Prism, Mid40FillsItsCircle) {
  const Prism prism(mid40());
  double widest = 0, narrowest = 1;
  for (int pulse = 0; pulse < 200000; ++pulse) {
    const double angle = off_axis(prism.direction(1e4 * pulse));
    widest = std::max(widest, angle);
    narrowest = std::min(narrowest, angle);
  }
  EXPECT_NEAR(2 * widest / rad, 38.4, 0.1);  // the maker's field of view
  EXPECT_LT(narrowest / rad, 0.1);           // no hole in the middle
}

/// Which tenth-of-a-degree squares of the field of view are hit in frames [first, last).
std::set<std::pair<int, int>> seen(const FiringTable& firing, std::int64_t first, std::int64_t last) {
  std::set<std::pair<int, int>> squares;
  for (std::int64_t k = first; k < last; ++k) {
    const SweepSpan sweep = firing.sweep(k);
    for (std::int64_t c = 0; c < sweep.cycles; ++c)
      for (std::size_t i = 0; i < firing.channels(); ++i) {
        const Vector3d d = firing.direction(firing.cycle(sweep, c), i);
        squares.insert(
            {static_cast<int>(std::floor(d.y() / (0.3 * rad))), static_cast<int>(std::floor(d.z() / (0.3 * rad)))});
      }
  }
  return squares;
}

TEST(Prism, FramesDoNotRepeatAndFillTheFieldOfView) {
  const FiringTable firing(mid40(), {0, 10});
  const auto one = seen(firing, 0, 1), next = seen(firing, 1, 2), ten = seen(firing, 0, 10);
  std::size_t common = 0;
  for (const auto& square : next) common += one.count(square);
  EXPECT_LT(common, one.size() * 7 / 10);
  EXPECT_GT(ten.size(), 2 * one.size());
  EXPECT_GT(static_cast<double>(ten.size()), 0.85 * M_PI * std::pow(19.2 / 0.3, 2));
}

TEST(Prism, PulsesComeEveryTenMicrosecondsAndPointWhereTheWedgesAreThen) {
  const Profile p = mid40();
  const FiringTable firing(p, {0, 10});
  const Prism prism(p);
  std::int64_t pulse = 0;
  for (std::int64_t k = 0; k < 12; ++k) {
    const SweepSpan sweep = firing.sweep(k);
    EXPECT_EQ(core::to_ns(sweep.begin), k * 100'000'000);
    EXPECT_EQ(sweep.cycles * static_cast<std::int64_t>(firing.channels()), 10'000);
    for (std::int64_t c = 0; c < sweep.cycles; ++c)
      for (std::size_t i = 0; i < firing.channels(); ++i, ++pulse) {
        const Cycle cycle = firing.cycle(sweep, c);
        ASSERT_EQ(core::to_ns(cycle.t) + firing.offset_ns(i), pulse * 10'000);
        ASSERT_EQ(firing.direction(cycle, i), prism.direction(1e4 * static_cast<double>(pulse)));
      }
    EXPECT_EQ(core::to_ns(sweep.end), (pulse - 1) * 10'000);
  }
}

}  // namespace
}  // namespace tarmac::sim::lidar
