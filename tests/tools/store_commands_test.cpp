// `tarmac table`, `query` and `merge` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/files.h"
#include "scenarios/store.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

constexpr std::size_t kCells = 24;  ///< two cases x two estimators x six seeds

scenarios::Cell cell(std::size_t i) {
  scenarios::Cell c;
  c.key = core::hex16(0x1000 + i);
  c.world = core::hex16(i / 2);
  c.block = "brake";
  c.scenario = "quick-brake";
  c.seed = 1 + i / 2 % 6;
  c.parameters = {{"motion.peak", i < 12 ? "2" : "3"}};
  c.case_name = "brake motion.peak=" + c.parameters[0].second;
  c.estimator = i % 2 == 0 ? "kiss-icp" : "ct-icp";
  return c;
}

scenarios::MetricValue metric(const std::string& name, std::optional<double> value, const std::string& unit) {
  scenarios::MetricValue m;
  m.metric = name;
  m.value = value;
  m.unit = unit;
  if (!value) m.status = "n/a: the drive is too short";
  return m;
}

scenarios::CellResult result(std::size_t i) {
  scenarios::CellResult r;
  r.cell = cell(i);
  r.outcome.folder = "cells/" + r.cell.key;
  r.outcome.wall_s = 1 + static_cast<double>(i);
  if (i == 5) {
    r.outcome.status = "crashed";
    r.outcome.message = "signal 11";
    return r;
  }
  r.metrics = {metric("end_error_percent", 0.25 * static_cast<double>(r.cell.seed), "%"),
               metric("kitti_trans_percent", {}, "%")};
  return r;
}

struct Ended {
  int code = 0;
  std::string out;
};

class StoreCommands : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new PrivateFolder;
    make("whole", 0, 1, 22);
    make("a", 0, 2, kCells);
    make("b", 1, 2, kCells);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  /// Every step-th cell from `first` on and below `end` is finished. All are planned, or, by a shard, those only.
  static void make(const std::string& name, std::size_t first, std::size_t step, std::size_t end, bool shard = false) {
    std::vector<scenarios::Cell> cells;
    std::vector<std::string> keys;
    for (std::size_t i = 0; i < kCells; ++i) {
      keys.push_back(cell(i).key);
      if (!shard || i % step == first) cells.push_back(cell(i));
    }
    const std::string plan = scenarios::plan_hash_of(keys);
    auto store = scenarios::Store::create(path(name), {"brakes", plan, "test"}, "name: brakes\n", cells);
    store.start(false);
    for (std::size_t i = first; i < end; i += step) {
      const scenarios::CellResult finished = result(i);
      fs::create_directories(path(name) / finished.outcome.folder);
      core::write_file(path(name) / finished.outcome.folder / "log.txt", "log\n");
      store.claim(finished.cell.key);
      store.finish(finished.cell.key, finished.outcome, finished.metrics);
    }
  }
  static fs::path path(const std::string& name) { return folder_->path() / name; }
  static Ended tarmac(std::vector<std::string> words) {
    words.insert(words.begin(), (program_folder() / "tarmac").string());
    ChildRequest request;
    request.command = std::move(words);
    request.working_folder = folder_->path();
    request.log_file = path("log.txt");
    request.limits.wall_s = 60;
    const ChildResult ended = run_child(request);
    EXPECT_EQ(ended.end, ChildResult::End::exited);
    return {ended.code, core::read_file(path("log.txt"))};
  }
  static nlohmann::json json(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Ended ended = tarmac(words);
    EXPECT_EQ(ended.code, 0) << ended.out;
    return nlohmann::json::parse(ended.out);
  }
  static PrivateFolder* folder_;
};
PrivateFolder* StoreCommands::folder_ = nullptr;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(StoreCommands, TableHasALineForEachCaseAndEstimator) {
  const Ended ended = tarmac({"table", "whole"});
  EXPECT_EQ(ended.code, 0);
  const std::vector<std::string> lines = lines_of(ended.out);
  ASSERT_EQ(lines.size(), 6u) << ended.out;
  EXPECT_THAT(lines[0], AllOf(StartsWith("case"), HasSubstr("end error %"), HasSubstr("deskew RMS mm")));
  // Seeds 1, 2, 4, 5 and 6 of ct-icp: the third crashed. The interval of five values is their range.
  EXPECT_THAT(lines[1], testing::MatchesRegex(
                            "brake motion.peak=2 +ct-icp +5 +1 +0 +1.000 .0.250, 1.500. +n/a +n/a +n/a +1 crashed"));
  // Of six values, too, only the range holds the median with 90 %: 1 - 2 (1 + 6) / 64 = 0.78 for the next rank.
  EXPECT_THAT(lines[2], testing::MatchesRegex("brake motion.peak=2 +kiss-icp +6 +0 +0 +0.875 .0.250, 1.500. .*"));
  EXPECT_THAT(lines[3], testing::MatchesRegex("brake motion.peak=3 +ct-icp +5 +0 +1 +0.750 .0.250, 1.250. .*"));
}

