#include "metrics/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "metrics/pool.h"
#include "metrics/registry.h"
#include "metrics/row_set.h"

namespace tarmac::metrics::tests {
namespace {

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.95), 7);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Rms, IsTheRootOfTheMeanSquare) {
  EXPECT_DOUBLE_EQ(rms({3, 4}), std::sqrt(12.5));
}

TEST(SquaredHistogram, QuantilesAreWithinHalfABinOfSortedValuesOverTwelveDecades) {
  const core::RandomStream stream(3, "test/histogram");
  SquaredHistogram<10> histogram;
  std::vector<double> magnitudes;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    magnitudes.push_back(std::pow(10, -9 + 12 * stream.uniform(i)));
    histogram.add(magnitudes.back() * magnitudes.back());
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  for (const double q : {0.001, 0.05, 0.5, 0.95, 0.999}) {
    const double exact = magnitudes[static_cast<std::size_t>(std::ceil(q * 20000)) - 1];
    EXPECT_NEAR(histogram.quantile(q), exact, 3e-4 * exact) << q;
  }
}

TEST(SquaredHistogram, AddsUpInAnyOrderAndKeepsExtremes) {
  SquaredHistogram<6> a, b, ab;
  for (const double e : {0.0, 1e-30, 0.5, 3.0, 1e9}) {
    (e < 1 ? a : b).add(e * e);
    ab.add(e * e);
  }
  b.add(a);
  EXPECT_EQ(b.total(), 5u);
  for (const double q : {0.1, 0.3, 0.5, 0.7, 1.0}) EXPECT_EQ(b.quantile(q), ab.quantile(q));
  EXPECT_EQ(ab.quantile(0.4), 0);
  EXPECT_GT(ab.quantile(1), 9e5);
  EXPECT_TRUE(std::isnan(SquaredHistogram<6>().quantile(0.5)));
}

TEST(RowSet, KnowsUnitsAndReasonsAndRefusesUnknownNames) {
  RowSet rows("final");
  rows.put("ate_se3_rmse_m", 2, "on a line");
  rows.put("end_error_percent", std::nan(""));
  rows.all_missing("nothing");
  EXPECT_THROW(rows.put("ate_rmse", 1), std::logic_error);
  const std::vector<Row> made = rows.rows();
  ASSERT_EQ(made.size(), metrics().size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(made[i].metric, metrics()[i].name);
    EXPECT_EQ(made[i].unit, metrics()[i].unit);
    EXPECT_EQ(made[i].estimate, "final");
    EXPECT_EQ(made[i].status, made[i].metric == "ate_se3_rmse_m"      ? "ok: on a line"
                              : made[i].metric == "end_error_percent" ? "n/a: the value is not finite"
                                                                      : "n/a: nothing");
  }
}

TEST(Registry, EveryNameEndsInItsUnit) {
  for (const MetricEntry& metric : metrics()) {
    const std::string name = metric.name, unit = metric.unit;
    const std::string ending = unit == "%"          ? "_percent"
                               : unit == "MB"       ? "_mb"
                               : unit == "1"        ? ""
                               : unit == "m/s"      ? "_m_per_s"
                               : unit == "deg/100m" ? "_deg_per_100m"
                                                    : "_" + unit;
    EXPECT_TRUE(name.ends_with(ending)) << name << " in " << unit;
    EXPECT_EQ(find_metric(name), &metric);
  }
  EXPECT_EQ(find_metric("ate"), nullptr);
}

Evaluation seed_with(double ate, std::optional<double> end_percent) {
  Evaluation e;
  RowSet rows("causal");
  rows.put("ate_se3_rmse_m", ate);
  rows.put_or_missing("end_error_percent", end_percent, "short");
  e.rows = rows.rows();
  return e;
}

/// P(Binomial(5, 1/2) = 0) = 1/32: the range of 5 holds the median with 1 - 2/32.
TEST(Pool, FiveSeedsGiveTheMedianWithTheirRange) {
  std::vector<Evaluation> seeds;
  for (const double ate : {0.5, 0.1, 0.4, 0.2, 0.3}) seeds.push_back(seed_with(ate, std::nullopt));
  seeds[3].rows[1].value = 7;
  seeds[3].rows[1].status = "ok";
  std::vector<const Evaluation*> pointers;
  for (const Evaluation& e : seeds) pointers.push_back(&e);
  const std::vector<PooledRow> rows = pool(pointers);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(*rows[0].row.value, 0.3);
  EXPECT_DOUBLE_EQ(*rows[0].row.ci_low, 0.1);
  EXPECT_DOUBLE_EQ(*rows[0].row.ci_high, 0.5);
  EXPECT_DOUBLE_EQ(rows[0].confidence, 0.9375);
  EXPECT_EQ(rows[0].row.status, "ok");
  EXPECT_DOUBLE_EQ(*rows[1].row.value, 7);
  EXPECT_EQ(rows[1].row.status, "ok: 1 of 5 seeds");
  EXPECT_FALSE(rows[1].row.ci_low);
}

/// P(Binomial(10, 1/2) < 2) = 11/1024; with 3 it would be 56/1024, and 1 - 2 of it below 0.9. By the same sums
/// P(Binomial(20, 1/2) < 6) = 21700/2^20 and < 7 = 60460/2^20: 1 - 2 x 0.05766 = 0.8847 is below 0.9.
TEST(Pool, IntervalRanksFollowTheBinomial) {
  double confidence = 0;
  EXPECT_EQ(median_interval_rank(4, confidence), 0u);
  EXPECT_EQ(confidence, 0);
  EXPECT_EQ(median_interval_rank(10, confidence), 2u);
  EXPECT_NEAR(confidence, 1 - 22.0 / 1024, 1e-12);
  EXPECT_EQ(median_interval_rank(20, confidence), 6u);
  EXPECT_NEAR(confidence, 1 - 2 * 21700.0 / 1048576, 1e-12);
}

TEST(Pool, OneSeedStaysAsItIs) {
  const Evaluation e = seed_with(0.25, std::nullopt);
  const std::vector<PooledRow> rows = pool({&e});
  EXPECT_DOUBLE_EQ(*rows[0].row.value, 0.25);
  EXPECT_FALSE(rows[0].row.ci_low);
  EXPECT_EQ(rows[1].row.status, "n/a: short");
  EXPECT_TRUE(pool({}).empty());
}

}  // namespace
}  // namespace tarmac::metrics::tests
