// `tarmac compare` on fabricated folders: runs and stores whose differences are known.
#include "tools/compare/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "metrics/evaluation.h"
#include "reports/compare_markdown.h"
#include "reports/compare_page.h"
#include "scenarios/store.h"
#include "tests/support/temporary_folder.h"
#include "tools/compare/pairing.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/outcome.h"
#include "tools/tarmac/provenance.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using reports::CompareInput;
using reports::CompareRow;
using reports::CompareVerdict;
using tarmac::tests::message_of;
using tarmac::tests::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Values that differ from seed to seed, and what multiplies them.
struct Made {
  double deskew = 1, ate = 1, time = 1;
  double path = 1;  ///< of the true path that is scored
  double late = 0;  ///< added to the deskew error from 2 s on [m]
  std::string status = "ok";
};

metrics::Evaluation evaluation(const std::string& scenario, std::uint64_t seed, const std::string& estimator,
                               const Made& made) {
  metrics::Evaluation e;
  e.scenario = scenario;
  e.seed = seed;
  e.estimator = estimator;
  e.status = made.status;
  if (made.status != "ok") {
    e.message = "it fell over";
    return e;
  }
  const double hard = 1 + 0.3 * static_cast<double>(seed % 3);  // a seed's own effect, on all alike
  const auto put = [&](const char* metric, double value, const char* unit) {
    metrics::Row& row = e.rows.emplace_back();
    row.metric = metric;
    row.value = value;
    row.unit = unit;
  };
  put("deskew_error_rms_m", 0.02 * hard * made.deskew, "m");
  put("ate_se3_rmse_m", 0.3 * hard * made.ate, "m");
  put("coverage_percent", 100, "%");
  put("path_length_m", 60 * hard * made.path, "m");
  put("time_lag_ms", seed % 2 ? 1.5 : -1.5, "ms");
  put("sweep_time_p50_ms", 20 * hard * made.time, "ms");
  metrics::Series deskew{"deskew_error_vs_time", "time [s]", "deskew error [m]", {}, {}, {}, {}};
  metrics::Series path{"path_true", "x [m]", "y [m]", {}, {}, {}, {}};
  metrics::Series speed{"speed_vs_time", "time [s]", "true speed [m/s]", {}, {}, {}, {}};
  for (int i = 0; i < 40; ++i) {
    const double t = 0.05 + 0.1 * i;
    deskew.x.push_back(t);
    deskew.y.push_back(0.02 * hard + (t > 2 ? made.late * hard : 0));
    path.x.push_back(5 * t);
    path.y.push_back(1);
    speed.x.push_back(t);
    speed.y.push_back(5);
  }
  e.series = {deskew, path, speed};
  return e;
}

void make_estimate(const fs::path& root, const metrics::Evaluation& e) {
  const fs::path folder = root / e.estimator;
  fs::create_directories(folder);
  metrics::save_evaluation(folder, e);
  Outcome outcome;
  outcome.estimator = e.estimator;
  outcome.status = e.status;
  save_outcome(folder, outcome);
}

void make_provenance(const fs::path& root, const std::string& scenario, std::uint64_t seed,
                     const std::string& recording_hash) {
  Provenance p;
  p.scenario = scenario;
  p.seed = seed;
  p.recording_hash = recording_hash;
  p.truth = "truth";
  p.command = "tarmac run";
  fs::create_directories(root);
  save_provenance(root / "provenance.json", p);
}

/// DIR/seed-1 .. seed-n of the scenario "loop".
void make_runs(const fs::path& folder, const std::map<std::string, Made>& estimators, std::uint64_t seeds = 5,
               const std::string& recording = "aa") {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const fs::path root = folder / ("seed-" + std::to_string(seed));
    for (const auto& [name, made] : estimators) make_estimate(root, evaluation("loop", seed, name, made));
    make_provenance(root, "loop", seed, recording + std::to_string(seed));
  }
}

CompareInput compare(const fs::path& a, const fs::path& b, const std::string& of_a = "", const std::string& of_b = "") {
  CompareSettings settings;
  settings.a = a;
  settings.b = b;
  settings.estimator_a = of_a;
  settings.estimator_b = of_b;
  return compare_folders(settings, {});
}

const CompareRow& row(const CompareInput& input, const std::string& metric, const std::string& estimator) {
  for (const CompareRow& r : input.rows)
    if (r.metric == metric && r.estimator_b == estimator) return r;
  throw std::runtime_error("no row " + metric);
}

