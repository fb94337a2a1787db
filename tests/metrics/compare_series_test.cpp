// Where along the drive two methods differ: blocks, simultaneous intervals, stretches.
#include "metrics/compare_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"

namespace tarmac::metrics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Ten samples a second, at 0.05, 0.15, ...
Series series(std::size_t samples, double value = 1) {
  Series s{"deskew_error_vs_time", "time [s]", "deskew error [m]", {}, {}, {}, {}};
  for (std::size_t i = 0; i < samples; ++i) {
    s.x.push_back(0.05 + 0.1 * static_cast<double>(i));
    s.y.push_back(value);
  }
  return s;
}

std::vector<SeriesPair> pairs_of(const std::vector<Series>& a, const std::vector<Series>& b) {
  std::vector<SeriesPair> pairs;
  for (std::size_t k = 0; k < a.size(); ++k) pairs.push_back({&a[k], &b[k]});
  return pairs;
}

/// Differences of three seeds in one block: 1, 2, 3. Mean 2, standard error 1 / sqrt(3); one block at 5 %: Student's
/// t(0.975; 2) = 4.302653.
TEST(CompareSeries, MatchesTheHandComputedInterval) {
  const std::vector<Series> a(3, series(10, 5));
  const std::vector<Series> b = {series(10, 6), series(10, 7), series(10, 8)};
  const SeriesComparison c = compare_series(pairs_of(a, b));
  ASSERT_EQ(c.difference.size(), 1U);
  EXPECT_NEAR(c.block_x[0], 0.5, 0.051);
  EXPECT_NEAR(c.difference[0], 2, 1e-12);
  const double half = 4.302652729911275 / std::sqrt(3.0);
  EXPECT_NEAR(c.low[0], 2 - half, 1e-9);
  EXPECT_NEAR(c.high[0], 2 + half, 1e-9);
  EXPECT_TRUE(c.stretches.empty());
  EXPECT_DOUBLE_EQ(c.a[3], 5);
  EXPECT_DOUBLE_EQ(c.b[3], 7) << "median over the seeds";
}

/// The same differences beside nine seconds without any: the level of one block is a tenth, and its interval as wide as
/// t(1 - 0.0025; 2) = 14.08905 makes it.
TEST(CompareSeries, TheBlocksOfADriveShareTheSignificance) {
  const std::vector<Series> a(3, series(100, 5));
  std::vector<Series> b = a;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 10; ++i) b[k].y[i] = 6 + static_cast<double>(k);
  const SeriesComparison c = compare_series(pairs_of(a, b));
  EXPECT_DOUBLE_EQ(c.level, 0.005);
  EXPECT_NEAR(c.high[0] - c.difference[0], 14.089047 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(compare_series(pairs_of(a, b), 1, 0.025).level, 0.0025, 1e-15);
}

