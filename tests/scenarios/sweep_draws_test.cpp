// Draws of a sweep: strata, balance, independence of the axes, and the distribution of values.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/sweep_axes.h"
#include "tests/scenarios/sweep_support.h"

namespace tarmac::scenarios {
namespace {

using testing::Each;
using testing::ElementsAreArray;

std::vector<double> numbers(const std::vector<std::string>& texts) {
  std::vector<double> out;
  for (const std::string& text : texts) out.push_back(std::stod(text));
  return out;
}

Axis range(double from, double to, bool log = false, bool integer = false) {
  return {"motion.a", {}, AxisRange{from, to, log, integer}};
}

DrawOptions options(int count, const std::string& method, std::int64_t seed = 1) {
  return {count, method, seed};
}

TEST(LatinHypercube, HasExactlyOneDrawInEachPartOfARange) {
  for (const bool log : {false, true}) {
    for (const int count : {1, 2, 7, 100, 1000}) {
      for (const std::int64_t seed : {1, 2, 3}) {
        const double from = 0.3, to = 47;
        std::vector<int> in_part(static_cast<std::size_t>(count));
        for (const double v :
             numbers(draw_values(range(from, to, log), options(count, "latin-hypercube", seed), "b"))) {
          ASSERT_GE(v, from);
          ASSERT_LE(v, to);
          const double share = log ? std::log(v / from) / std::log(to / from) : (v - from) / (to - from);
          ++in_part[std::min(static_cast<std::size_t>(share * count), in_part.size() - 1)];
        }
        EXPECT_THAT(in_part, Each(1)) << (log ? "log " : "linear ") << count << " draws, seed " << seed;
      }
    }
  }
}

/// A category has whole parts; a whole number may gain or lose the two parts that it shares with its neighbours.
TEST(LatinHypercube, GivesEveryCategoryAndEveryWholeNumberItsShare) {
  const Axis categories{"rig.b", {"x", "y", "z"}, std::nullopt};
  for (const int count : {3, 7, 30, 100}) {
    for (const Axis& axis : {categories, range(4, 6, false, true)}) {
      std::map<std::string, int> times;
      for (const std::string& v : draw_values(axis, options(count, "latin-hypercube"), "b")) ++times[v];
      ASSERT_EQ(times.size(), 3U) << count;
      for (const auto& [value, n] : times) EXPECT_NEAR(n, count / 3.0, axis.range ? 2 : 1) << value << " of " << count;
    }
  }
}

TEST(LatinHypercube, ShufflesTheAxesAgainstEachOther) {
  // Rank correlation of independent permutations has a standard deviation of 1/sqrt(n - 1).
  const int n = 400;
  Axis a = range(0, 1), b = range(0, 1);
  b.path = "motion.b";
  const std::vector<double> x = numbers(draw_values(a, options(n, "latin-hypercube"), "b"));
  const std::vector<double> y = numbers(draw_values(b, options(n, "latin-hypercube"), "b"));
  double sum = 0, neighbours = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - 0.5) * (y[i] - 0.5);
  for (std::size_t i = 1; i < x.size(); ++i) neighbours += (x[i] - 0.5) * (x[i - 1] - 0.5);
  const double four_sigma = 4 / std::sqrt(n - 1.0);
  EXPECT_LT(std::abs(12 * sum / n), four_sigma);
  EXPECT_LT(std::abs(12 * neighbours / n), four_sigma);
}

TEST(RandomDraws, AreUniformInTheValueOrInItsLogarithm) {
  const int n = 4000;
  for (const bool log : {false, true}) {
    const std::vector<double> values = numbers(draw_values(range(1, 100, log), options(n, "random"), "b"));
    double mean = 0, square = 0;
    for (const double v : values) {
      const double u = log ? std::log(v) / std::log(100.0) : (v - 1) / 99;
      ASSERT_TRUE(u >= 0 && u <= 1);
      mean += u / n;
      square += u * u / n;
    }
    EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1.0 / 12 / n));
    EXPECT_NEAR(square, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
  }
}

