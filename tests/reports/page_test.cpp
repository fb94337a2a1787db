// The page as text: what is in it, what is not, and that nothing a user wrote can break out.
#include "reports/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "reports/page_series.h"
#include "reports/web_bundle.h"
#include "tests/reports/data_block.h"
#include "tests/reports/example.h"

namespace tarmac::reports {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

const json& run_of(const json& data, const std::string& estimator, std::uint64_t seed) {
  for (const json& run : data["runs"]) {
    if (run["estimator"] == estimator && run["seed"] == seed) return run;
  }
  throw std::runtime_error("no run of " + estimator);
}

/// The x of a series: the page writes every distinct one once.
const json& x_of(const json& data, const json& series) {
  return data["grids"][series["x"].get<std::size_t>()];
}

TEST(PageData, HoldsTheSeriesOfEveryFigureForEveryEstimatorAndSeed) {
  const json data = data_of(assemble_page(example::input(), {}));
  EXPECT_EQ(data["seeds"], json({1, 2}));
  EXPECT_EQ(data["picture_time_s"], 0);
  EXPECT_EQ(data["estimators"], json({"steady", "shaky"}));
  for (const int seed : {1, 2}) {
    for (const char* name :
         {"path_estimate", "error_vs_distance", "drift_vs_distance", "reference_error_by_phase",
          "deskew_error_by_phase", "deskew_error_vs_time", "sweep_time_vs_time", "iterations_vs_time"}) {
      const json& series = run_of(data, "steady", seed)["series"];
      ASSERT_TRUE(series.contains(name)) << name;
      EXPECT_EQ(x_of(data, series[name]).size(), series[name]["y"].size()) << name;
    }
  }
}

TEST(PageData, WritesWhatBelongsToTheTruthOnceASeed) {
  const json data = data_of(assemble_page(example::input(), {}));
  for (const char* name : {"path_true", "speed_vs_time", "yaw_rate_vs_time"}) {
    EXPECT_TRUE(data["truth"]["1"].contains(name)) << name;
    EXPECT_TRUE(data["truth"]["2"].contains(name)) << name;
    EXPECT_FALSE(run_of(data, "steady", 1)["series"].contains(name)) << name;
  }
}

TEST(PageData, KeepsValuesBandsAndGaps) {
  const ReportInput input = example::input();
  const json data = data_of(assemble_page(input, {}));
  const json& run = run_of(data, "shaky", 1);
  const metrics::Evaluation& source = input.runs[0].evaluations[1];
  const metrics::Series& phase = *source.find("reference_error_by_phase");
  EXPECT_DOUBLE_EQ(run["series"]["reference_error_by_phase"]["y"][3], phase.y[3]);
  EXPECT_DOUBLE_EQ(run["series"]["reference_error_by_phase"]["high"][3], phase.high[3]);
  EXPECT_TRUE(x_of(data, run["series"]["path_estimate"])[0].is_null()) << "NaN is a gap, not a number";
  EXPECT_DOUBLE_EQ(run["rows"][0]["value"], *source.rows[0].value);
}

TEST(PageData, SaysWhyACellIsEmpty) {
  const json data = data_of(assemble_page(example::input(), {}));
  const json& rows = run_of(data, "steady", 1)["rows"];
  const json& none =
      *std::find_if(rows.begin(), rows.end(), [](const json& r) { return r["metric"] == "ate_none_rmse_m"; });
  EXPECT_TRUE(none["value"].is_null());
  EXPECT_EQ(none["status"], "n/a: no initial pose is given");
  const json& crashed = run_of(data, "shaky", 2);
  EXPECT_EQ(crashed["status"], "crashed");
  EXPECT_EQ(crashed["message"], "signal 11 after sweep 7");
  EXPECT_EQ(crashed["log"], "seed-2/shaky/log.txt");
  EXPECT_EQ(crashed["rows"][0]["status"], "failed: crashed");
}

TEST(PageData, ExplainsItsMetricsByTheRegistry) {
  const json data = data_of(assemble_page(example::input(), {}));
  const json& entry = data["metrics"]["deskew_error_rms_m"];
  EXPECT_EQ(entry["unit"], "m");
  EXPECT_EQ(entry["lower_is_better"], true);
  EXPECT_GT(entry["meaning"].get<std::string>().size(), 20u);
}

TEST(PageData, NamesTheCommandAndKeepsProvenanceAsItWasWritten) {
  ReportInput input = example::input();
  json data = data_of(assemble_page(input, {}));
  EXPECT_EQ(data["command"], "tarmac run example.yaml --seed 1..2");
  EXPECT_EQ(data["provenance"][1]["text"], input.runs[1].provenance_json);
  EXPECT_EQ(data["provenance"][1]["folder"], "seed-2") << "never a path of the machine";
  input.runs[0].provenance_json = "no json";
  data = data_of(assemble_page(input, {}));
  EXPECT_EQ(data["command"], "tarmac run example.yaml --seed 1..2") << "the next run still says it";
}

TEST(PageData, ThinsLongSeriesSoThatAPageStaysSmall) {
  ReportInput input;
  input.runs.resize(1);
  for (int e = 0; e < 20; ++e) {
    metrics::Evaluation evaluation = example::evaluation("e" + std::to_string(e), 1, 1);
    metrics::Series& series = evaluation.series[1];  // path_estimate
    series.x.clear();
    series.y.clear();
    for (int k = 0; k < 30000; ++k) {
      series.x.push_back(k + 0.123456);
      series.y.push_back(-k);
    }
    for (int copy = 0; copy < 10; ++copy) {
      evaluation.series.push_back(series);
      evaluation.series.back().name = "more_" + std::to_string(copy);
    }
    input.runs[0].evaluations.push_back(evaluation);
  }
  const std::string page = assemble_page(input, {});
  EXPECT_LT(page.size(), 6e6);
  const json data = data_of(page);
  const json& series = run_of(data, "e7", 1)["series"]["path_estimate"];
  const std::size_t step = series["step"];
  EXPECT_GT(step, 1u);
  EXPECT_DOUBLE_EQ(series["y"][5], -5.0 * static_cast<double>(step)) << "every step-th sample, from the first on";
}

TEST(PageData, WritesAnAxisThatSeriesShareOnce) {
  const json data = data_of(assemble_page(example::input(), {}));
  const json& steady = run_of(data, "steady", 1)["series"];
  EXPECT_EQ(steady["deskew_error_vs_time"]["x"], steady["sweep_time_vs_time"]["x"]);
  EXPECT_EQ(steady["deskew_error_vs_time"]["x"], run_of(data, "shaky", 1)["series"]["deskew_error_vs_time"]["x"]);
  EXPECT_NE(steady["deskew_error_vs_time"]["x"], steady["path_estimate"]["x"]);
  std::set<std::string> texts;
  for (const json& grid : data["grids"]) texts.insert(grid.dump());
  EXPECT_EQ(texts.size(), data["grids"].size());
}

ReportInput three_seeds() {
  ReportInput input;
  const double better[] = {0.20, 0.31, 0.39}, worse[] = {0.40, 0.60, 0.80};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    input.runs.emplace_back();
    input.runs.back().evaluations = {example::evaluation("worse", seed, worse[seed - 1]),
                                     example::evaluation("better", seed, better[seed - 1])};
  }
  return input;
}