TEST_F(StoreCommands, TableFiltersSortsAndShowsCells) {
  const Ended ended =
      tarmac({"table", "whole", "--cells", "--estimator", "kiss-icp", "--seed", "2..6", "--where", "motion.peak=3",
              "--metrics", "end_error_percent,kitti_trans_percent", "--sort", "end_error_percent", "--reverse"});
  EXPECT_EQ(ended.code, 0) << ended.out;
  const std::vector<std::string> lines = lines_of(ended.out);
  ASSERT_EQ(lines.size(), 6u) << ended.out;
  EXPECT_THAT(lines[1], AllOf(StartsWith(cell(20).key), HasSubstr("1.25"), HasSubstr("n/a")));
  EXPECT_THAT(lines[4], AllOf(StartsWith(cell(14).key), HasSubstr("0.5")));
  EXPECT_THAT(lines[5], AllOf(StartsWith(cell(22).key), HasSubstr("pending"), Not(HasSubstr("n/a"))));
  for (const char* status : scenarios::kOutcomeStatuses) {
    const Ended by_status = tarmac({"table", "whole", "--status", status});
    EXPECT_EQ(by_status.code, 0) << by_status.out;
    const bool there = std::string_view(status) == "ok" || std::string_view(status) == "crashed";
    EXPECT_EQ(by_status.out.find("no cell matches") == std::string::npos, there) << status;
  }
}

TEST_F(StoreCommands, UnknownNamesAreErrorsWithAGuess) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--metrics", "end_eror_percent"}, "did you mean 'end_error_percent'"},
      {{"--estimator", "kiss_icp"}, "did you mean 'kiss-icp'"},
      {{"--case", "brake motion.peak=4"}, "did you mean 'brake motion.peak="},
      {{"--scenario", "quickbrake"}, "did you mean 'quick-brake'"},
      {{"--status", "crash"}, "--status crash"},
      {{"--where", "motion.peek=3"}, "did you mean 'motion.peak'"},
      {{"--where", "motion.peak=17"}, "there are 2, 3"},
      {{"--where", "motion.peak"}, "expected key=value"},
      {{"--by", "estimator,sed"}, "did you mean 'seed'"},
      {{"--sort", "don"}, "did you mean 'done'"},
      {{"--json", "--dump"}, "give one of them"}};
  for (const auto& [words, message] : cases) {
    std::vector<std::string> command = {"table", "whole"};
    command.insert(command.end(), words.begin(), words.end());
    const Ended ended = tarmac(command);
    EXPECT_EQ(ended.code, 2) << ended.out;
    EXPECT_THAT(ended.out, AllOf(StartsWith("error: "), HasSubstr(message))) << words[0];
  }
  EXPECT_THAT(tarmac({"table", "nowhere"}).out, HasSubstr("there is no store.sqlite"));
}

TEST_F(StoreCommands, JsonRowsFollowTheContract) {
  const nlohmann::json rows = json({"table", "whole"});
  ASSERT_EQ(rows.size(), 21u * 2 + 1 + 2) << "two metrics of each cell; one row each of those that have none";
  for (const auto& row : rows) {
    for (const char* key : {"scenario", "case", "parameters", "seed", "estimator", "estimate", "metric", "value",
                            "unit", "ci_low", "ci_high", "status"})
      EXPECT_TRUE(row.contains(key)) << key;
  }
  std::multiset<std::string> statuses;
  for (const auto& row : rows) {
    statuses.insert(row["status"]);
    EXPECT_EQ(row["value"].is_null(), row["status"] != "ok") << "n/a is null, never 0";
  }
  EXPECT_EQ(statuses.count("ok"), 21u);
  EXPECT_EQ(statuses.count("failed: crashed"), 1u);
  EXPECT_EQ(statuses.count("pending"), 2u);
  EXPECT_EQ(rows[0]["parameters"]["motion.peak"], "2");
}