std::vector<std::string> lines(const CompareInput& input) {
  std::vector<std::string> out;
  for (const auto& m : input.missing) out.push_back(m.kind + ": " + m.what + ": " + m.detail);
  return out;
}

TEST(Compare, TheSameResultsAreCalledIdentical) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}, {"ct-icp", {.deskew = 0.5}}});
  make_runs(folder / "b", {{"kiss-icp", {}}, {"ct-icp", {.deskew = 0.5}}});
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_THAT(input.rows, SizeIs(10));
  for (const CompareRow& r : input.rows) EXPECT_EQ(r.verdict, CompareVerdict::identical) << r.metric;
  EXPECT_THAT(reports::summary_of(input).sentence, HasSubstr("are identical"));
  EXPECT_EQ(input.same_recordings, 5U);
  EXPECT_THAT(input.missing, IsEmpty());
  for (const auto& drive : input.drives) {
    EXPECT_FALSE(drive.located);
    for (const auto& series : drive.series) EXPECT_THAT(series.stretches, IsEmpty());
  }
}

TEST(Compare, ADoubledMetricIsFoundAndNothingElse) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}, {"ct-icp", {}}});
  make_runs(folder / "b", {{"kiss-icp", {.deskew = 2, .time = 3}}, {"ct-icp", {}}});
  const CompareInput input = compare(folder / "a", folder / "b");
  const CompareRow& deskew = row(input, "deskew_error_rms_m", "kiss-icp");
  EXPECT_EQ(deskew.verdict, CompareVerdict::worse);
  EXPECT_NEAR(deskew.comparison.ratio, 2, 1e-12);
  EXPECT_EQ(deskew.b_better, 0U);
  EXPECT_EQ(deskew.seeds, 5U);
  EXPECT_EQ(reports::significant_rows(input).size(), 1U);
  const CompareRow& time = row(input, "sweep_time_p50_ms", "kiss-icp");
  EXPECT_TRUE(time.cost);
  EXPECT_EQ(time.verdict, CompareVerdict::worse);
  const reports::CompareSummary summary = reports::summary_of(input);
  EXPECT_THAT(summary.sentence, HasSubstr("1 worse of 1 comparison"));
  EXPECT_EQ(summary.identical, 7U);
  EXPECT_THAT(reports::compare_markdown(input), HasSubstr("| worse | loop, kiss-icp | deskew"));
}

/// Noise of a build upon itself, alike in size on both sides, is none.
TEST(Compare, WobbleIsNoDifference) {
  const TemporaryFolder folder;
  const double wobble[] = {1.1, 0.92, 1.03, 0.95, 1.01};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const bool b : {false, true}) {
      const fs::path root = folder / (b ? "b" : "a") / ("seed-" + std::to_string(seed));
      make_estimate(root, evaluation("loop", seed, "kiss-icp", {.ate = b ? wobble[seed - 1] : 1}));
      make_provenance(root, "loop", seed, "aa");
    }
  }
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_EQ(row(input, "ate_se3_rmse_m", "kiss-icp").verdict, CompareVerdict::no_difference);
  EXPECT_THAT(reports::significant_rows(input), IsEmpty());
  EXPECT_THAT(reports::summary_of(input).sentence, HasSubstr("do not differ significantly"));
}

TEST(Compare, TwoEstimatorsOfOneFolder) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}, {"ct-icp", {.deskew = 0.5}}, {"third", {}}});
  const CompareInput input = compare(folder / "a", folder / "a", "kiss-icp", "ct-icp");
  EXPECT_EQ(input.a.label, "kiss-icp");
  EXPECT_EQ(input.b.label, "ct-icp");
  EXPECT_THAT(input.rows, SizeIs(5));
  const CompareRow& deskew = row(input, "deskew_error_rms_m", "ct-icp");
  EXPECT_EQ(deskew.estimator_a, "kiss-icp");
  EXPECT_EQ(deskew.verdict, CompareVerdict::better);
  EXPECT_NEAR(deskew.comparison.ratio, 0.5, 1e-12);
  EXPECT_EQ(deskew.b_better, 5U);
  EXPECT_THAT(input.missing, IsEmpty()) << "others were not asked for";
}

