#include "scenarios/baseline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace tarmac::scenarios;
using tarmac::core::InputError;
using testing::HasSubstr;

MetricValue metric(const std::string& name, std::optional<double> value, const std::string& estimate = "causal") {
  MetricValue row;
  row.estimate = estimate;
  row.metric = name;
  row.value = value;
  return row;
}

CellResult cell(const std::string& case_name, const std::string& estimator, std::uint64_t seed, double rpe) {
  CellResult result;
  result.cell.case_name = case_name;
  result.cell.scenario = "quick-brake";
  result.cell.estimator = estimator;
  result.cell.seed = seed;
  result.outcome.recording_hash = "hash-" + std::to_string(seed);
  result.metrics = {metric("rpe_m", rpe), metric("ate_m", 10 * rpe)};
  return result;
}

std::vector<CellResult> some_results() {
  return {cell("b 'quoted': {x}", "kiss-icp", 2, 0.1), cell("b 'quoted': {x}", "kiss-icp", 1, 1.0 / 3),
          cell("a", "ct-icp", 10, 1e-9), cell("a", "ct-icp", 9, 0)};
}

TEST(Baseline, ComesBackExactlyAsItWasWritten) {
  tarmac::tests::TemporaryFolder folder;
  Baseline baseline = make_baseline(some_results(), {"rpe_m"});
  baseline.sweeps = {"a sweep", "regression"};
  baseline.build = "0.1.0 (abc: 'x')";
  const BaselineKey key{"a", "ct-icp", "rpe_m", "causal"};
  baseline.values[key][11] = std::nullopt;
  save_baseline(folder.path() / "b.yaml", baseline);
  const Baseline read = load_baseline(folder.path() / "b.yaml");
  EXPECT_EQ(read.sweeps, baseline.sweeps);
  EXPECT_EQ(read.build, baseline.build);
  EXPECT_EQ(read.recordings, baseline.recordings);
  EXPECT_EQ(read.values, baseline.values) << "to the last bit";
  EXPECT_EQ(read.scenario_of, baseline.scenario_of);
}

TEST(Baseline, TheSameResultsInAnyOrderGiveTheSameText) {
  std::vector<CellResult> results = some_results();
  const std::string text = baseline_text(make_baseline(results, {"rpe_m", "ate_m"}));
  std::reverse(results.begin(), results.end());
  EXPECT_EQ(baseline_text(make_baseline(results, {"ate_m", "rpe_m"})), text);
}

TEST(Baseline, ALineHoldsOneCaseEstimatorAndMetric) {
  const std::string text = baseline_text(make_baseline(some_results(), {"rpe_m"}));
  EXPECT_THAT(text, HasSubstr("{case: 'a', scenario: 'quick-brake', estimator: 'ct-icp', estimate: causal, metric: "
                              "rpe_m, values: {9: 0, 10: 1.0000000000000001e-09}}\n"));
}

TEST(Baseline, KeepsTheMetricsThatAreNamedAndNoFailedRun) {
  std::vector<CellResult> results = some_results();
  results[0].outcome.status = "crashed";
  results[3].metrics[0].value = std::nullopt;
  const Baseline baseline = make_baseline(results, {"rpe_m"});
  EXPECT_EQ(baseline.values.size(), 2u);
  EXPECT_EQ(baseline.values.at({"b 'quoted': {x}", "kiss-icp", "rpe_m", "causal"}).count(2), 0u);
  EXPECT_EQ(baseline.values.at({"a", "ct-icp", "rpe_m", "causal"}).at(9), std::nullopt);
}

TEST(Baseline, RefusesACellThatComesTwice) {
  std::vector<CellResult> results = some_results();
  results.push_back(results[0]);
  EXPECT_THROW(make_baseline(results, {"rpe_m"}), InputError);
}

TEST(Baseline, SaysWhereAFileIsWrong) {
  tarmac::tests::TemporaryFolder folder;
  const auto file = folder.path() / "b.yaml";
  const std::string head = "format: 1\nsweeps: [s]\nbuild: b\nrecordings: []\n";
  const std::string line = "{case: a, scenario: s, estimator: e, estimate: causal, metric: m, values: ";
  const auto error_of = [&](const std::string& text) -> std::string {
    tarmac::core::write_file(file, text);
    try {
      load_baseline(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("format: 2\n"), HasSubstr("baseline update"));
  EXPECT_THAT(error_of(head + "values:\n  - " + line + "{1: abc}}\n"), HasSubstr("b.yaml:6"));
  EXPECT_THAT(error_of(head + "values:\n  - " + line + "{1: nan}}\n"), HasSubstr("no number"));
  EXPECT_THAT(error_of(head + "values:\n  - " + line + "{x: 1}}\n"), HasSubstr("no seed"));
  EXPECT_THAT(error_of(head + "values:\n  - " + line + "{1: 1}}\n  - " + line + "{2: 1}}\n"), HasSubstr("twice"));
  EXPECT_THAT(error_of(head + "values:\n  - {case: a}\n"), HasSubstr("estimator"));
  EXPECT_EQ(error_of(head + "values: []\n"), "no error");
}

TEST(Baseline, TheDifferenceSaysWhatChangedWhatIsNewAndWhatIsGone) {
  const std::vector<CellResult> results = some_results();
  const Baseline before = make_baseline(results, {"rpe_m"});
  std::vector<CellResult> later = {cell("b 'quoted': {x}", "kiss-icp", 1, 0.5),
                                   cell("b 'quoted': {x}", "kiss-icp", 2, 0.5), cell("c", "kiss-icp", 1, 1)};
  later[0].outcome.recording_hash = "other";
  const BaselineDifference difference = difference_of(before, make_baseline(later, {"rpe_m"}));
  ASSERT_EQ(difference.changes.size(), 3u);
  EXPECT_EQ(difference.changes[0].kind, BaselineChange::Kind::gone);
  EXPECT_EQ(difference.changes[1].kind, BaselineChange::Kind::changed);
  const double median_before = 0.5 * (0.1 + 1.0 / 3);
  EXPECT_DOUBLE_EQ(*difference.changes[1].before, median_before);
  EXPECT_DOUBLE_EQ(*difference.changes[1].change_percent, 100 * (0.5 / median_before - 1));
  EXPECT_EQ(difference.changes[2].kind, BaselineChange::Kind::added);
  EXPECT_EQ(difference.recordings_shared, 2u);
  EXPECT_EQ(difference.recordings_changed, 1u);
  EXPECT_EQ(difference_of(before, before).changes.size(), 0u);
  EXPECT_EQ(difference_of(before, before).unchanged, 2u);
}

TEST(FindValue, TheHeadlineIsCausalWhereThereIsSuchARow) {
  CellResult result;
  result.metrics = {metric("m", 1.0, "final"), metric("m", 2.0)};
  EXPECT_EQ(*find_value(result, "m")->value, 2);
  EXPECT_EQ(*find_value(result, "m", "final")->value, 1);
  result.metrics[1].value = std::nullopt;
  EXPECT_EQ(find_value(result, "m")->value, std::nullopt) << "n/a is not replaced by the final estimate";
  EXPECT_EQ(find_value(result, "m", "causal")->value, std::nullopt);
  EXPECT_EQ(find_value(result, "other"), nullptr);
  result.metrics.pop_back();
  EXPECT_EQ(*find_value(result, "m")->value, 1) << "a batch method has a final estimate only";
}

}  // namespace
