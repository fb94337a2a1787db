#include "metrics/non_inferiority.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/random.h"

namespace {

using tarmac::core::RandomStream;
using namespace tarmac::metrics;
constexpr double kInf = std::numeric_limits<double>::infinity();

/// Baselines of 1 and new values of exp(d).
NonInferiority of_logs(const std::vector<double>& logs, const NonInferiorityRule& rule) {
  std::vector<double> now;
  for (const double d : logs) now.push_back(std::exp(d));
  return test_non_inferiority(now, std::vector<double>(logs.size(), 1.0), rule);
}

TEST(NonInferiority, TheSameValuesPassAtMarginZero) {
  const std::vector<double> values = {0.1, 0.2, 0.3, 0.4};
  const NonInferiority r = test_non_inferiority(values, values, {.margin = 0, .alpha = 0.01});
  EXPECT_EQ(r.verdict, NonInferiorityVerdict::pass);
  EXPECT_EQ(r.ratio, 1);
  EXPECT_EQ(r.log_sd, 0);
  EXPECT_EQ(r.p, 1);
  EXPECT_EQ(minimum_detectable_change(4, r.log_sd, {}), 0);
}

TEST(NonInferiority, BoundsAndPAreStudents) {
  // d = 0.01, 0.02, 0.03: mean 0.02, sd 0.01, error 0.01 / sqrt(3).
  const NonInferiority r = of_logs({0.01, 0.02, 0.03}, {.margin = 0, .alpha = 0.05});
  const boost::math::students_t t(2);
  const double error = 0.01 / std::sqrt(3.0), half = boost::math::quantile(t, 0.95) * error;
  EXPECT_NEAR(std::log(r.low), 0.02 - half, 1e-12);
  EXPECT_NEAR(std::log(r.high), 0.02 + half, 1e-12);
  EXPECT_NEAR(std::log(r.ci_low), 0.02 - boost::math::quantile(t, 0.975) * error, 1e-12);
  EXPECT_NEAR(r.p, 1 - boost::math::cdf(t, 0.02 / error), 1e-12);
  EXPECT_NEAR(r.log_sd, 0.01, 1e-12);
}

TEST(NonInferiority, FailsExactlyWhereTheLowerBoundExceedsTheMargin) {
  const std::vector<double> logs = {0.02, 0.03, 0.04, 0.05, 0.06};
  const double low = of_logs(logs, {.margin = 0, .alpha = 0.05}).low, high = of_logs(logs, {.margin = 0}).high;
  const auto verdict_at = [&](double margin) {
    const NonInferiority r = of_logs(logs, {.margin = margin, .alpha = 0.05});
    EXPECT_EQ(r.p < 0.05, r.verdict == NonInferiorityVerdict::fail) << "margin " << margin;
    return r.verdict;
  };
  EXPECT_EQ(verdict_at(low - 1 - 1e-6), NonInferiorityVerdict::fail);
  EXPECT_EQ(verdict_at(low - 1 + 1e-6), NonInferiorityVerdict::inconclusive);
  EXPECT_EQ(verdict_at(high - 1 - 1e-6), NonInferiorityVerdict::inconclusive);
  EXPECT_EQ(verdict_at(high - 1 + 1e-6), NonInferiorityVerdict::pass);
}

TEST(NonInferiority, HigherIsBetterTurnsTheRatioAround) {
  const std::vector<double> now = {90, 91, 89, 90.5}, before = {100, 100, 100, 100};
  const NonInferiorityRule higher{.margin = 0, .alpha = 0.05, .power = 0.8, .lower_is_better = false};
  EXPECT_EQ(test_non_inferiority(now, before, higher).verdict, NonInferiorityVerdict::fail);
  EXPECT_EQ(test_non_inferiority(before, now, higher).verdict, NonInferiorityVerdict::pass);
  EXPECT_GT(test_non_inferiority(now, before, higher).ratio, 1);
}

TEST(NonInferiority, TheSameWorseningOnEverySeedIsJudgedByTheMarginAlone) {
  const std::vector<double> before = {0.1, 0.7, 3}, now = {0.1 * 1.05, 0.7 * 1.05, 3 * 1.05};
  EXPECT_EQ(test_non_inferiority(now, before, {.margin = 0.04}).verdict, NonInferiorityVerdict::fail);
  EXPECT_EQ(test_non_inferiority(now, before, {.margin = 0.05}).verdict, NonInferiorityVerdict::pass);
}

TEST(NonInferiority, ValuesWithoutARatioHaveADefinedOutcome) {
  // Equal zeros are equal; a zero that became something is worse; something that became zero is no proof of anything.
  EXPECT_EQ(test_non_inferiority({0, 0, 0}, {0, 0, 0}, {}).verdict, NonInferiorityVerdict::pass);
  EXPECT_EQ(test_non_inferiority({0.1, 1, 1}, {0, 1, 1}, {}).verdict, NonInferiorityVerdict::fail);
  EXPECT_EQ(test_non_inferiority({0, 1, 1}, {0.1, 1, 1}, {}).verdict, NonInferiorityVerdict::inconclusive);
  EXPECT_EQ(test_non_inferiority({0, 1, 1}, {0.1, 1, 1}, {.lower_is_better = false}).verdict,
            NonInferiorityVerdict::fail);
  EXPECT_EQ(test_non_inferiority({-2, 1}, {-1, 1}, {.lower_is_better = false}).worse, 1u);
  EXPECT_THROW(test_non_inferiority({NAN}, {1}, {}), std::invalid_argument);
  EXPECT_THROW(test_non_inferiority({kInf}, {1}, {}), std::invalid_argument);
}

TEST(NonInferiority, OnePairSaysNothing) {
  const NonInferiority r = test_non_inferiority({2}, {1}, {});
  EXPECT_EQ(r.verdict, NonInferiorityVerdict::inconclusive);
}

TEST(NonInferiority, RefusesRulesThatMeanNothing) {
  EXPECT_THROW(test_non_inferiority({1, 2}, {1}, {}), std::invalid_argument);
  EXPECT_THROW(test_non_inferiority({1}, {1}, {.alpha = 0}), std::invalid_argument);
  EXPECT_THROW(test_non_inferiority({1}, {1}, {.power = 1}), std::invalid_argument);
  EXPECT_THROW(test_non_inferiority({1}, {1}, {.margin = -1}), std::invalid_argument);
}

/// The textbook's n = ((z_alpha + z_power) sd / delta)^2, which takes the sd for known.
double pairs_by_normal(double change, double sd, double alpha, double power) {
  const boost::math::normal z;
  const double sum = boost::math::quantile(z, 1 - alpha) + boost::math::quantile(z, power);
  return std::ceil(std::pow(sum * sd / std::log1p(change), 2));
}

TEST(Power, PairsNeededAreTheNormalFormulasAndOneOrTwoMore) {
  // 5 % at 80 % power, one-sided 5 %: 7 pairs at sd 0.05, 59 at 0.15 by the normal formula. Not knowing the sd costs
  // the t distribution's tails.
  const NonInferiorityRule rule{.margin = 0, .alpha = 0.05, .power = 0.8};
  EXPECT_EQ(pairs_by_normal(0.05, 0.05, 0.05, 0.8), 7);
  EXPECT_EQ(pairs_by_normal(0.05, 0.15, 0.05, 0.8), 59);
  for (const double sd : {0.05, 0.15}) {
    const std::size_t n = pairs_needed(0.05, sd, rule);
    const double normal = pairs_by_normal(0.05, sd, 0.05, 0.8);
    EXPECT_GT(n, normal) << "sd " << sd;
    EXPECT_LE(n, normal + 2) << "sd " << sd;
    EXPECT_GE(power_of_paired_test(n, std::log(1.05), sd, 0.05), 0.8);
    EXPECT_LT(power_of_paired_test(n - 1, std::log(1.05), sd, 0.05), 0.8);
  }
}

TEST(Power, IsTheShareOfSimulatedComparisonsThatFail) {
  // 10 pairs, sd 0.04, a true worsening by 5 %, one-sided 1 %.
  const double delta = std::log(1.05), sd = 0.04;
  const int trials = 10000;
  const RandomStream draws(1, "test/power");
  int failed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> logs;
    for (std::uint32_t k = 0; k < 10; ++k)
      logs.push_back(delta + sd * draws.normal(static_cast<std::uint64_t>(trial), k));
    failed += of_logs(logs, {.margin = 0, .alpha = 0.01}).verdict == NonInferiorityVerdict::fail;
  }
  const double share = static_cast<double>(failed) / trials;
  const double power = power_of_paired_test(10, delta, sd, 0.01);
  EXPECT_NEAR(share, power, 4 * std::sqrt(power * (1 - power) / trials));
}

