// Paired comparison of two estimators over seeds.
#include "metrics/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace tarmac::metrics {
namespace {

Evaluation run(const std::string& estimator, std::uint64_t seed, double value) {
  Evaluation e;
  e.estimator = estimator;
  e.seed = seed;
  Row& row = e.rows.emplace_back();
  row.metric = "deskew_error_rms_m";
  row.value = value;
  return e;
}

std::vector<const Evaluation*> pointers(const std::vector<Evaluation>& list) {
  std::vector<const Evaluation*> out;
  for (const Evaluation& e : list) out.push_back(&e);
  return out;
}

/// Log ratios 0.1, 0.2, 0.3: mean 0.2, standard error 0.1 / sqrt(3); Student's t(0.975; 2) = 4.302653 (tables).
TEST(ComparePaired, MatchesTheHandComputedInterval) {
  const PairedComparison c = compare_paired({std::exp(0.1), 2 * std::exp(0.2), 7 * std::exp(0.3)}, {1, 2, 7});
  const double half = 4.302652729911275 * 0.1 / std::sqrt(3.0);
  EXPECT_EQ(c.pairs, 3U);
  EXPECT_EQ(c.a_lower, 0U);
  EXPECT_NEAR(c.ratio, std::exp(0.2), 1e-12);
  EXPECT_NEAR(c.low, std::exp(0.2 - half), 1e-9);
  EXPECT_NEAR(c.high, std::exp(0.2 + half), 1e-9);
  // t = 2 sqrt(3) with 2 degrees of freedom: p = 1 - t / sqrt(2 + t^2).
  const double t = 2 * std::sqrt(3.0);
  EXPECT_NEAR(c.p, 1 - t / std::sqrt(2 + t * t), 1e-12);
  EXPECT_EQ(c.difference, Difference::not_significant);
}

TEST(ComparePaired, ASteadyDifferenceIsOneAndSidesSwapWithTheOrder) {
  const std::vector<double> a = {0.9, 1.8, 2.73, 3.5, 4.6}, b = {1, 2, 3, 4, 5};
  EXPECT_EQ(compare_paired(a, b).difference, Difference::lower);
  EXPECT_EQ(compare_paired(b, a).difference, Difference::higher);
  EXPECT_EQ(compare_paired(a, b).a_lower, 5U);
  EXPECT_NEAR(compare_paired(a, b).ratio * compare_paired(b, a).ratio, 1, 1e-12);
  EXPECT_EQ(compare_paired(b, b).difference, Difference::not_significant);
}

TEST(ComparePaired, TwoSeedsSayNothingAndZeroesAreLeftOut) {
  EXPECT_EQ(compare_paired({1, 1}, {2, 2}).difference, Difference::too_few);
  const PairedComparison c = compare_paired({0, 1, std::nan(""), 1, 1}, {1, 2, 3, 0, 2});
  EXPECT_EQ(c.pairs, 2U);
  EXPECT_THROW(compare_paired({1}, {1, 2}), std::invalid_argument);
}

/// A common factor of 1 + 1e-13 is what another order of a sum makes: its scatter over the seeds is smaller still.
TEST(ComparePaired, RoundingIsNoDifferenceHoweverWellTheSeedsAgree) {
  const std::vector<double> b = {1, 2.1, 3.3, 4.7, 5.9};
  const auto times = [&](double factor) {
    std::vector<double> a;
    for (const double v : b) a.push_back(factor * v);
    return a;
  };
  const PairedComparison rounding = compare_paired(times(1 + 1e-13), b);
  EXPECT_EQ(rounding.difference, Difference::not_significant);
  EXPECT_EQ(rounding.p, 1);
  EXPECT_EQ(rounding.a_lower + rounding.b_lower, 0U);
  EXPECT_EQ(compare_paired(times(1 + 1e-9), b).difference, Difference::higher);
  std::vector<PairedComparison> list = {rounding, compare_paired(times(1.1), {1, 2, 3.4, 4.6, 6})};
  const double alone = list[1].p;
  judge_by_holm(list);
  EXPECT_EQ(list[1].p_adjusted, alone) << "what cannot be claimed is not counted";
  EXPECT_EQ(list[0].difference, Difference::not_significant);
}

TEST(ComparePaired, TurnedAroundIsWhatTheOtherOrderGives) {
  const std::vector<double> a = {0.9, 1.8, 2.73, 3.5, 5}, b = {1, 2, 3, 4, 5};  // a tie at last
  for (const std::size_t n : {std::size_t{5}, std::size_t{4}, std::size_t{2}}) {
    const std::vector<double> x(a.begin(), a.begin() + static_cast<long>(n)),
        y(b.begin(), b.begin() + static_cast<long>(n));
    const PairedComparison turned = turned_around(compare_paired(x, y)), other = compare_paired(y, x);
    EXPECT_EQ(turned.pairs, other.pairs);
    EXPECT_EQ(turned.a_lower, other.a_lower);
    EXPECT_EQ(turned.b_lower, other.b_lower);
    EXPECT_EQ(turned.difference, other.difference);
    EXPECT_NEAR(turned.ratio, other.ratio, 1e-12);
    EXPECT_NEAR(turned.low, other.low, 1e-12);
    EXPECT_NEAR(1 / turned.high, 1 / other.high, 1e-12);
  }
}

/// Two methods alike: over many experiments of 5 seeds, 5 % are called different by chance.
TEST(ComparePaired, CallsEqualMethodsDifferentAsOftenAsItSays) {
  constexpr int kExperiments = 4000;
  int claims = 0;
  for (int k = 0; k < kExperiments; ++k) {
    const core::RandomStream stream(static_cast<std::uint64_t>(k), "test/compare");
    std::vector<double> a, b;
    for (std::uint64_t s = 0; s < 5; ++s) {
      const double seed_effect = stream.normal(s, 0);
      a.push_back(std::exp(seed_effect + 0.1 * stream.normal(s, 1)));
      b.push_back(std::exp(seed_effect + 0.1 * stream.normal(s, 2)));
    }
    claims += compare_paired(a, b).difference != Difference::not_significant;
  }
  const double sigma = std::sqrt(kExperiments * 0.05 * 0.95);
  EXPECT_NEAR(claims, kExperiments * 0.05, 4 * sigma);
}

TEST(CompareAll, PairsSeedsAndLeavesOutFailedRuns) {
  std::vector<Evaluation> list;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    list.push_back(run("a", seed, 0.9 * static_cast<double>(seed)));
    list.push_back(run("b", 6 - seed, 1.0 * static_cast<double>(6 - seed)));  // in another order
  }
  list.back().status = "crashed";  // b, seed 1
  const auto comparisons = compare_all(pointers(list), "deskew_error_rms_m");
  ASSERT_EQ(comparisons.size(), 1U);
  EXPECT_EQ(comparisons[0].a, "a");
  EXPECT_EQ(comparisons[0].pairs, 4U);
  EXPECT_NEAR(comparisons[0].ratio, 0.9, 1e-12);
  EXPECT_EQ(comparisons[0].difference, Difference::lower);
  EXPECT_NE(in_words(comparisons[0]).find("0.9 times b's"), std::string::npos);
}

