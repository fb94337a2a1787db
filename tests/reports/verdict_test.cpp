// The sentence on top of the page says what the data support, and no more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reports/page.h"
#include "tests/reports/example.h"

namespace tarmac::reports {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// One run a seed; end_errors[estimator][seed].
std::vector<ReportRun> runs(const std::vector<std::pair<std::string, std::vector<double>>>& end_errors) {
  std::vector<ReportRun> list(end_errors.front().second.size());
  for (const auto& [name, values] : end_errors) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      list[s].evaluations.push_back(example::evaluation(name, s + 1, values[s]));
    }
  }
  return list;
}

TEST(Verdict, NamesTheLowestMedianAndByHowMuch) {
  const Verdict v = verdict(runs({{"worse", {0.8, 1.0, 1.2}}, {"better", {0.3, 0.25, 0.2}}}));
  EXPECT_THAT(v.sentence, StartsWith("better has the lowest end error: 0.25 %"));
  EXPECT_THAT(v.sentence, HasSubstr("median of 3 seeds, 0.20 % to 0.30 %"));
  EXPECT_THAT(v.sentence, HasSubstr("4.0 times less than worse with 1.00 %"));
  // ln(3/8), ln(1/4), ln(1/6): mean ln(1/4), and t(2; 0.975) = 4.303 standard errors of 0.234 to either side
  EXPECT_THAT(v.note, HasSubstr("more than chance"));
  EXPECT_THAT(v.note,
              HasSubstr("better has 0.25 times worse's end error (95 % interval 0.091 to 0.68, lower on 3 of 3"));
}

TEST(Verdict, TwoSeedsAreTooFewForChance) {
  const Verdict v = verdict(runs({{"a", {0.2, 0.2}}, {"b", {0.4, 0.5}}}));
  EXPECT_THAT(v.sentence, StartsWith("a has the lowest"));
  EXPECT_THAT(v.note, HasSubstr("Two seeds are too few"));
  EXPECT_THAT(v.note, Not(HasSubstr("more than chance")));
}

TEST(Verdict, SeedsThatGoThroughADifferenceOnlyTogetherSettleIt) {  // the ranges overlap, every single seed agrees
  const Verdict v = verdict(runs({{"a", {0.2, 0.4, 0.8, 1.6}}, {"b", {0.25, 0.49, 1.01, 1.99}}}));
  EXPECT_THAT(v.sentence, StartsWith("a has the lowest"));
  EXPECT_THAT(v.note, HasSubstr("more than chance"));
  EXPECT_THAT(v.note, HasSubstr("lower on 4 of 4 seeds"));
}

TEST(Verdict, NamesNoWinnerWhereChanceWouldDo) {
  const Verdict v = verdict(runs({{"a", {0.2, 0.3, 0.6}}, {"b", {0.35, 0.4, 0.5}}}));
  EXPECT_THAT(v.sentence, StartsWith("a and b do not differ significantly in end error: 0.30 % and 0.40 %"));
  EXPECT_THAT(v.sentence, Not(HasSubstr("lowest")));
  EXPECT_THAT(v.note, HasSubstr("do not settle which is better"));
}

TEST(Verdict, DoesNotMakeMuchOfOneSeed) {
  const Verdict v = verdict(runs({{"a", {0.2}}, {"b", {0.4}}}));
  EXPECT_THAT(v.note, HasSubstr("one seed"));
  EXPECT_THAT(v.note, Not(HasSubstr("overlap")));
}

TEST(Verdict, CountsFailuresAndLeavesTheirValuesOut) {
  auto list = runs({{"a", {0.2, 0.2}}, {"b", {0.1, 0.1}}});
  list[0].evaluations[1].status = "crashed";  // its row stays: a broken run may have left one
  list[1].evaluations[1] = example::failed("b", 2, "timed out", "");
  const Verdict v = verdict(list);
  EXPECT_THAT(v.sentence, StartsWith("a ends 0.20 %"));
  EXPECT_THAT(v.note, HasSubstr("b gave no result"));
  list[0].evaluations[1].status = "ok";
  EXPECT_THAT(verdict(list).note, HasSubstr("b gave no result in 1 of 2 runs"));
}

TEST(Verdict, TakesTheFinalEstimateOfABatchMethod) {
  auto list = runs({{"batch", {0.1}}, {"online", {0.3}}});
  for (auto& row : list[0].evaluations[0].rows) row.estimate = "final";
  EXPECT_THAT(verdict(list).sentence, StartsWith("batch has the lowest end error: 0.10 %"));
}

TEST(Verdict, NeverDividesByAPerfectEnd) {
  const Verdict v = verdict(runs({{"truth-replay", {0.0}}, {"b", {0.4}}}));
  EXPECT_THAT(v.sentence, HasSubstr("b follows with 0.40 %"));
  EXPECT_THAT(v.sentence, Not(HasSubstr("inf")));
}

metrics::Evaluation alone(const std::string& estimator, double end_x_m) {
  metrics::Evaluation evaluation;
  evaluation.estimator = estimator;
  evaluation.series.push_back({"path_estimate", "x [m]", "y [m]", {5, NAN, 6, 5 + end_x_m}, {0, NAN, 0, 0}, {}, {}});
  return evaluation;
}

TEST(Verdict, WithoutTruthSpeaksOfAgreementOnly) {
  std::vector<ReportRun> list(1);
  list[0].evaluations = {alone("a", 2), alone("b", 2.5), alone("c", 2.04)};
  const Verdict v = verdict(list);
  EXPECT_THAT(v.sentence, StartsWith("Nobody knows the true motion"));
  EXPECT_THAT(v.sentence, HasSubstr("a and b end 50 cm apart, after paths of 2.0 m and 2.5 m"));
  EXPECT_THAT(v.sentence, HasSubstr("would not make them right"));
  EXPECT_THAT(v.sentence, Not(HasSubstr("lowest")));
  list[0].evaluations = {alone("a", 2), example::failed("b", 1, "crashed", "boom")};
  EXPECT_THAT(verdict(list).sentence, HasSubstr("a covers 2.0 m."));
  EXPECT_THAT(verdict(list).note, HasSubstr("b gave no result"));
}

TEST(Verdict, IsPlainWhenNothingCame) {
  std::vector<ReportRun> list(1);
  list[0].evaluations.push_back(example::failed("a", 1, "crashed", "boom"));
  EXPECT_THAT(verdict(list).sentence, StartsWith("No estimator has an end error"));
  EXPECT_THAT(verdict(list).note, HasSubstr("a gave no result"));
  EXPECT_THAT(verdict({}).sentence, StartsWith("No estimator has an end error"));
}

}  // namespace
}  // namespace tarmac::reports