TEST(Power, WithoutAChangeItIsAlpha) {
  for (const double alpha : {0.01, 0.05}) EXPECT_NEAR(power_of_paired_test(10, 0, 0.04, alpha), alpha, 1e-9);
}

TEST(Power, TheDetectableChangeIsSeenWithTheWantedPower) {
  for (const double sd : {0.001, 0.04, 0.5})
    for (const std::size_t n : {2u, 3u, 10u, 60u}) {
      const NonInferiorityRule rule{.margin = 0.02, .alpha = 0.01, .power = 0.8};
      const double change = minimum_detectable_change(n, sd, rule);
      EXPECT_NEAR(power_of_paired_test(n, std::log1p(change) - std::log1p(0.02), sd, 0.01), 0.8, 1e-6)
          << "sd " << sd << " n " << n;
    }
}

TEST(Power, GrowsWithPairsAndShrinksWithSpread) {
  const NonInferiorityRule rule{.alpha = 0.01};
  EXPECT_LT(minimum_detectable_change(20, 0.04, rule), minimum_detectable_change(10, 0.04, rule));
  EXPECT_LT(minimum_detectable_change(10, 0.02, rule), minimum_detectable_change(10, 0.04, rule));
  EXPECT_GT(pairs_needed(0.05, 0.08, rule), pairs_needed(0.05, 0.04, rule));
  EXPECT_EQ(minimum_detectable_change(1, 0.04, rule), kInf);
  EXPECT_THROW(pairs_needed(0, 0.04, rule), std::invalid_argument);
  EXPECT_THROW(pairs_needed(1e-9, 10, rule), std::invalid_argument);
}

