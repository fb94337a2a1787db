// `tarmac gate` and `tarmac baseline update` on real stores: exit codes, and what is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/baseline.h"
#include "scenarios/store.h"
#include "tests/support/temporary_folder.h"
#include "tools/tarmac/commands.h"

namespace {

namespace fs = std::filesystem;
using namespace tarmac::scenarios;
using tarmac::core::InputError;
using testing::HasSubstr;

constexpr const char* kRpe = "rpe_1sweep_trans_rmse_m";

class GateCommandTest : public testing::Test {
 protected:
  GateCommandTest() {
    tarmac::core::write_file(folder_ / "gate.yaml",
                             std::string("name: g\nsweep: s\nbaseline: b.yaml\nrows:\n  - {case: '*', estimator: "
                                         "kiss-icp, metric: ") +
                                 kRpe + ", non_inferior: {min_pairs: 4}}\n");
  }
  /// Seeds with these values; the last cells stay unfinished when there are fewer values than cells. The sweep has four
  /// cells: with fewer the store is a shard's.
  fs::path store(const std::string& name, const std::vector<double>& values, const std::string& sweep = "s",
                 const std::string& last_status = "ok", std::size_t cells_here = 4) {
    std::vector<std::string> plan;
    for (std::size_t k = 0; k < 4; ++k) plan.push_back("000000000000000" + std::to_string(k));
    std::vector<Cell> cells(cells_here);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      cells[k].key = plan[k];
      cells[k].world = cells[k].key;
      cells[k].block = cells[k].case_name = "a";
      cells[k].scenario = "drive";
      cells[k].seed = k + 1;
      cells[k].estimator = "kiss-icp";
    }
    Store made = Store::create(folder_ / name, {sweep, plan_hash_of(plan), "build"}, "name: s\n", cells);
    made.start(false);
    for (std::size_t k = 0; k < values.size(); ++k) {
      MetricValue value;
      value.metric = kRpe;
      value.value = values[k];
      value.unit = "m";
      CellOutcome outcome;
      outcome.recording_hash = "r" + std::to_string(k);
      if (k + 1 == values.size()) outcome.status = last_status;
      EXPECT_TRUE(made.claim(cells[k].key));
      made.finish(cells[k].key, outcome, std::vector<MetricValue>{value});
    }
    return folder_ / name;
  }
  int update(const fs::path& from, bool allow_incomplete = false) {
    return tarmac::tools::baseline_update_command(
        {{from.string()}, (folder_ / "b.yaml").string(), (folder_ / "gate.yaml").string(), allow_incomplete}, quiet_);
  }
  int gate(const fs::path& on) {
    return tarmac::tools::gate_command({on.string(), (folder_ / "gate.yaml").string(), (folder_ / "j.xml").string(),
                                        (folder_ / "g.md").string(), "https://ci.example"},
                                       quiet_);
  }

  tarmac::tests::TemporaryFolder folder_;
  tarmac::tools::CommonArguments quiet_{.quiet = true, .json = false, .jobs = 0, .words = {}};
};

TEST_F(GateCommandTest, IsFineWithItselfAndRedWhenWorse) {
  const fs::path before = store("before", {1, 2, 3, 4});
  ASSERT_EQ(update(before), 0);
  EXPECT_EQ(gate(before), 0);
  EXPECT_EQ(gate(store("worse", {1.1, 2.21, 3.3, 4.41})), 1);
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("<failure"));
  EXPECT_THAT(tarmac::core::read_file(folder_ / "g.md"), HasSubstr("https://ci.example"));
}

TEST_F(GateCommandTest, NoiseIsInconclusiveAndEndsWithZero) {
  ASSERT_EQ(update(store("before", {1, 2, 3, 4})), 0);
  EXPECT_EQ(gate(store("noise", {1.01, 1.99, 3.02, 3.97})), 0);
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("<skipped message=\"inconclusive"));
}

TEST_F(GateCommandTest, ACellThatFailedOrIsNotFinishedIsRed) {
  ASSERT_EQ(update(store("before", {1, 2, 3, 4})), 0);
  EXPECT_EQ(gate(store("failed", {1, 2, 3, 4}, "s", "crashed")), 1);
  EXPECT_EQ(gate(store("unfinished", {1, 2, 3})), 1);
}

TEST_F(GateCommandTest, BadInputIsAnInputError) {
  const fs::path before = store("before", {1, 2, 3, 4});
  EXPECT_THROW(gate(before), InputError) << "no baseline yet";
  ASSERT_EQ(update(before), 0);
  EXPECT_THROW(gate(folder_ / "none"), InputError);
  EXPECT_THROW(gate(store("other", {1, 2, 3, 4}, "another-sweep")), InputError);
}

TEST_F(GateCommandTest, WhyNothingWasJudgedStandsInTheReports) {
  const fs::path before = store("before", {1, 2, 3, 4});
  tarmac::core::write_file(folder_ / "j.xml", "an earlier run's");
  EXPECT_THROW(gate(before), InputError) << "no baseline yet";
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("errors=\"1\""));
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("<error type=\"input\""));
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("b.yaml"));
  EXPECT_THAT(tarmac::core::read_file(folder_ / "g.md"), HasSubstr("nothing was judged"));
  ASSERT_EQ(update(before), 0);
  tarmac::core::write_file(folder_ / "gate.yaml", "name: g\nrows: 3\n");
  EXPECT_THROW(gate(before), InputError);
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("gate.yaml:2"));
}

TEST_F(GateCommandTest, AShardAloneIsRedAndNoBaseline) {
  ASSERT_EQ(update(store("before", {1, 2, 3, 4})), 0);
  const fs::path shard = store("shard", {1, 2, 3}, "s", "ok", 3);
  EXPECT_EQ(gate(shard), 1);
  EXPECT_THAT(tarmac::core::read_file(folder_ / "j.xml"), HasSubstr("only 3 cells of the sweep: a shard"));
  const std::string baseline = tarmac::core::read_file(folder_ / "b.yaml");
  try {
    update(shard);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("only a shard of the sweep (merge all shards first)"));
  }
  EXPECT_EQ(tarmac::core::read_file(folder_ / "b.yaml"), baseline);
  EXPECT_EQ(update(shard, true), 0);
}

TEST_F(GateCommandTest, ABaselineIsNotMadeOfHalfASweep) {
  const fs::path unfinished = store("unfinished", {1, 2, 3}), failed = store("failed", {1, 2, 3, 4}, "s", "crashed");
  for (const fs::path& folder : {unfinished, failed}) {
    EXPECT_THROW(update(folder), InputError);
    EXPECT_FALSE(fs::exists(folder_ / "b.yaml"));
  }
  ASSERT_EQ(update(failed, true), 0);
  const Baseline baseline = load_baseline(folder_ / "b.yaml");
  ASSERT_EQ(baseline.values.size(), 1u);
  EXPECT_EQ(baseline.values.begin()->second.size(), 3u) << "without the one that failed";
  EXPECT_EQ(baseline.sweeps, std::vector<std::string>{"s"});
  EXPECT_EQ(baseline.build, "build");
}

}  // namespace