TEST_F(StoreCommands, CsvHoldsFiguresInFull) {
  const Ended ended = tarmac({"table", "whole", "--by", "estimator", "--metrics", "end_error_percent", "--csv", "-"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(lines_of(ended.out)[0], testing::Eq("estimator,done,failed,pending,end_error_percent,end_error_percent."
                                                  "ci_low,end_error_percent.ci_high,end_error_percent.n,outcomes"));
  EXPECT_THAT(lines_of(ended.out)[2], StartsWith("kiss-icp,11,0,1,0.75,"));
  ASSERT_EQ(tarmac({"table", "whole", "--cells", "--csv", "cells.csv"}).code, 0);
  EXPECT_EQ(lines_of(core::read_file(path("cells.csv"))).size(), kCells + 1);
}

TEST_F(StoreCommands, QueryReadsAndRefusesToWrite) {
  const nlohmann::json rows =
      json({"query", "whole", "select status, count(*) as n, null as nix from all_cells group by status"});
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0], (nlohmann::json{{"status", "crashed"}, {"n", 1}, {"nix", nullptr}}));
  EXPECT_EQ(tarmac({"query", "whole", "select 'a,b' as x, 2 as y", "--csv", "-"}).out, "x,y\n\"a,b\",2\n");
  EXPECT_THAT(tarmac({"query", "whole", "select 0.5 as half, null as none"}).out,
              HasSubstr("half  none\n0.5    n/a\n"));
  for (const char* sql : {"delete from outcomes", "select nonsense from results", "select 1; select 2"}) {
    const Ended ended = tarmac({"query", "whole", sql});
    EXPECT_EQ(ended.code, 2) << sql;
    EXPECT_THAT(ended.out, StartsWith("error: query: "));
  }
}

TEST_F(StoreCommands, AQueryOfWhatThereIsNotIsToldWhatThereIs) {
  for (const char* sql : {"select nonsense from results", "select value from metrics"}) {
    const Ended ended = tarmac({"query", "whole", sql});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.out,
                AllOf(StartsWith("error: query: no such "), HasSubstr("\n  all_cells: cell, scenario, case, case_name"),
                      HasSubstr("\n  results: cell,"), HasSubstr(" metric, value, unit,"),
                      HasSubstr("\n  tables: cells, claims, events")));
  }
  EXPECT_THAT(tarmac({"query", "whole", "delete from outcomes"}).out, Not(HasSubstr("all_cells")));
}

TEST_F(StoreCommands, MergedShardsDumpAsTheWholeWould) {
  const Ended ended = tarmac({"merge", "a", "b", "-o", "merged"});
  EXPECT_EQ(ended.code, 0) << ended.out;
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("a: 12 cells finished, 12 not"), HasSubstr("merged: 24 cells finished, 0 not")));
  make("all", 0, 1, kCells);
  const Ended merged = tarmac({"table", "merged", "--dump"}), all = tarmac({"table", "all", "--dump"});
  EXPECT_EQ(merged.code, 0);
  EXPECT_EQ(merged.out, all.out);
  EXPECT_TRUE(fs::exists(path("merged") / "cells" / cell(5).key / "log.txt"));
  EXPECT_EQ(tarmac({"merge", "a", "b", "-o", "merged"}).code, 2) << "there is a store already";
}

TEST_F(StoreCommands, MergeNoticesAForgottenShard) {
  for (const std::size_t i : {0U, 1U, 2U}) make("shard-" + std::to_string(i), i, 3, kCells, true);
  const Ended two = tarmac({"merge", "shard-0", "shard-2", "-o", "two"});
  EXPECT_EQ(two.code, 3);
  EXPECT_THAT(two.out, AllOf(HasSubstr("two: 16 cells finished, 0 not"),
                             HasSubstr("two holds 16 cells; the sweep 'brakes' has more: a shard is missing")));
  const Ended three = tarmac({"merge", "shard-0", "shard-1", "shard-2", "-o", "three", "--json"});
  EXPECT_EQ(three.code, 0);
  EXPECT_THAT(three.out, AllOf(HasSubstr("\"whole_sweep\": true"), Not(HasSubstr("missing"))));
}

}  // namespace
}  // namespace tarmac::tools