TEST(Power, HoldsWhereTheSeriesWouldNotConverge) {
  EXPECT_EQ(power_of_paired_test(10, 1, 1e-6, 0.01), 1);
  EXPECT_EQ(power_of_paired_test(10, 1, 0, 0.01), 1);
  EXPECT_EQ(power_of_paired_test(10, 0, 0, 0.01), 0);
}

TEST(Holm, MultipliesByTheNumberOfRowsThatAreLeftAndNeverFalls) {
  // In order 0.01, 0.02, 0.03, 0.9: times 4, 3, 2, 1, each at least the one before.
  const std::vector<double> adjusted = holm_adjusted({0.03, 0.9, 0.01, 0.02});
  ASSERT_EQ(adjusted.size(), 4u);
  EXPECT_DOUBLE_EQ(adjusted[2], 4 * 0.01);
  EXPECT_DOUBLE_EQ(adjusted[3], 3 * 0.02);
  EXPECT_DOUBLE_EQ(adjusted[0], 3 * 0.02);  // 2 * 0.03 as well
  EXPECT_DOUBLE_EQ(adjusted[1], 0.9);
  EXPECT_DOUBLE_EQ(holm_adjusted({0.04, 0.03})[0], 0.06);  // 1 * 0.04 would fall below 2 * 0.03
  EXPECT_EQ(holm_adjusted({0.7, 0.8})[1], 1);
  EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(Holm, HoldsTheChanceOfAnyFalseRedOverCorrelatedRows) {
  // Five rows without a change whose spread is half shared: at most alpha of the trials have any red.
  const int trials = 5000;
  const double alpha = 0.05;
  const RandomStream draws(2, "test/holm");
  int red = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> p;
    for (std::uint32_t row = 0; row < 5; ++row) {
      std::vector<double> logs;
      for (std::uint32_t k = 0; k < 6; ++k)
        logs.push_back(draws.normal(static_cast<std::uint64_t>(trial), k) +
                       draws.normal(static_cast<std::uint64_t>(trial), 100 + 10 * row + k));
      p.push_back(of_logs(logs, {.alpha = alpha}).p);
    }
    const std::vector<double> adjusted = holm_adjusted(p);
    red += std::any_of(adjusted.begin(), adjusted.end(), [&](double q) { return q < alpha; });
  }
  EXPECT_LT(static_cast<double>(red) / trials, alpha + 4 * std::sqrt(alpha * (1 - alpha) / trials));
  EXPECT_GT(red, 0);
}

}  // namespace
