#include "sim/lidar/spin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "sim/lidar/firing.h"

namespace tarmac::sim::lidar {
namespace {

SpinJitter jitter(double rate_jitter, std::uint64_t seed, double correlation_s = 0.5, double encoder_step_deg = 0) {
  return {{.rate_jitter = rate_jitter, .correlation_s = correlation_s, .encoder_step_deg = encoder_step_deg},
          seed,
          "test/spin"};
}
FiringTable firing(const char* name, const SpinJitter& spin) {
  const Profile& p = profile(name);
  return {p, mode_of(p, 0, 0), spin};
}
double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * M_PI);
}

TEST(SpinJitter, HasTheStatedSpreadAndCorrelation) {
  // Over 4000 realisations, at two instants dt apart. The variance of a mean of n products of (nearly) normal numbers
  // is at most 2/n: five standard deviations are 0.11.
  constexpr int n = 4000;
  for (const double dt_s : {0.0, 0.1, 0.5, 1.0}) {
    double sum = 0, products = 0;
    for (std::uint64_t seed = 1; seed <= n; ++seed) {
      const SpinJitter spin = jitter(0.002, seed);
      const double a = spin.rate_error(17.3) / 0.002, b = spin.rate_error(17.3 + dt_s) / 0.002;
      sum += a;
      products += a * b;
    }
    EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
    EXPECT_NEAR(products / n, std::exp(-dt_s / 0.5), 5 * std::sqrt(2.0 / n)) << dt_s;
  }
}

TEST(SpinJitter, LeadIsTheIntegralOfTheRateError) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SpinJitter spin = jitter(0.003, seed);
    EXPECT_EQ(spin.lead_s(0), 0);
    for (const double t_s : {0.3, 5.0, 61.7}) {
      // Fast waves (the spectrum falls slowly) bend the integral within any step: the step is small and so is what
      // they add.
      constexpr double h = 1e-7;
      const double slope = (spin.lead_s(t_s + h) - spin.lead_s(t_s - h)) / (2 * h);
      EXPECT_NEAR(slope, spin.rate_error(t_s), 1e-6) << t_s;
    }
    for (double t_s = 0; t_s < 50; t_s += 0.0137) ASSERT_LE(std::abs(spin.rate_error(t_s)), spin.largest_rate_error());
  }
  EXPECT_LT(jitter(0.02, 1).largest_rate_error(), 1);
}

TEST(SpinJitter, OffMeansNothingChanges) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const FiringTable plain(p, mode_of(p, 0, 0)), still(p, mode_of(p, 0, 0), jitter(0, 7));
    for (const std::int64_t k : {0, 13}) {
      const SweepSpan a = plain.sweep(k), b = still.sweep(k);
      EXPECT_EQ(a.begin, b.begin);
      EXPECT_EQ(a.end, b.end);
      for (std::int64_t c = 0; c < a.cycles; c += 97) {
        EXPECT_EQ(plain.cycle(a, c).t, still.cycle(b, c).t);
        EXPECT_EQ(plain.cycle(a, c).cos_azimuth, still.cycle(b, c).cos_azimuth);
        EXPECT_EQ(still.cycle(b, c).cos_encoder, still.cycle(b, c).cos_azimuth);
        EXPECT_EQ(still.cycle(b, c).sin_encoder, still.cycle(b, c).sin_azimuth);
      }
    }
  }
}

TEST(SpinJitter, EncoderDrivenColumnsKeepTheirAnglesAndMoveInTime) {
  const SpinJitter spin = jitter(0.002, 3);
  const FiringTable even = firing("ouster-os1-64-gen2", jitter(0, 3)), uneven = firing("ouster-os1-64-gen2", spin);
  double moved_s = 0;
  core::Time last = core::time_from_ns(-1);
  for (std::int64_t k = 0; k < 30; ++k) {
    const SweepSpan a = even.sweep(k), b = uneven.sweep(k);
    ASSERT_EQ(a.cycles, b.cycles);
    EXPECT_GT(b.begin, last);
    for (std::int64_t c = 0; c < a.cycles; ++c) {
      const Cycle nominal = even.cycle(a, c), real = uneven.cycle(b, c);
      EXPECT_EQ(nominal.cos_azimuth, real.cos_azimuth);
      ASSERT_GT(real.t, last);
      last = real.t;
      const double t_s = 1e-9 * (97656.25 * static_cast<double>(k * 1024 + c));
      EXPECT_NEAR(core::to_s(real.t), t_s + spin.lead_s(t_s), 0.6e-9);
      moved_s = std::max(moved_s, std::abs(core::to_s(real.t) - t_s));
    }
    EXPECT_EQ(b.end, last);
  }
  EXPECT_GT(moved_s, 1e-4);
}

