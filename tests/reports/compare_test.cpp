// What a comparison says: words, the page's data, Markdown.
#include "reports/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "reports/compare_markdown.h"
#include "reports/compare_page.h"
#include "tests/reports/data_block.h"

namespace tarmac::reports {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

CompareRow row(const std::string& metric, CompareVerdict verdict, double ratio) {
  CompareRow r;
  r.case_name = "loop";
  r.estimator_a = r.estimator_b = "kiss-icp";
  r.metric = metric;
  r.unit = "m";
  r.estimate = "causal";
  r.better = metrics::Better::lower;
  r.seeds = 5;
  r.b_better = ratio < 1 ? 5 : 0;
  r.a_median = 0.1;
  r.b_median = 0.1 * ratio;
  r.comparison.pairs = 5;
  r.comparison.ratio = ratio;
  r.comparison.low = 0.9 * ratio;
  r.comparison.high = 1.1 * ratio;
  r.comparison.difference = metrics::Difference::not_significant;
  r.verdict = verdict;
  return r;
}

CompareInput input(std::vector<CompareRow> rows) {
  CompareInput in;
  in.a.label = "main";
  in.b.label = "branch";
  in.rows = std::move(rows);
  in.same_recordings = 5;
  return in;
}

TEST(CompareWords, NameTheLargestSignificantChangeNotTheLargestRatio) {
  const CompareSummary s = summary_of(input({row("ate_se3_rmse_m", CompareVerdict::no_difference, 9),
                                             row("deskew_error_rms_m", CompareVerdict::worse, 2),
                                             row("rpe_1s_trans_rmse_m", CompareVerdict::better, 0.25)}));
  EXPECT_EQ(s.tested, 3U);
  EXPECT_THAT(s.sentence, HasSubstr("branch (B) against main (A): 1 worse and 1 better of 3 comparisons"));
  EXPECT_THAT(s.sentence, HasSubstr("rpe_1s_trans_rmse_m (loop, kiss-icp): 0.25 times A's"));
  EXPECT_THAT(s.sentence, Not(HasSubstr("ate_se3")));
}

TEST(CompareWords, SayThatNothingDiffersAndThatAllIsIdentical) {
  EXPECT_THAT(summary_of(input({row("ate_se3_rmse_m", CompareVerdict::no_difference, 9)})).sentence,
              HasSubstr("do not differ significantly"));
  const CompareSummary same = summary_of(input({row("ate_se3_rmse_m", CompareVerdict::identical, 1)}));
  EXPECT_THAT(same.sentence, HasSubstr("are identical"));
  EXPECT_EQ(same.tested, 0U);
  EXPECT_THAT(summary_of(input({row("ate_se3_rmse_m", CompareVerdict::too_few, 2)})).sentence,
              HasSubstr("fewer than 3 seeds"));
  EXPECT_THAT(summary_of(input({})).sentence, HasSubstr("no result in common"));
}

TEST(CompareWords, ACrashIsNotHiddenByIdenticalNumbers) {
  CompareInput in = input({row("ate_se3_rmse_m", CompareVerdict::identical, 1)});
  in.missing = {{kNoResultInB, "kiss-icp on case loop", "crashed: seeds 2", 1}};
  EXPECT_THAT(summary_of(in).sentence, HasSubstr("B gave no result in 1 run that A finished"));
  in = input({row("ate_se3_rmse_m", CompareVerdict::identical, 1), row("end_error_m", CompareVerdict::too_few, 3)});
  EXPECT_THAT(summary_of(in).sentence, Not(HasSubstr("are identical")));
  EXPECT_THAT(summary_of(in).sentence, HasSubstr("1 more cannot be judged"));
}

TEST(CompareWords, SayWhetherTheRecordingsAreTheSame) {
  CompareInput in = input({row("ate_se3_rmse_m", CompareVerdict::worse, 2)});
  EXPECT_THAT(summary_of(in).note, HasSubstr("same recordings (5 drives)"));
  in.same_recordings = 3;
  in.different_recordings = 2;
  in.different = {"loop seed 1", "loop seed 4"};
  EXPECT_THAT(summary_of(in).note, HasSubstr("differ on 2 of 5 drives (loop seed 1, loop seed 4)"));
  EXPECT_THAT(summary_of(in).note, HasSubstr("may be the simulator's"));
  EXPECT_THAT(assemble_compare_page(in), HasSubstr("<p class=\"note\">The recordings differ"));
}

TEST(CompareWords, CostsAreNoPartOfTheVerdict) {
  CompareRow cost = row("sweep_time_p50_ms", CompareVerdict::worse, 50);
  cost.cost = true;
  const CompareSummary s = summary_of(input({cost, row("ate_se3_rmse_m", CompareVerdict::no_difference, 1.1)}));
  EXPECT_EQ(s.tested, 1U);
  EXPECT_EQ(s.worse, 0U);
  EXPECT_THAT(s.sentence, HasSubstr("do not differ"));
}

TEST(CompareWords, ARowThatOnlyItsOwnIntervalClearsIsCalledNotSettled) {
  CompareRow r = row("ate_se3_rmse_m", CompareVerdict::no_difference, 1.3);
  r.comparison.p = 0.03;
  EXPECT_EQ(words_of(r), "not settled");
  r.comparison.p = 0.3;
  EXPECT_EQ(words_of(r), "not significant");
  r.verdict = CompareVerdict::different;
  EXPECT_EQ(words_of(r), "higher");
}

TEST(ComparePage, HoldsRowsDrivesAndWhatIsMissing) {
  CompareInput in = input({row("deskew_error_rms_m", CompareVerdict::worse, 2)});
  CompareRow few = row("ate_se3_rmse_m", CompareVerdict::too_few, 3);
  few.comparison.difference = metrics::Difference::too_few;
  few.comparison.high = std::numeric_limits<double>::infinity();
  in.rows.push_back(few);
  CompareDrive drive{"loop", "kiss-icp", "kiss-icp", 5, true, {}, 1, {1, 2}, {10, 11}, {0, 1}};
  metrics::SeriesComparison series;
  series.name = "deskew_error_vs_time";
  series.x = {1, 2};
  series.a = {0.1, std::numeric_limits<double>::quiet_NaN()};
  series.b = {0.2, 0.3};
  series.block_x = {1.5};
  series.difference = {0.1};
  series.low = {0.05};
  series.high = {0.15};
  series.stretches = {{1, 2, 0.1}};
  drive.series = {series};
  in.drives = {drive};
  in.missing = {{"only in A", "case old", "seeds 1..5", 5}};
  const json data = data_of(assemble_compare_page(in));
  ASSERT_EQ(data["rows"].size(), 2U);
  EXPECT_EQ(data["rows"][0]["verdict"], "worse");
  EXPECT_EQ(data["rows"][0]["ratio"], 2);
  EXPECT_EQ(data["rows"][0]["better"], "lower");
  EXPECT_TRUE(data["rows"][1]["low"].is_null()) << "no interval of too few";
  EXPECT_TRUE(data["rows"][1]["high"].is_null());
  EXPECT_TRUE(data["metrics"].contains("deskew_error_rms_m"));
  EXPECT_EQ(data["drives"][0]["series"][0]["stretches"][0]["from"], 1);
  EXPECT_TRUE(data["drives"][0]["series"][0]["a"][1].is_null());
  EXPECT_EQ(data["drives"][0]["path"]["x"], json({10, 11}));
  EXPECT_EQ(data["missing"][0]["kind"], "only in A");
  EXPECT_EQ(data["recordings"]["same"], 5);
}

TEST(ComparePage, RefersToNothingOutsideAndNothingBreaksOut) {
  CompareInput in = input({row("<script>alert(1)</script>", CompareVerdict::worse, 2)});
  in.b.label = "</script><img src=x onerror=alert(1)>";
  in.missing = {{"no result in B", "x", "crashed (</script>)", 1}};
  const std::string page = assemble_compare_page(in);
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(data_of(page)["missing"][0]["detail"], "crashed (</script>)");
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_FALSE(std::regex_search(page, std::regex("<(link|iframe|img)\\b")));
}

TEST(CompareMarkdown, BeginsWithTheVerdictAndFoldsWhatIsNotSignificant) {
  CompareInput in = input({row("deskew_error_rms_m", CompareVerdict::worse, 1.5),
                           row("ate_se3_rmse_m", CompareVerdict::no_difference, 1.2)});
  in.missing = {{"only in A", "case old", "seeds 1..5", 5},
                {"no result in B", "x on case loop", "crashed: seeds 2", 1}};
  const std::string text = compare_markdown(in, "page.html");
  const std::size_t fold = text.find("<details>");
  ASSERT_NE(fold, std::string::npos);
  EXPECT_LT(text.find("**branch (B) against main (A): 1 worse of 2 comparisons"), fold);
  const std::size_t changed =
      text.find("| worse | loop, kiss-icp | deskew\\_error\\_rms\\_m | 0.100 | 0.150 | +50 % |");
  EXPECT_LT(changed, fold) << text;
  EXPECT_GT(text.find("| not significant | loop, kiss-icp | ate"), fold);
  EXPECT_THAT(text, HasSubstr("Not significant (1)"));
  EXPECT_THAT(text, HasSubstr("Not compared: 1 no result in B, 5 only in A"));
  EXPECT_THAT(text, HasSubstr("The page: page.html"));
}

TEST(CompareMarkdown, AnIdenticalPairIsOneSentence) {
  const std::string text = compare_markdown(input({row("ate_se3_rmse_m", CompareVerdict::identical, 1)}));
  EXPECT_THAT(text, HasSubstr("are identical"));
  EXPECT_THAT(text, Not(HasSubstr("| worse")));
  EXPECT_THAT(text, Not(HasSubstr("<details>")));
}

TEST(CompareMarkdown, NothingInATextEndsACellOrCallsSomebody) {
  CompareRow r = row("a|b", CompareVerdict::worse, 2);
  r.case_name = "x\n@all <b>";
  const std::string text = compare_markdown(input({r}));
  EXPECT_THAT(text, HasSubstr("| worse | x &#64;all &lt;b&gt;, kiss-icp | a\\|b |"));
}

TEST(CompareMarkdown, ALongTableEndsWithACount) {
  std::vector<CompareRow> rows;
  for (int k = 0; k < 75; ++k) rows.push_back(row("m" + std::to_string(k), CompareVerdict::no_difference, 1.1));
  EXPECT_THAT(compare_markdown(input(rows)), HasSubstr("and 15 more"));
}

}  // namespace
}  // namespace tarmac::reports