TEST(PageData, ComparesEstimatorsSeedBySeedInBothDirections) {
  const json list = data_of(assemble_page(three_seeds(), {}))["comparisons"];
  const auto find = [&](const char* a, const char* b, const char* metric) {
    for (const json& c : list) {
      if (c["a"] == a && c["b"] == b && c["metric"] == metric) return c;
    }
    throw std::runtime_error("no such comparison");
  };
  const json one = find("better", "worse", "end_error_percent"), other = find("worse", "better", "end_error_percent");
  const double ratio = std::cbrt(0.20 * 0.31 * 0.39 / (0.40 * 0.60 * 0.80));  // geometric mean
  EXPECT_NEAR(one["ratio"], ratio, 1e-5);
  EXPECT_NEAR(other["ratio"], 1 / ratio, 1e-5);
  EXPECT_EQ(one["difference"], "lower");
  EXPECT_EQ(other["difference"], "higher");
  EXPECT_EQ(one["a_lower"], 3);
  EXPECT_EQ(other["a_lower"], 0);
  EXPECT_LT(one["high"], 1);
  EXPECT_NEAR(one["low"].get<double>() * other["high"].get<double>(), 1, 1e-5);
  EXPECT_EQ(find("better", "worse", "deskew_error_rms_m")["difference"], "not_significant") << "equal on every seed";
}

