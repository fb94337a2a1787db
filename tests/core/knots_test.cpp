#include "core/knots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/spline_trajectory.h"
#include "tests/core/spline_cases.h"

namespace tarmac::core {
namespace {

using spline_cases::kOrigin_ns;
constexpr Duration kMs{1'000'000};
const Time kStart = time_from_ns(kOrigin_ns);

int count_after(std::span<const Time> knots, Time t) {
  return static_cast<int>(std::count_if(knots.begin(), knots.end(), [&](Time knot) { return knot > t; }));
}

std::vector<Time> joined(std::vector<Time> knots, const std::vector<Time>& more) {
  knots.insert(knots.end(), more.begin(), more.end());
  return knots;
}

/// `rate_hz` samples a second over [begin, end).
std::vector<ImuSample> samples(Time begin, Time end, double gyro_rad_s, double accel_excess_m_s2,
                               double rate_hz = 200) {
  std::vector<ImuSample> out;
  for (Time t = begin; t < end; t += duration_from_s(1 / rate_hz)) {
    out.push_back({t, gyro_rad_s * Eigen::Vector3d(0, 0.6, 0.8), Eigen::Vector3d(0, 0, 9.80665 + accel_excess_m_s2)});
  }
  return out;
}

TEST(UniformKnots, MakeASplineOverExactlyTheSpanAskedFor) {
  for (const int order : {4, 5, 6}) {
    for (const Duration length : {Duration(0), 99 * kMs, 100 * kMs, 101 * kMs, 1234 * kMs}) {
      const auto knots = uniform_knots(kStart, kStart + length, 100 * kMs, order);
      const SplineTrajectory spline = SplineTrajectory::at_rest(SplineKind::split, order, SE3::Identity(), knots);
      EXPECT_EQ(spline.begin(), kStart);
      EXPECT_GE(spline.end(), kStart + length);
      EXPECT_LT(spline.end(), kStart + length + 100 * kMs) << "no interval more than needed";
      for (std::size_t i = 1; i < knots.size(); ++i) EXPECT_EQ(knots[i] - knots[i - 1], 100 * kMs);
    }
  }
  EXPECT_THROW(uniform_knots(kStart, kStart + kMs, Duration(0), 4), InputError);
  EXPECT_THROW(uniform_knots(kStart, kStart - kMs, kMs, 4), InputError);
}

TEST(UniformKnots, CountThoseThatLieThereAlready) {
  auto knots = uniform_knots(kStart, kStart, 100 * kMs, 4);
  for (int sweep = 1; sweep <= 20; ++sweep) {
    const Time end = kStart + sweep * 100 * kMs - Duration(1000);
    knots = joined(knots, uniform_knots_after(knots, end, 100 * kMs, 4));
    EXPECT_EQ(count_after(knots, end), 4);
    EXPECT_TRUE(uniform_knots_after(knots, end, 100 * kMs, 4).empty()) << "nothing is missing any more";
  }
  EXPECT_THROW(uniform_knots_after({}, kStart, kMs, 4), InputError);
  EXPECT_THROW(uniform_knots_after(knots, kStart, Duration(-1), 4), InputError);
}

TEST(UniformKnots, WithNoneBeyondTheLastLiesAtTheEndOrJustAfterIt) {
  const Time last[] = {kStart};
  EXPECT_EQ(uniform_knots_after(last, kStart + 100 * kMs, 50 * kMs, 0),
            (std::vector<Time>{kStart + 50 * kMs, kStart + 100 * kMs}));
  EXPECT_EQ(uniform_knots_after(last, kStart + 101 * kMs, 50 * kMs, 0).back(), kStart + 150 * kMs);
  EXPECT_TRUE(uniform_knots_after(last, kStart, 50 * kMs, 0).empty());
}

TEST(ExtendingBySuchKnots, AddsNoKnotOfTheSplinesOwn) {
  for (const int order : {4, 5, 6}) {
    SplineTrajectory spline = SplineTrajectory::at_rest(SplineKind::split, order, SE3::Identity(),
                                                        uniform_knots(kStart, kStart, 70 * kMs, order));
    const Time end = kStart + 1000 * kMs;
    const auto wanted = uniform_knots_after(spline.knots(), end, 30 * kMs, order);
    const auto expected = joined(spline.knots(), wanted);
    spline.extend(kStart, end, wanted);
    EXPECT_EQ(spline.knots(), expected);
    EXPECT_GE(spline.end(), end);
  }
}

TEST(Margins, RepeatTheOuterSpacings) {
  const std::vector<Time> inner = {kStart, kStart + 10 * kMs, kStart + 40 * kMs};
  const auto knots = with_margins(inner, 4);
  ASSERT_EQ(knots.size(), 9u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(knots[static_cast<std::size_t>(i)], kStart - (3 - i) * 10 * kMs);
    EXPECT_EQ(knots[static_cast<std::size_t>(6 + i)], kStart + 40 * kMs + (i + 1) * 30 * kMs);
  }
  const SplineTrajectory spline = SplineTrajectory::at_rest(SplineKind::se3, 4, SE3::Identity(), knots);
  EXPECT_EQ(spline.begin(), inner.front());
  EXPECT_EQ(spline.end(), inner.back() - Duration(1));
  EXPECT_THROW(with_margins(std::vector<Time>{kStart}, 4), InputError);
  EXPECT_THROW(with_margins(std::vector<Time>{kStart, kStart}, 4), InputError);
}

TEST(SweepKnots, StandANanosecondAfterSweepsEndAndFollowThemWhenTheyDrift) {
  // Sweeps of 100.3 ms instead of the 100 ms that is expected.
  auto knots = uniform_knots(kStart, kStart, 100 * kMs, 4);
  for (int sweep = 1; sweep <= 50; ++sweep) {
    const Time end = kStart + Duration(static_cast<std::int64_t>(sweep * 100.3e6));
    knots = joined(knots, sweep_knots_after(knots, end, 100 * kMs, 4));
    EXPECT_GE(count_after(knots, end), 4);
    EXPECT_LE(count_after(knots, end), 5);
  }
  for (std::size_t i = 8; i < knots.size(); ++i) {
    EXPECT_GE(knots[i] - knots[i - 1], 50 * kMs);
    EXPECT_LE(knots[i] - knots[i - 1], 150 * kMs);
  }
  // On time: exactly one at every sweep's end.
  knots = {kStart};
  for (int sweep = 1; sweep <= 10; ++sweep) {
    const Time end = kStart + sweep * 100 * kMs - Duration(500'000);
    knots = joined(knots, sweep_knots_after(knots, end, 100 * kMs, 4));
    EXPECT_EQ(std::count(knots.begin(), knots.end(), end + Duration(1)), 1) << sweep;
    EXPECT_EQ(count_after(knots, end), 4);
  }
  EXPECT_THROW(sweep_knots_after(knots, kStart, Duration(0), 4), InputError);
}

TEST(Excitation, DensityFollowsTheBoundsAndTheHigherOneCounts) {
  const ExcitationRule rule;
  const auto density = [&](double gyro, double accel) {
    return knots_per_slot(samples(kStart, kStart + 100 * kMs, gyro, accel), rule);
  };
  EXPECT_EQ(density(0, 0), 1);
  EXPECT_EQ(density(0.49, 0.49), 1);
  EXPECT_EQ(density(0.51, 0), 2);
  EXPECT_EQ(density(0, -0.51), 2) << "less than gravity counts as much as more";
  EXPECT_EQ(density(1.01, 0.6), 3);
  EXPECT_EQ(density(0.6, 1.01), 3);
  EXPECT_EQ(density(5.01, 0), 4);
  EXPECT_EQ(density(0, 50), 4);
  EXPECT_THROW(knots_per_slot({}, rule), InputError);
}

TEST(Excitation, TurningToAndFroCountsThoughItsMeanIsNone) {
  auto shaken = samples(kStart, kStart + 100 * kMs, 2, 0);
  for (std::size_t i = 0; i < shaken.size(); i += 2) shaken[i].gyro_rad_s *= -1;
  EXPECT_EQ(knots_per_slot(shaken, {}), 3);
}

TEST(ExcitationKnots, DivideEachSlotByItsOwnSamples) {
  auto all = samples(kStart, kStart + 100 * kMs, 0, 0);
  for (const auto& s : samples(kStart + 100 * kMs, kStart + 200 * kMs, 2, 0)) all.push_back(s);
  for (const auto& s : samples(kStart + 200 * kMs, kStart + 300 * kMs, 0, 7)) all.push_back(s);
  const Time last[] = {kStart};
  const auto knots = excitation_knots_after(last, kStart + 300 * kMs, all, {}, 0);
  std::vector<Time> expected = {kStart + 100 * kMs};
  for (int i = 1; i <= 3; ++i) expected.push_back(kStart + 100 * kMs + 100 * kMs * i / 3);
  for (int i = 1; i <= 4; ++i) expected.push_back(kStart + 200 * kMs + 25 * i * kMs);
  EXPECT_EQ(knots, expected);
}

TEST(ExcitationKnots, WithoutSamplesTheNewestBeforeDecide) {
  const Time last[] = {kStart};
  const auto spacing_after = [&](const std::vector<ImuSample>& imu) {
    const auto knots = excitation_knots_after(last, kStart + 50 * kMs, imu, {}, 4);
    return knots[1] - knots[0];
  };
  EXPECT_EQ(spacing_after({}), 100 * kMs) << "nothing known: one a slot";
  auto imu = samples(kStart - 1000 * kMs, kStart - 300 * kMs, 9, 0);
  EXPECT_EQ(spacing_after(imu), 25 * kMs);
  // Quiet during the newest slot's length: what was before that does not matter.
  for (const auto& s : samples(kStart - 300 * kMs, kStart - 150 * kMs, 0, 0)) imu.push_back(s);
  EXPECT_EQ(spacing_after(imu), 100 * kMs);
}

TEST(ExcitationKnots, PlaceAsManyBeyondAsAreMissing) {
  auto knots = uniform_knots(kStart, kStart, 100 * kMs, 4);
  const auto imu = samples(kStart, kStart + 2000 * kMs, 2, 0);
  for (int sweep = 1; sweep <= 20; ++sweep) {
    const Time end = kStart + sweep * 100 * kMs;
    knots = joined(knots, excitation_knots_after(knots, end, imu, {}, 4));
    EXPECT_EQ(count_after(knots, end), 4);
  }
  for (std::size_t i = 1; i < knots.size(); ++i) EXPECT_GT(knots[i], knots[i - 1]);
}

}  // namespace
}  // namespace tarmac::core