/// Seeds scatter by +-0.02 and +-0.01 about nothing, and all of them have 0.5 more from 3 s to 6 s, 0.25 less from 8 s
/// to 9 s.
TEST(CompareSeries, FindsTheStretchWhereTheyDifferAndItsSide) {
  std::vector<Series> a, b;
  for (const double scatter : {-0.02, 0.02, -0.01, 0.01, 0.0}) {
    a.push_back(series(100));
    b.push_back(series(100));
    for (std::size_t i = 0; i < 100; ++i)
      b.back().y[i] += scatter + (i >= 30 && i < 60 ? 0.5 : 0) - (i >= 80 && i < 90 ? 0.25 : 0);
  }
  const SeriesComparison c = compare_series(pairs_of(a, b));
  ASSERT_EQ(c.stretches.size(), 2U);
  EXPECT_DOUBLE_EQ(c.stretches[0].from, 3);
  EXPECT_DOUBLE_EQ(c.stretches[0].to, 6);
  EXPECT_NEAR(c.stretches[0].difference, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(c.stretches[1].from, 8);
  EXPECT_DOUBLE_EQ(c.stretches[1].to, 9);
  EXPECT_NEAR(c.stretches[1].difference, -0.25, 1e-12);
}

TEST(CompareSeries, NothingIsFoundBetweenEqualsAndInRounding) {
  const std::vector<Series> a(5, series(100));
  EXPECT_TRUE(compare_series(pairs_of(a, a)).stretches.empty());
  std::vector<Series> b = a;
  for (Series& s : b)
    for (double& y : s.y) y += 1e-12;
  EXPECT_TRUE(compare_series(pairs_of(a, b)).stretches.empty());
}

/// Drives of 20 s with errors that wander, alike in A and B: a drive that shows any stretch is to be one in twenty.
TEST(CompareSeries, HoldsTheChanceOfAnyFalseStretchThoughNeighboursErrAlike) {
  constexpr int kDrives = 600;
  int drives_with_stretches = 0;
  for (int drive = 0; drive < kDrives; ++drive) {
    const core::RandomStream stream(static_cast<std::uint64_t>(drive), "test/compare_series/null");
    std::vector<Series> a, b;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      a.push_back(series(200));
      b.push_back(series(200));
      double wander_a = 0, wander_b = 0;
      for (std::size_t i = 0; i < 200; ++i) {
        wander_a = 0.9 * wander_a + 0.05 * stream.normal(1000 * seed + i, 0);
        wander_b = 0.9 * wander_b + 0.05 * stream.normal(1000 * seed + i, 1);
        a.back().y[i] += wander_a;
        b.back().y[i] += wander_b;
      }
    }
    drives_with_stretches += !compare_series(pairs_of(a, b)).stretches.empty();
  }
  EXPECT_LT(drives_with_stretches, kDrives * 0.05 + 4 * std::sqrt(kDrives * 0.05 * 0.95));
  EXPECT_GT(drives_with_stretches, 0) << "an interval that never excludes 0 would pass too";
}

TEST(CompareSeries, SamplesThatOneLacksAreLeftOutOfBoth) {
  std::vector<Series> a(3, series(20)), b(3, series(20));
  for (std::size_t k = 0; k < 3; ++k) {
    a[k].y[3] = 1000;  // B lost this sweep: A's outlier must not stand for the second
    b[k].y[3] = kNaN;
  }
  const SeriesComparison c = compare_series(pairs_of(a, b));
  EXPECT_DOUBLE_EQ(c.difference[0], 0);
}

TEST(CompareSeries, ABlockWithFewerThanThreeSeedsHasNoInterval) {
  std::vector<Series> a(3, series(20)), b(3, series(20, 2));
  for (std::size_t i = 10; i < 20; ++i) b[0].y[i] = kNaN;
  const SeriesComparison c = compare_series(pairs_of(a, b));
  EXPECT_TRUE(std::isfinite(c.difference[0]));
  EXPECT_TRUE(std::isnan(c.difference[1]));
  EXPECT_TRUE(std::isnan(c.low[1]));
}

TEST(CompareSeries, SeriesOfOtherTimesArePutOnTheFirstGrid) {
  std::vector<Series> a(3, series(20)), b(3, series(20, 3));
  for (Series& s : b)
    for (double& x : s.x) x += 0.04;  // another stamp convention
  b[1] = series(10, 3);               // and one that ended early
  const SeriesComparison c = compare_series(pairs_of(a, b));
  EXPECT_EQ(c.x, a[0].x);
  EXPECT_DOUBLE_EQ(c.b[5], 3);
  EXPECT_NEAR(c.difference[0], 2, 1e-12);
  EXPECT_TRUE(std::isnan(c.difference[1])) << "two seeds reach the second second";
}

TEST(CompareSeries, AShortRestAtTheEndBelongsToTheLastBlock) {
  const std::vector<Series> a(3, series(23)), b(3, series(23, 2));
  const SeriesComparison c = compare_series(pairs_of(a, b));
  EXPECT_EQ(c.difference.size(), 2U);
  ASSERT_EQ(c.stretches.size(), 1U);
  EXPECT_DOUBLE_EQ(c.stretches[0].to, a[0].x.back());
}

TEST(CompareSeries, RefusesNothingAndHalfPairs) {
  const Series s = series(10);
  EXPECT_THROW(compare_series({}), std::invalid_argument);
  const std::vector<SeriesPair> half = {{&s, nullptr}};
  EXPECT_THROW(compare_series(half), std::invalid_argument);
}

}  // namespace
}  // namespace tarmac::metrics