TEST(PageData, GivesNoIntervalWhereSeedsAreTooFew) {
  const json list = data_of(assemble_page(example::input(), {}))["comparisons"];  // one of two seeds crashed
  ASSERT_FALSE(list.empty());
  for (const json& c : list) {
    EXPECT_EQ(c["difference"], "too_few");
    EXPECT_EQ(c["pairs"], 1);
    EXPECT_TRUE(c["low"].is_null() && c["high"].is_null());
  }
  ReportInput one_seed = example::input();
  one_seed.runs.resize(1);
  EXPECT_TRUE(data_of(assemble_page(one_seed, {}))["comparisons"].empty());
}

TEST(PageData, TellsFindingsWithTheirEvidence) {
  ReportInput input = example::input();
  metrics::Finding finding;
  finding.topic = "clock-offset";
  finding.verdict = metrics::Finding::Verdict::found;
  finding.words = "Clocks differ.";
  finding.evidence = {{"offset", 5.02, "ms", 4.9, 5.1}, {"left", std::nullopt, "m", std::nullopt, std::nullopt}};
  input.runs[0].evaluations[1].findings = {finding};
  const json data = data_of(assemble_page(input, {}));
  const json& findings = run_of(data, "shaky", 1)["findings"];
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0]["topic"], "clock-offset");
  EXPECT_EQ(findings[0]["verdict"], "found") << "the word that the page's script goes by";
  EXPECT_EQ(findings[0]["words"], "Clocks differ.");
  EXPECT_EQ(findings[0]["evidence"][0]["value"], 5.02);
  EXPECT_EQ(findings[0]["evidence"][0]["high"], 5.1);
  EXPECT_TRUE(findings[0]["evidence"][1]["value"].is_null());
  EXPECT_TRUE(run_of(data, "steady", 1)["findings"].empty());
}

TEST(PageData, KeepsWhatBelongsToTheOracleWithTheTruth) {
  ReportInput input = example::input();
  for (auto& run : input.runs) {
    for (auto& evaluation : run.evaluations) {
      if (evaluation.series.empty()) continue;
      evaluation.series.push_back(
          {"oracle_lambda_min_6dof_vs_time", "time [s]", "eigenvalue [1]", {0, 1}, {2, 3}, {}, {}});
      evaluation.series.push_back({"path_degenerate", "x [m]", "y [m]", {0, 1}, {2, 3}, {}, {}});
      evaluation.series.push_back({"lambda_min_6dof_vs_time", "time [s]", "eigenvalue [1]", {0, 1}, {4, 5}, {}, {}});
    }
  }
  const json data = data_of(assemble_page(input, {}));
  for (const char* name : {"oracle_lambda_min_6dof_vs_time", "path_degenerate"}) {
    EXPECT_TRUE(data["truth"]["1"].contains(name)) << name;
    EXPECT_FALSE(run_of(data, "steady", 1)["series"].contains(name)) << name;
  }
  EXPECT_TRUE(run_of(data, "steady", 1)["series"].contains("lambda_min_6dof_vs_time"));
}