TEST(Compare, WhatOnlyOneSideHasIsListed) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}, {"old", {}}});
  make_runs(folder / "b", {{"kiss-icp", {}}, {"new", {}}}, 7);
  make_estimate(folder / "b" / "seed-2", evaluation("loop", 2, "kiss-icp", {.status = "crashed"}));
  metrics::Evaluation more = evaluation("loop", 3, "kiss-icp", {});
  more.rows.push_back({"causal", "of_a_new_build_m", 1.0, "m", {}, {}, "ok"});
  make_estimate(folder / "b" / "seed-3", more);
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_THAT(lines(input), testing::UnorderedElementsAre(
                                "only in A: old on case loop: seeds 1..5", "only in B: new on case loop: seeds 1..7",
                                "no result in B: kiss-icp on case loop: crashed (it fell over): seeds 2",
                                "only in B: kiss-icp on case loop: seeds 6, 7",
                                "value only in B: metric of_a_new_build_m: loop kiss-icp"));
  EXPECT_EQ(row(input, "ate_se3_rmse_m", "kiss-icp").seeds, 4U);
  const std::string text = reports::compare_markdown(input);
  EXPECT_THAT(text, HasSubstr("Not compared: 1 no result in B, 5 only in A, 9 only in B, 1 value only in B"));
}

TEST(Compare, RecordingsThatDifferAreSaid) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}}, 3, "aa");
  make_runs(folder / "b", {{"kiss-icp", {.ate = 2}}}, 3, "bb");
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_EQ(input.different_recordings, 3U);
  EXPECT_THAT(reports::summary_of(input).note, HasSubstr("differ on 3 of 3 drives (loop seed 1, loop seed 2"));
}

TEST(Compare, NothingInCommonSaysWhatThereIs) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}}, 3);
  make_runs(folder / "b", {{"ct-icp", {}}}, 3);
  const std::string message = message_of<core::InputError>([&] { (void)compare(folder / "a", folder / "b"); });
  EXPECT_THAT(message, HasSubstr("A has cases: loop; estimators: kiss-icp; seeds: 1..3"));
  EXPECT_THAT(message, HasSubstr("B has cases: loop; estimators: ct-icp; seeds: 1..3"));
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare(folder / "a", folder / "b", "kiss-icq", "ct-icp"); }),
              HasSubstr("has no estimator 'kiss-icq' (did you mean 'kiss-icp'?)"));
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare(folder / "a", folder / "none"); }),
              HasSubstr("there is no such folder"));
  CompareSettings settings{folder / "a", folder / "a", "", "", {"ate_se3_rmse"}, "", false};
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare_folders(settings, {}); }),
              HasSubstr("no metric 'ate_se3_rmse' (did you mean 'ate_se3_rmse_m'?)"));
  settings.metrics.clear();
  settings.case_name = "lop";
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare_folders(settings, {}); }),
              HasSubstr("has no case 'lop' (did you mean 'loop'?)"));
}

TEST(Compare, MetricsAndCasesCanBeChosen) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}}, 3);
  CompareSettings settings{folder / "a", folder / "a", "", "", {"ate_se3_rmse_m"}, "loop", false};
  const CompareInput input = compare_folders(settings, {});
  ASSERT_THAT(input.rows, SizeIs(1));
  EXPECT_EQ(input.rows[0].metric, "ate_se3_rmse_m");
  EXPECT_THAT(input.drives, IsEmpty()) << "not asked for";
}

/// The true path between the first and the last scored pose is longer by the same share on every seed.
TEST(Compare, WhatDescribesTheDriveIsComparedOnlyWhenNamed) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}});
  make_runs(folder / "b", {{"kiss-icp", {.path = 1.0001}}});
  EXPECT_THAT(reports::summary_of(compare(folder / "a", folder / "b")).sentence, HasSubstr("are identical"));
  CompareSettings settings{folder / "a", folder / "b", "", "", {"path_length_m"}, "", false};
  const CompareInput named = compare_folders(settings, {});
  ASSERT_THAT(named.rows, SizeIs(1));
  EXPECT_EQ(named.rows[0].verdict, CompareVerdict::different);
}

TEST(Compare, FewerThanThreeSeedsClaimNothing) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}}, 2);
  make_runs(folder / "b", {{"kiss-icp", {.ate = 100}}}, 2);
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_EQ(row(input, "ate_se3_rmse_m", "kiss-icp").verdict, CompareVerdict::too_few);
  EXPECT_THAT(reports::significant_rows(input), IsEmpty());
}