PairedComparison with_p(double p, double ratio = 2) {
  PairedComparison c;
  c.pairs = 5;
  c.b_lower = 5;
  c.p = c.p_adjusted = p;
  c.ratio = ratio;
  return c;
}

/// By hand: sorted p are 0.001, 0.012, 0.02, 0.03 and count 4, 3, 2, 1 times: 0.004, 0.036, 0.04, and 0.03, which is
/// raised to the 0.04 before it.
TEST(JudgeByHolm, AdjustsEachValueByHowManyAreLeft) {
  std::vector<PairedComparison> list = {with_p(0.02), with_p(0.001), with_p(0.03), with_p(0.012, 0.5)};
  judge_by_holm(list);
  EXPECT_DOUBLE_EQ(list[1].p_adjusted, 0.004);
  EXPECT_DOUBLE_EQ(list[3].p_adjusted, 0.036);
  EXPECT_DOUBLE_EQ(list[0].p_adjusted, 0.04);
  EXPECT_DOUBLE_EQ(list[2].p_adjusted, 0.04);
  EXPECT_EQ(list[1].difference, Difference::higher);
  EXPECT_EQ(list[3].difference, Difference::lower);
}

TEST(JudgeByHolm, WhatFailsHoldsBackAllThatFollow) {
  // 0.03 counts twice and fails; 0.04 alone would not.
  std::vector<PairedComparison> list = {with_p(0.04), with_p(0.03)};
  judge_by_holm(list);
  EXPECT_DOUBLE_EQ(list[1].p_adjusted, 0.06);
  EXPECT_DOUBLE_EQ(list[0].p_adjusted, 0.06);
  EXPECT_EQ(list[0].difference, Difference::not_significant);
  EXPECT_EQ(list[1].difference, Difference::not_significant);
}