TEST(PageSeries, ShortOnesLeaveTheirShareToTheLong) {
  std::vector<ReportRun> runs(1);
  metrics::Evaluation evaluation;
  const auto add = [&](std::size_t samples, bool band) {
    metrics::Series series;
    series.x.assign(samples, 0);
    series.y.assign(samples, 0);
    if (band) series.low = series.high = series.y;
    evaluation.series.push_back(series);
  };
  add(100, true);    // 4 columns
  add(5000, false);  // 2
  add(3000, false);  // 2
  runs[0].evaluations = {evaluation};
  EXPECT_EQ(longest_series(runs, 16400), 5000u) << "all fits: 400 + 10000 + 6000";
  EXPECT_EQ(longest_series(runs, 12400), 3000u) << "the longest alone gives way: 400 + 2*3000 + 2*3000";
  EXPECT_EQ(longest_series(runs, 8400), 2000u) << "both long ones: 400 + 2*2000 + 2*2000";
  EXPECT_EQ(longest_series(runs, 10), kMinSamplesEach) << "a curve must stay one";
  EXPECT_EQ(longest_series({}, 10), kMinSamplesEach);
}

TEST(Page, RefersToNothingOutsideOfItself) {
  const std::string page = assemble_page(example::input(), {});
  EXPECT_THAT(page, Not(HasSubstr("http://")));
  EXPECT_THAT(page, Not(HasSubstr("https://")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_FALSE(std::regex_search(page, std::regex(R"(<[^>]*\s(src|href)\s*=\s*"(?!data:))")));
  EXPECT_FALSE(std::regex_search(std::string(page_style()), std::regex(R"(url\()")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'")) << "the browser refuses whatever slips through";
}

TEST(Page, CarriesTheLicenceOfTheLinesItDraws) {
  EXPECT_THAT(std::string(page_script()), HasSubstr("uPlot"));
  EXPECT_THAT(std::string(page_script()), HasSubstr("Permission is hereby granted"));
}

TEST(Page, TextOfUsersStaysText) {
  ReportInput input = example::input();
  const std::string hostile = "</script><script>alert(1)</script>";
  input.title = input.why = input.surprise = hostile;
  input.runs[0].evaluations[0].estimator = hostile;
  input.runs[1].evaluations[1].message = hostile;
  input.runs[0].provenance_json = "{\"command\": \"" + hostile + "\"}";
  const std::string page = assemble_page(input, {});
  const std::string plain = assemble_page(example::input(), {});
  EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_EQ(run_of(data_of(page), "shaky", 2)["message"], hostile) << "and arrives whole";
}

TEST(Page, BytesThatAreNoTextDoNotStopIt) {
  ReportInput input = example::input();
  input.runs[1].evaluations[1].message = "log: \xff\xfe";
  EXPECT_THAT(data_of(assemble_page(input, {}))["runs"].back()["message"].get<std::string>(), HasSubstr("log: "));
}

TEST(Page, ShowsWhyThereAreNoPictures) {
  Pictures pictures;
  pictures.note = "no EGL here";
  EXPECT_EQ(data_of(assemble_page(example::input(), pictures))["pictures"]["note"], "no EGL here");
}

TEST(Page, EmbedsPicturesWithTheirPlaceInTheWorld) {
  Pictures pictures;
  pictures.top = Picture{"image/jpeg", "foobar", 200, 100};
  pictures.top_view = top_view({-20, -10}, {20, 10}, 200);
  pictures.maps.push_back({"steady", 1, {"image/jpeg", "fo", 20, 10}});
  const json data = data_of(assemble_page(example::input(), pictures))["pictures"];
  EXPECT_EQ(data["top"]["src"], "data:image/jpeg;base64,Zm9vYmFy");  // RFC 4648, section 10
  EXPECT_EQ(data["maps"][0]["src"], "data:image/jpeg;base64,Zm8=");
  EXPECT_EQ(data["top"]["min_m"], json({-20.0, -10.0}));
  EXPECT_EQ(data["top"]["max_m"], json({20.0, 10.0}));
}

TEST(Base64, EndsWithTheRightPadding) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("\xff\xff\xfe"), "///+");
}

}  // namespace
}  // namespace tarmac::reports
