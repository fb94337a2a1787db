#include "sim/lidar/firing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sim/raycast/tracer.h"
#include "tests/support/constants.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using tests::rad;

double clockwise_azimuth(const Vector3d& d) {
  return std::atan2(-d.y(), d.x());
}
double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}

TEST(Firing, OusterColumnsComeAtTheirFractionOfTheRevolution) {
  const Profile& p = profile("ouster-os1-64-gen2");
  for (const Mode mode : {Mode{512, 10}, Mode{1024, 10}, Mode{2048, 10}, Mode{512, 20}, Mode{1024, 20}}) {
    const FiringTable firing(p, mode);
    for (const std::int64_t k : {0, 1, 7}) {
      const SweepSpan sweep = firing.sweep(k);
      ASSERT_EQ(sweep.cycles, mode.columns);
      EXPECT_EQ(core::to_ns(sweep.begin), std::llround(static_cast<double>(k) * 1e9 / mode.rate_hz));
      for (std::int64_t m = 0; m < sweep.cycles; ++m) {
        const double expected_ns = static_cast<double>(m) * 1e9 / (mode.columns * mode.rate_hz);
        EXPECT_NEAR(static_cast<double>((firing.cycle(sweep, m).t - sweep.begin).count()), expected_ns, 1.0);
      }
      EXPECT_EQ(sweep.end, firing.cycle(sweep, mode.columns - 1).t);
    }
  }
}

TEST(Firing, OusterBeamsFollowTheMakersFormula) {
  // In the lidar frame: x = (r-n) cos(te+ta) cos(phi) + n cos(te), y likewise with sin, z = (r-n) sin(phi);
  // the sensor frame is turned by 180 degrees about z, and its origin lies lower, at the base.
  struct Sensor {
    const char* name;
    double n, height_m;
  };
  for (const Sensor& sensor :
       {Sensor{"ouster-os1-64-gen2", 15.806e-3, 0.03618}, Sensor{"ouster-os1-128-rev7", 16.721e-3, 0.038195},
        Sensor{"ouster-os0-128-rev7", 27.116e-3, 0.038195}}) {
    const Profile& p = profile(sensor.name);
    const FiringTable firing(p, {1024, 10});
    const SweepSpan sweep = firing.sweep(3);
    const double r = 41.25, n = sensor.n;
    for (const std::int64_t m : {0, 1, 255, 512, 1023})
      for (std::size_t c = 0; c < p.channels(); ++c) {
        const double te = 2 * M_PI * (1 - static_cast<double>(m) / 1024), ta = -p.azimuth_offset_cw_deg[c] * rad,
                     phi = p.elevation_deg[c] * rad;
        const Vector3d p_lidar((r - n) * std::cos(te + ta) * std::cos(phi) + n * std::cos(te),
                               (r - n) * std::sin(te + ta) * std::cos(phi) + n * std::sin(te), (r - n) * std::sin(phi));
        const Vector3d p_sensor(-p_lidar.x(), -p_lidar.y(), p_lidar.z() + sensor.height_m);
        const Cycle cycle = firing.cycle(sweep, m);
        EXPECT_LT((firing.origin(cycle) + (r - firing.range_offset_m()) * firing.direction(cycle, c) - p_sensor).norm(),
                  1e-12)
            << sensor.name;
      }
  }
}

TEST(Firing, VelodyneTimesAreOrderedAndMatchTheFormula) {
  const FiringTable firing(profile("vlp-16"), {0, 10});
  core::Time last = core::time_from_ns(-1);
  for (std::int64_t k = 0; k < 5; ++k) {
    const SweepSpan sweep = firing.sweep(k);
    for (std::int64_t s = 0; s < sweep.cycles; ++s)
      for (std::size_t c = 0; c < firing.channels(); ++c) {
        const core::Time t = firing.cycle(sweep, s).t + core::Duration(firing.offset_ns(c));
        EXPECT_EQ(core::to_ns(t), (sweep.first_cycle + s) * 55296 + static_cast<std::int64_t>(c) * 2304);
        ASSERT_GT(t, last);
        last = t;
      }
    EXPECT_EQ(last, sweep.end);
  }
}

TEST(Firing, VelodyneRevolutionHoldsAsManyCyclesAsItsTimeAllows) {
  for (const double rate_hz : {5.0, 10.0, 20.0}) {
    const FiringTable firing(profile("vlp-16"), {0, rate_hz});
    const double per_turn = 1 / (rate_hz * 55.296e-6);
    std::int64_t next = 0;
    for (std::int64_t k = 0; k < 200; ++k) {
      const SweepSpan sweep = firing.sweep(k);
      EXPECT_EQ(sweep.first_cycle, next);  // none lost, none twice
      EXPECT_TRUE(sweep.cycles == std::floor(per_turn) || sweep.cycles == std::ceil(per_turn)) << sweep.cycles;
      next += sweep.cycles;
    }
    EXPECT_NEAR(static_cast<double>(next) / 200, per_turn, 1.0 / 200);
  }
}