TEST(JudgeByHolm, TooFewAndIdenticalOnesAreNotCounted) {
  std::vector<PairedComparison> list = {with_p(0.03)};
  for (int k = 0; k < 10; ++k) {
    list.push_back(compare_paired({1, 2, 3}, {1, 2, 3}));
    list.push_back(compare_paired({1, 2}, {2, 4}));
  }
  judge_by_holm(list);
  EXPECT_DOUBLE_EQ(list[0].p_adjusted, 0.03);
  EXPECT_EQ(list[0].difference, Difference::higher);
  EXPECT_EQ(list[1].difference, Difference::not_significant);
  EXPECT_EQ(list[2].difference, Difference::too_few);
}

/// 20 metrics of 2 alike builds on 5 seeds: a page with any false claim is to be one in twenty.
TEST(JudgeByHolm, HoldsTheChanceOfAnyFalseClaim) {
  constexpr int kPages = 2000, kRows = 20;
  int pages_with_claims = 0;
  for (int page = 0; page < kPages; ++page) {
    const core::RandomStream stream(static_cast<std::uint64_t>(page), "test/holm");
    std::vector<PairedComparison> rows;
    for (std::uint64_t row = 0; row < kRows; ++row) {
      std::vector<double> a, b;
      for (std::uint64_t s = 0; s < 5; ++s) {
        a.push_back(std::exp(0.1 * stream.normal(100 * row + s, 0)));
        b.push_back(std::exp(0.1 * stream.normal(100 * row + s, 1)));
      }
      rows.push_back(compare_paired(a, b));
    }
    judge_by_holm(rows);
    pages_with_claims += std::any_of(rows.begin(), rows.end(), [](const PairedComparison& c) {
      return c.difference == Difference::lower || c.difference == Difference::higher;
    });
  }
  const double sigma = std::sqrt(kPages * 0.05 * 0.95);
  EXPECT_LT(pages_with_claims, kPages * 0.05 + 4 * sigma);
  EXPECT_GT(pages_with_claims, kPages * 0.05 - 5 * sigma) << "no test at all would hold the chance too";
}

TEST(BetterOf, KnowsErrorsScoresAndWhatIsNeither) {
  EXPECT_EQ(better_of(*find_metric("deskew_error_rms_m")), Better::lower);
  EXPECT_EQ(better_of(*find_metric("coverage_percent")), Better::higher);
  EXPECT_EQ(better_of(*find_metric("degeneracy_solve_6dof_f1")), Better::higher);
  EXPECT_EQ(better_of(*find_metric("real_time_factor")), Better::higher);
  EXPECT_EQ(better_of(*find_metric("path_length_m")), Better::neither);
  EXPECT_EQ(better_of(*find_metric("oracle_degenerate_percent")), Better::neither);
}

TEST(DescribesDrive, IsTheTruePathAndTheOracleAlone) {
  std::vector<std::string> names;
  for (const MetricEntry& metric : metrics())
    if (describes_drive(metric)) names.emplace_back(metric.name);
  EXPECT_EQ(names, (std::vector<std::string>{"path_length_m", "oracle_degenerate_percent",
                                             "oracle_degenerate_12dof_percent", "oracle_lambda_min_6dof_median"}));
}

/// p of (a, b) is about 0.04: enough alone, not as the smallest of three.
TEST(CompareAll, ShareOutTheSignificanceOverSeveralPairs) {
  const std::vector<double> wobble = {0.02, 0.08, 0.01, 0.06, 0.03};
  std::vector<Evaluation> list;
  for (std::uint64_t s = 0; s < 5; ++s) {
    list.push_back(run("a", s, std::exp(wobble[s])));
    list.push_back(run("b", s, 1));
  }
  EXPECT_EQ(compare_all(pointers(list), "deskew_error_rms_m")[0].difference, Difference::higher);
  for (std::uint64_t s = 0; s < 5; ++s) list.push_back(run("c", s, std::exp(-0.5 * wobble[4 - s] + 0.02)));
  const auto comparisons = compare_all(pointers(list), "deskew_error_rms_m");
  ASSERT_EQ(comparisons.size(), 3U);
  EXPECT_GT(comparisons[0].p, 0.05 / 3);
  EXPECT_LT(comparisons[0].p, 0.05);
  EXPECT_EQ(comparisons[0].difference, Difference::not_significant);
  EXPECT_NE(in_words(comparisons[0]).find("do not differ significantly"), std::string::npos);
}

}  // namespace
}  // namespace tarmac::metrics