TEST(RandomDraws, DrawWholeNumbersAndCategoriesEquallyOften) {
  const int n = 6000;
  const Axis categories{"rig.b", {"x", "y", "z"}, std::nullopt};
  for (const Axis& axis : {categories, range(4, 6, false, true)}) {
    std::map<std::string, int> times;
    for (const std::string& v : draw_values(axis, options(n, "random"), "b")) ++times[v];
    ASSERT_EQ(times.size(), 3U);
    for (const auto& [value, k] : times) EXPECT_NEAR(k, n / 3.0, 4 * std::sqrt(n * 2.0 / 9)) << value;
  }
}

TEST(RandomDraws, MoreOfThemBeginWithTheSame) {
  const std::vector<std::string> few = draw_values(range(1, 100), options(10, "random"), "b");
  std::vector<std::string> more = draw_values(range(1, 100), options(50, "random"), "b");
  more.resize(few.size());
  EXPECT_EQ(few, more);
}

TEST(Draws, DependOnSeedBlockAndPath) {
  for (const char* method : {"random", "latin-hypercube"}) {
    const auto base = draw_values(range(0, 1), options(20, method), "b");
    EXPECT_EQ(base, draw_values(range(0, 1), options(20, method), "b"));
    EXPECT_NE(base, draw_values(range(0, 1), options(20, method, 2), "b"));
    EXPECT_NE(base, draw_values(range(0, 1), options(20, method), "c"));
    Axis other = range(0, 1);
    other.path = "motion.b";
    EXPECT_NE(base, draw_values(other, options(20, method), "b"));
  }
}

TEST(Draws, AreWrittenWithFewDigits) {
  for (const std::string& text : draw_values(range(2, 8), options(20, "latin-hypercube"), "b"))
    EXPECT_LE(text.size(), 8U) << text;
  for (const std::string& text : draw_values(range(2, 8), options(20, "random"), "b"))
    EXPECT_LE(text.size(), 9U) << text;
}

TEST_F(SweepFileTest, AnotherAxisDoesNotChangeTheDrawsOfTheFirst) {
  const std::string begin =
      "    name: b\n    draw: {count: 12, method: latin-hypercube, over: {motion.a: {from: 1, to: 2}";
  const SweepFile one = load_block(begin + "}}\n");
  const SweepFile two = load_block(begin + ", motion.z: [x, y], rig.c: {from: 1, to: 9, integer: true}}}\n");
  ASSERT_EQ(one.cells.size(), 12U);
  EXPECT_EQ(values(one, "motion.a"), values(two, "motion.a"));
  const SweepFile before = load_block(
      "    name: b\n    draw: {count: 12, method: latin-hypercube, over: {faults.y: [1, 2], motion.a: {from: 1, to: "
      "2}}}\n");
  EXPECT_EQ(values(one, "motion.a"), values(before, "motion.a"));
}

TEST_F(SweepFileTest, EveryCombinationOfTheGridHasTheSameDraws) {
  const SweepFile sweep =
      load_block("    vary: {rig.m: [p, q]}\n    draw: {count: 5, seed: 7, over: {motion.a: {from: 1, to: 2}}}\n");
  ASSERT_EQ(sweep.cells.size(), 10U);
  const std::vector<std::string> drawn = values(sweep, "motion.a");
  EXPECT_THAT(std::vector<std::string>(drawn.begin(), drawn.begin() + 5),
              ElementsAreArray(drawn.begin() + 5, drawn.end()));
  EXPECT_EQ(std::set<std::string>(drawn.begin(), drawn.end()).size(), 5U);
}

TEST_F(SweepFileTest, DrawsThatAreTheSameAreOneCell) {
  const SweepFile sweep = load_block("    draw: {count: 50, over: {rig.m: [p, q]}}\n");
  EXPECT_EQ(sweep.cells.size(), 2U);
}

TEST_F(SweepFileTest, ADrawnOptionOfOneEstimatorLeavesTheOthersAlone) {
  const SweepFile sweep = load_block(
      "    draw: {count: 6, over: {estimators.kiss-icp.v: {from: 0.2, to: 2, scale: log}}}\n", "[kiss-icp, ct-icp]");
  EXPECT_EQ(sweep.cells.size(), 7U);
}

}  // namespace
}  // namespace tarmac::scenarios