TEST(Firing, VelodyneAzimuthIncludesTheSpinInsideTheCycle) {
  const FiringTable firing(profile("vlp-16"), {0, 20});
  for (const std::int64_t k : {0, 1, 23})
    for (const std::int64_t s : {0, 400, 903}) {
      const SweepSpan sweep = firing.sweep(k);
      const Cycle cycle = firing.cycle(sweep, s);
      for (std::size_t c = 0; c < firing.channels(); ++c) {
        const double t_s = 55.296e-6 * static_cast<double>(sweep.first_cycle + s) + 2.304e-6 * static_cast<double>(c);
        const double expected = M_PI + 2 * M_PI * 20 * t_s;
        EXPECT_NEAR(wrapped(clockwise_azimuth(firing.direction(cycle, c)) - expected), 0, 1e-9);
      }
    }
}

TEST(Firing, SweepsBeginWhereTheProfileSaysAndTurnClockwise) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    if (p.by_prism()) continue;  // has no head that turns
    const FiringTable firing(p, mode_of(p, 0, 0));
    const SweepSpan sweep = firing.sweep(2);
    const double step = 2 * M_PI / static_cast<double>(sweep.cycles), start = p.azimuth_start_deg * rad;
    const auto azimuth = [&](std::int64_t k) {
      return std::atan2(firing.cycle(sweep, k).sin_azimuth, firing.cycle(sweep, k).cos_azimuth);
    };
    EXPECT_NEAR(wrapped(azimuth(0) - start), 0, 1.01 * step) << name;
    EXPECT_NEAR(wrapped(azimuth(1) - azimuth(0)), step, 0.01 * step) << name;
    // A quarter later the head looks a quarter further clockwise, seen from above: from the rear (-x) to the left (+y).
    const Cycle quarter = firing.cycle(sweep, sweep.cycles / 4);
    const Vector3d expected(-std::sin(start), -std::cos(start), 0);
    double along = 0;
    for (std::size_t c = 0; c < firing.channels(); ++c)
      along += firing.direction(quarter, c).normalized().dot(expected) / static_cast<double>(firing.channels());
    EXPECT_GT(along, name == "ouster-os0-128-rev7" ? 0.85 : 0.9)
        << name;  // its beams rise and fall by up to 45 degrees
  }
  EXPECT_EQ(profile("vlp-16").azimuth_start_deg, 180);
}

TEST(Firing, TilesHoldEveryFiringOnceAndNeighboursTogether) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const FiringTable firing(p, mode_of(p, 0, 0));
    const SweepSpan sweep = firing.sweep(0);
    for (const std::size_t cycles : {32, 7}) {
      std::multiset<std::uint32_t> seen;
      const std::vector<std::uint32_t> tiles = firing.tiles(cycles);
      ASSERT_EQ(tiles.size() % 16, 0u);
      if (cycles % 16 == 0) {  // hardly a place is traced in vain
        EXPECT_LE(8 * tiles.size(), 9 * cycles * firing.channels()) << name;
      }
      for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i] == raycast::SweepTracer::no_ray) continue;
        seen.insert(tiles[i]);
        const auto direction = [&](std::uint32_t index) {
          return firing.direction(firing.cycle(sweep, index / static_cast<std::uint32_t>(firing.channels())),
                                  index % firing.channels());
        };
        EXPECT_GT(direction(tiles[i]).dot(direction(tiles[i / 16 * 16])), std::cos(7 * rad)) << name;
      }
      EXPECT_EQ(seen.size(), cycles * firing.channels());
      EXPECT_EQ(std::set<std::uint32_t>(seen.begin(), seen.end()).size(), seen.size());
    }
  }
}

TEST(Firing, ASensorThatStartsLaterFiresAllLaterAndAlike) {
  for (const char* name : {"ouster-os1-64-gen2", "vlp-16", "livox-mid-40"}) {
    const Profile& p = profile(name);
    const core::Duration start = core::duration_from_s(0.0371);
    const Mode mode = mode_of(p, 0, 0);
    const FiringTable prompt(p, mode), late(p, mode, SpinJitter({}, 1, "test"), {}, start);
    for (const std::int64_t k : {0, 5}) {
      const SweepSpan a = prompt.sweep(k), b = late.sweep(k);
      ASSERT_EQ(a.cycles, b.cycles);
      EXPECT_EQ(b.begin - a.begin, start);
      EXPECT_EQ(b.end - a.end, start);
      for (const std::int64_t c : {std::int64_t{0}, a.cycles / 3, a.cycles - 1}) {
        EXPECT_EQ(late.cycle(b, c).t - prompt.cycle(a, c).t, start);
        EXPECT_EQ(late.direction(late.cycle(b, c), 0), prompt.direction(prompt.cycle(a, c), 0)) << name;
      }
    }
    EXPECT_EQ(late.sweeps_until(prompt.sweep(4).end), 4);
    EXPECT_EQ(late.sweeps_until(prompt.sweep(4).end + start), 5);
    EXPECT_EQ(late.sweeps_until(core::time_from_s(0.01)), 0);
  }
}

TEST(Firing, OnlySweepsThatEndInTimeAreCounted) {
  const FiringTable firing(profile("ouster-os1-64-gen2"), {1024, 10});
  EXPECT_EQ(firing.sweeps_until(core::time_from_s(1)), 10);
  EXPECT_EQ(firing.sweeps_until(firing.sweep(4).end), 5);
  EXPECT_EQ(firing.sweeps_until(firing.sweep(4).end - core::Duration(1)), 4);
  EXPECT_EQ(firing.sweeps_until(core::time_from_s(0.05)), 0);
}

}  // namespace
}  // namespace tarmac::sim::lidar