TEST(SpinJitter, ClockDrivenCyclesKeepTheirTimesAndTurnInAngle) {
  const SpinJitter spin = jitter(0.003, 4);
  const FiringTable uneven = firing("vlp-16", spin);
  std::int64_t next = 0, fewest = 1 << 20, most = 0;
  for (std::int64_t k = 0; k < 60; ++k) {
    const SweepSpan sweep = uneven.sweep(k);
    ASSERT_EQ(sweep.first_cycle, next);  // none lost, none twice
    next += sweep.cycles;
    fewest = std::min(fewest, sweep.cycles);
    most = std::max(most, sweep.cycles);
    for (std::int64_t c = 0; c < sweep.cycles; ++c) {
      const Cycle cycle = uneven.cycle(sweep, c);
      const std::int64_t n = sweep.first_cycle + c;
      EXPECT_EQ(core::to_ns(cycle.t), n * 55'296);
      const double t_s = 55.296e-6 * static_cast<double>(n), turns = 10 * (t_s + spin.lead_s(t_s));
      EXPECT_GE(turns, static_cast<double>(k) - 1e-8);
      EXPECT_LT(turns, static_cast<double>(k + 1));
      ASSERT_NEAR(wrapped(std::atan2(cycle.sin_azimuth, cycle.cos_azimuth) - M_PI - 2 * M_PI * turns), 0, 1e-9);
    }
  }
  EXPECT_GT(most, 1809);  // an even head has 1808 or 1809
  EXPECT_LT(fewest, 1808);
}

TEST(SpinJitter, AnySweepIsTheSameWhoeverAsksFirst) {
  const FiringTable one = firing("hdl-32e", jitter(0.003, 5, 0.5, 0.01)),
                    other = firing("hdl-32e", jitter(0.003, 5, 0.5, 0.01));
  for (std::int64_t k = 40; k >= 0; k -= 8) {
    const SweepSpan sweep = one.sweep(k);
    one.cycle(sweep, 3);
  }
  for (std::int64_t k = 0; k <= 40; k += 8) {
    const SweepSpan a = one.sweep(k), b = other.sweep(k);
    EXPECT_EQ(a.first_cycle, b.first_cycle);
    EXPECT_EQ(one.cycle(a, 11).cos_encoder, other.cycle(b, 11).cos_encoder);
  }
  EXPECT_NE(firing("hdl-32e", jitter(0.003, 6)).sweep(40).first_cycle, one.sweep(40).first_cycle);
}

TEST(SpinJitter, EncoderErrorIsUniformOverItsStepAndParts_TrueFromReported) {
  for (const char* name : {"ouster-os1-64-gen2", "vlp-16"}) {
    const FiringTable exact = firing(name, jitter(0, 2)), errs = firing(name, jitter(0, 2, 0.5, 0.01));
    double sum = 0, squares = 0, largest = 0;
    int n = 0;
    for (std::int64_t k = 0; k < 20; ++k) {
      const SweepSpan sweep = errs.sweep(k);
      for (std::int64_t c = 0; c < sweep.cycles; ++c, ++n) {
        const Cycle a = exact.cycle(sweep, c), b = errs.cycle(sweep, c);
        EXPECT_EQ(a.t, b.t);
        // An encoder-driven sensor reports the angle it meant to fire at; a clock-driven head is where it is.
        if (std::string(name) == "vlp-16")
          EXPECT_EQ(a.cos_azimuth, b.cos_azimuth);
        else
          EXPECT_EQ(a.cos_azimuth, b.cos_encoder);
        const double error = std::atan2(b.sin_azimuth, b.cos_azimuth) - std::atan2(b.sin_encoder, b.cos_encoder);
        const double steps = wrapped(error) / (0.01 * M_PI / 180);
        sum += steps;
        squares += steps * steps;
        largest = std::max(largest, std::abs(steps));
      }
    }
    EXPECT_LE(largest, 0.5 + 1e-9);
    EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(1.0 / 12 / n));
    EXPECT_NEAR(squares / n, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / n));  // variance of x^2, x uniform
  }
}

TEST(SpinJitter, OnlySweepsThatEndInTimeAreCounted) {
  for (const char* name : {"ouster-os1-64-gen2", "vlp-16"})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const FiringTable uneven = firing(name, jitter(0.02, seed, 5));
      const core::Time end = core::time_from_s(20);
      const std::int64_t n = uneven.sweeps_until(end);
      EXPECT_LE(uneven.sweep(n - 1).end, end);
      EXPECT_GT(uneven.sweep(n).end, end);
      EXPECT_NEAR(static_cast<double>(n), 200, 20);
    }
}

TEST(SpinJitter, IsRefusedWhereColumnsWouldOverlap) {
  Profile p = profile("ouster-os1-64-gen2");
  for (std::size_t c = 0; c < p.channels(); ++c) p.firing_us[c] = 90.0 * static_cast<double>(c) / 63;
  EXPECT_NO_THROW(FiringTable(p, {1024, 10}, jitter(0.001, 1)));
  EXPECT_THROW(FiringTable(p, {1024, 10}, jitter(0.02, 1)), core::InputError);
}

}  // namespace
}  // namespace tarmac::sim::lidar