/// A lag has a sign: nearer to 0 is better, and its size is what is compared.
TEST(Compare, SignedMetricsAreComparedBySize) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    metrics::Evaluation e = evaluation("loop", seed, "kiss-icp", {});
    for (metrics::Row& r : e.rows)
      if (r.metric == "time_lag_ms") r.value = -3 * *r.value;
    make_estimate(folder / "b" / ("seed-" + std::to_string(seed)), e);
    make_provenance(folder / "b" / ("seed-" + std::to_string(seed)), "loop", seed, "aa");
  }
  const CompareInput input = compare(folder / "a", folder / "b");
  const CompareRow& lag = row(input, "time_lag_ms", "kiss-icp");
  EXPECT_TRUE(lag.magnitude);
  EXPECT_EQ(lag.verdict, CompareVerdict::worse);
  EXPECT_NEAR(lag.comparison.ratio, 3, 1e-12);
}

TEST(Compare, TheStretchOfTheDriveIsFoundWhereARowIsSignificantOnly) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}, {"ct-icp", {}}});
  make_runs(folder / "b", {{"kiss-icp", {.deskew = 2, .late = 0.1}}, {"ct-icp", {.late = 0.1}}});
  const CompareInput input = compare(folder / "a", folder / "b");
  ASSERT_THAT(input.drives, SizeIs(2));
  EXPECT_EQ(input.drives[0].estimator_b, "kiss-icp") << "the strongest change comes first";
  EXPECT_TRUE(input.drives[0].located);
  ASSERT_THAT(input.drives[0].series, SizeIs(1));
  ASSERT_THAT(input.drives[0].series[0].stretches, SizeIs(1));
  EXPECT_DOUBLE_EQ(input.drives[0].series[0].stretches[0].from, 2);
  EXPECT_THAT(input.drives[0].path_x_m, SizeIs(40));
  EXPECT_FALSE(input.drives[1].located);
  EXPECT_THAT(input.drives[1].series[0].stretches, IsEmpty());
}

// ---- stores

void make_store(const fs::path& folder, double ate, std::size_t cells_done = 6) {
  std::vector<scenarios::Cell> cells;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const char* estimator : {"kiss-icp", "ct-icp"}) {
      scenarios::Cell cell;
      cell.key = core::hex16(0x100 + cells.size());
      cell.world = core::hex16(seed);
      cell.block = cell.scenario = "brake";
      cell.case_name = "brake motion.peak=3";
      cell.seed = seed;
      cell.estimator = estimator;
      cells.push_back(cell);
    }
  }
  scenarios::Store store = scenarios::Store::create(folder, {"s", "00aa", "0.1.0 abc"}, "name: s\n", cells);
  store.start(false);
  for (std::size_t k = 0; k < cells_done; ++k) {
    const metrics::Evaluation e = evaluation("brake", cells[k].seed, cells[k].estimator, {.ate = ate});
    const fs::path inside = fs::path("cells") / cells[k].key;
    make_estimate(folder / inside, e);
    make_provenance(folder / inside, "brake", cells[k].seed, "aa");
    scenarios::CellOutcome outcome;
    outcome.recording_hash = "aa" + cells[k].world;
    outcome.folder = inside.string();
    std::vector<scenarios::MetricValue> values;
    for (const metrics::Row& r : e.rows)
      values.push_back({r.estimate, r.metric, r.value, r.unit, r.ci_low, r.ci_high, r.status, true});
    store.claim(cells[k].key);
    store.finish(cells[k].key, outcome, values);
  }
}

TEST(CompareStores, PairByCaseEstimatorAndSeed) {
  const TemporaryFolder folder;
  make_store(folder / "a", 1);
  make_store(folder / "b", 1.5, 5);
  const CompareInput input = compare(folder / "a", folder / "b");
  const CompareRow& ate = row(input, "ate_se3_rmse_m", "kiss-icp");
  EXPECT_EQ(ate.case_name, "brake motion.peak=3");
  EXPECT_EQ(ate.seeds, 3U);
  EXPECT_EQ(ate.verdict, CompareVerdict::worse);
  EXPECT_NEAR(ate.comparison.ratio, 1.5, 1e-12);
  EXPECT_EQ(row(input, "ate_se3_rmse_m", "ct-icp").verdict, CompareVerdict::too_few);
  EXPECT_EQ(input.a.build, "0.1.0 abc");
  EXPECT_EQ(input.same_recordings, 3U);
  EXPECT_THAT(lines(input), testing::Contains(HasSubstr("unfinished in B: cells of the sweep")));
  ASSERT_THAT(input.drives, SizeIs(2));
  EXPECT_THAT(input.drives[0].series, SizeIs(1)) << "series come from the cells' folders";
}

TEST(CompareStores, AStoreWithoutItsFilesIsComparedByItsRows) {
  const TemporaryFolder folder;
  make_store(folder / "a", 1);
  make_store(folder / "b", 1.5);
  fs::remove_all(folder / "b" / "cells");
  const CompareInput input = compare(folder / "a", folder / "b");
  EXPECT_EQ(row(input, "ate_se3_rmse_m", "ct-icp").verdict, CompareVerdict::worse);
  EXPECT_THAT(input.drives, IsEmpty());
  EXPECT_THAT(lines(input), testing::Contains(HasSubstr("no series: kiss-icp on case brake motion.peak=3")));
}

TEST(CompareStores, OnlyTheMetricsThatAreComparedAreLoaded) {
  const TemporaryFolder folder;
  make_store(folder / "a", 1);
  const auto loaded = [&](const std::vector<std::string>& metrics) {
    std::set<std::string> names;
    for (const ComparedRun& run :
         read_compared_folder(folder / "a", {"", "", metrics}, [](double, const auto&) {}).runs)
      for (const metrics::Row& r : run.rows) names.insert(r.metric);
    return names;
  };
  EXPECT_THAT(loaded({}), testing::UnorderedElementsAre("deskew_error_rms_m", "ate_se3_rmse_m", "coverage_percent",
                                                        "time_lag_ms", "sweep_time_p50_ms"));
  EXPECT_THAT(loaded({"path_length_m"}), testing::ElementsAre("path_length_m"));
  EXPECT_THAT(loaded({"drift_50m_along_rms_m"}), IsEmpty()) << "it has none, which is not all";
}

TEST(CompareStores, WhatHasNotRunYetIsSaidToBeSo) {
  const TemporaryFolder folder;
  make_store(folder / "a", 1);
  make_store(folder / "b", 1, 1);  // of kiss-icp
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare(folder / "a", folder / "b", "ct-icp", "ct-icp"); }),
              HasSubstr("B has no finished run"));
}

TEST(CompareStores, AStoreStandsBesideTwoEstimatorsAndOneCase) {
  const TemporaryFolder folder;
  make_store(folder / "a", 1);
  CompareSettings settings{folder / "a",       folder / "a",          "kiss-icp", "ct-icp",
                           {"ate_se3_rmse_m"}, "brake motion.peak=3", false};
  EXPECT_THAT(compare_folders(settings, {}).rows, SizeIs(1));
  settings.case_name = "brake";
  EXPECT_THAT(message_of<core::InputError>([&] { (void)compare_folders(settings, {}); }),
              HasSubstr("there are: brake motion.peak=3"));
}

// ---- the command

TEST(CompareCommand, WritesPageAndMarkdown) {
  const TemporaryFolder folder;
  make_runs(folder / "a", {{"kiss-icp", {}}});
  make_runs(folder / "b", {{"kiss-icp", {.ate = 2}}});
  CompareArguments arguments;
  arguments.folders = {folder / "a", folder / "b"};
  arguments.out = folder / "new" / "page.html";
  arguments.markdown = folder / "page.md";
  CommonArguments common;
  common.quiet = true;
  common.words = {"tarmac", "compare"};
  testing::internal::CaptureStdout();
  EXPECT_EQ(compare_command(arguments, common), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("ate_se3_rmse_m"));
  EXPECT_THAT(core::read_file(arguments.out), HasSubstr("1 worse"));
  EXPECT_THAT(core::read_file(arguments.markdown), HasSubstr("The page: page.html"));
}

TEST(CompareCommand, OneFolderNeedsTwoEstimators) {
  CompareArguments arguments;
  arguments.folders = {"a"};
  EXPECT_THAT(message_of<core::InputError>([&] { compare_command(arguments, {}); }),
              HasSubstr("--a NAME and --b NAME"));
  arguments.a = arguments.b = "kiss-icp";
  EXPECT_THAT(message_of<core::InputError>([&] { compare_command(arguments, {}); }), HasSubstr("both 'kiss-icp'"));
}

TEST(SeedList, ShortensRuns) {
  EXPECT_EQ(seed_list({3, 1, 2, 7, 9, 10}), "1..3, 7, 9, 10");
  EXPECT_EQ(seed_list({}), "none");
}

}  // namespace
}  // namespace tarmac::tools
