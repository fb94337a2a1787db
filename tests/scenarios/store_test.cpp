// One process and its store.
#include "scenarios/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/scenarios/store_cells.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::scenarios {
namespace {

using tarmac::tests::message_of;
using tarmac::tests::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using namespace scenarios::tests;
namespace fs = std::filesystem;

std::vector<std::string> keys(std::initializer_list<std::size_t> numbers) {
  std::vector<std::string> all;
  for (const std::size_t i : numbers) all.push_back(cell(i).key);
  return all;
}

void expect_equal(const Cell& a, const Cell& b) {
  EXPECT_EQ(std::tie(a.key, a.world, a.block, a.scenario, a.case_name, a.seed, a.estimator, a.parameters),
            std::tie(b.key, b.world, b.block, b.scenario, b.case_name, b.seed, b.estimator, b.parameters));
}

void expect_equal(const MetricValue& a, const MetricValue& b) {
  EXPECT_EQ(std::tie(a.estimate, a.metric, a.value, a.unit, a.ci_low, a.ci_high, a.status, a.deterministic),
            std::tie(b.estimate, b.metric, b.value, b.unit, b.ci_low, b.ci_high, b.status, b.deterministic));
}

TEST(Store, KnowsAShardFromTheWholePlan) {
  std::vector<std::string> keys;
  for (const Cell& one : cells(4)) keys.push_back(one.key);
  const std::string whole = plan_hash_of(keys);
  std::reverse(keys.begin(), keys.end());
  EXPECT_EQ(plan_hash_of(keys), whole) << "in any order";
  const auto holds_all = [&](std::size_t n) {
    const TemporaryFolder folder;
    return Store::create(folder.path(), {"regression", whole, "build"}, "", cells(n)).holds_whole_plan();
  };
  EXPECT_TRUE(holds_all(4));
  EXPECT_FALSE(holds_all(3));
  EXPECT_FALSE(holds_all(5)) << "other cells than the plan's";
}

TEST(Store, GivesBackWhatWasPutIn) {
  const TemporaryFolder folder;
  {
    Store store = Store::create(folder.path(), kIdentity, "name: regression\n", cells(4));
    store.start(false);
    run(store, 2);
  }
  const Store store = Store::open(folder.path(), Store::Access::read_only);
  EXPECT_EQ(store.identity().sweep, kIdentity.sweep);
  EXPECT_EQ(store.identity().plan_hash, kIdentity.plan_hash);
  EXPECT_EQ(store.identity().build, kIdentity.build);
  EXPECT_EQ(core::read_file(folder / "sweep.yaml"), "name: regression\n");
  const std::vector<CellResult> results = store.results({});
  ASSERT_THAT(results, SizeIs(1));
  expect_equal(results[0].cell, cell(2));
  const CellOutcome &a = results[0].outcome, b = outcome(2);
  EXPECT_EQ(std::tie(a.status, a.message, a.recording_hash, a.wall_s, a.cpu_s, a.peak_memory_mb, a.overhead_s, a.folder,
                     a.command),
            std::tie(b.status, b.message, b.recording_hash, b.wall_s, b.cpu_s, b.peak_memory_mb, b.overhead_s, b.folder,
                     b.command));
  ASSERT_THAT(results[0].metrics, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) expect_equal(results[0].metrics[i], metrics(2)[i]);
  ASSERT_THAT(store.unfinished(), SizeIs(3));
  expect_equal(store.unfinished()[2], cell(3));
  EXPECT_EQ(store.pending(), keys({0, 1, 3}));
}

TEST(Store, ACellIsClaimedOnceAndFinishedByItsClaimantAlone) {
  const TemporaryFolder folder;
  Store first = Store::create(folder.path(), kIdentity, "", cells(3));
  Store second = Store::open(folder.path(), Store::Access::read_write);
  EXPECT_THROW(first.claim(cell(0).key), std::logic_error) << "start() comes first";
  first.start(false);
  second.start(false);
  EXPECT_TRUE(first.claim(cell(0).key));
  EXPECT_FALSE(second.claim(cell(0).key));
  EXPECT_FALSE(first.claim(cell(0).key));
  EXPECT_THAT(message_of<std::logic_error>([&] { second.finish(cell(0).key, outcome(0), {}); }),
              AllOf(HasSubstr(cell(0).key), HasSubstr("not claimed")));
  EXPECT_THAT(message_of<std::logic_error>([&] { second.release(cell(0).key); }), HasSubstr("not claimed"));
  EXPECT_THAT(message_of<std::logic_error>([&] { first.claim("no such cell"); }), HasSubstr("no cell"));
  EXPECT_EQ(second.pending(), keys({1, 2}));
  first.release(cell(0).key);
  EXPECT_EQ(second.pending(), keys({0, 1, 2}));
  EXPECT_TRUE(second.claim(cell(0).key));
  second.finish(cell(0).key, outcome(0), metrics(0));
  EXPECT_FALSE(first.claim(cell(0).key)) << "finished cells are not run again";
  EXPECT_THROW(second.finish(cell(0).key, outcome(0), metrics(0)), std::logic_error);
}

TEST(Store, AFinishThatFailsLeavesNothingOfItself) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(2));
  store.start(false);
  ASSERT_TRUE(store.claim(cell(0).key));
  std::vector<MetricValue> twice = metrics(0);
  twice.push_back(twice[0]);
  EXPECT_THROW(store.finish(cell(0).key, outcome(0), twice), std::logic_error);
  EXPECT_THAT(store.results({}), IsEmpty());
  store.finish(cell(0).key, outcome(0), metrics(0));
  EXPECT_THAT(store.results({}).at(0).metrics, SizeIs(4));
}

TEST(Store, StartRunsAgainWhatWasKilledAndOnRequestWhatFailed) {
  const TemporaryFolder folder;
  {
    Store store = Store::create(folder.path(), kIdentity, "", cells(6));
    const StoreStart fresh = store.start(false);
    EXPECT_EQ(fresh.pending, 6u);
    EXPECT_EQ(fresh.done + fresh.failed + fresh.released + fresh.killed + fresh.running_elsewhere, 0u);
    run(store, 0);
    run(store, 1, "not_initialised");
    run(store, 2, "killed");
    run(store, 3, "crashed");
    run(store, 4, "timed_out");
    for (const std::size_t i : {0, 2, 3}) fs::create_directories(folder / ("cells/" + cell(i).key));
  }
  {
    Store store = Store::open(folder.path(), Store::Access::read_write);
    const StoreStart start = store.start(false);
    EXPECT_EQ(std::tie(start.done, start.failed, start.pending, start.killed, start.rerun, start.released),
              std::make_tuple(2u, 2u, 2u, 1u, 0u, 0u));
    EXPECT_EQ(store.pending(), keys({2, 5}));
    EXPECT_FALSE(fs::exists(folder / ("cells/" + cell(2).key))) << "of a cell that is run again nothing stays";
    EXPECT_TRUE(fs::exists(folder / ("cells/" + cell(3).key)));
  }
  Store store = Store::open(folder.path(), Store::Access::read_write);
  const StoreStart start = store.start(true);
  EXPECT_EQ(std::tie(start.done, start.failed, start.pending, start.rerun), std::make_tuple(2u, 0u, 4u, 2u));
  EXPECT_EQ(store.pending(), keys({2, 3, 4, 5}));
  EXPECT_FALSE(fs::exists(folder / ("cells/" + cell(3).key)));
  EXPECT_TRUE(fs::exists(folder / ("cells/" + cell(0).key)));
  const Store::Table events = store.query("select what, count, detail from events order by id");
  ASSERT_THAT(events.rows, SizeIs(2));
  EXPECT_THAT(events.rows[0], ElementsAre("killed", "1", cell(2).key));
  EXPECT_THAT(events.rows[1], ElementsAre("rerun", "2", cell(3).key + " " + cell(4).key));
}

TEST(Store, FiltersSelectCellsAndMetrics) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(24));
  store.start(false);
  for (std::size_t i = 0; i < 20; ++i) run(store, i, i == 5 ? "crashed" : "ok");
  ResultFilter filter;
  filter.estimators = {"ct-icp"};
  filter.seeds = {2, 3};
  filter.parameters = {{"motion.peak", "1"}, {"rig.lidar.model", "vlp-16"}};
  filter.metrics = {"sweep_time_p50_ms", "kitti_trans_percent"};
  const std::vector<CellResult> found = store.results(filter);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].cell.key, cell(9).key);  // worlds 4 and 5 of the second case
  EXPECT_EQ(found[1].cell.key, cell(11).key);
  EXPECT_EQ(found[0].cell.parameters, cell(9).parameters);
  ASSERT_THAT(found[0].metrics, SizeIs(2));
  expect_equal(found[0].metrics[0], metrics(9)[2]);
  expect_equal(found[0].metrics[1], metrics(9)[3]);

  filter = {};
  filter.statuses = {"crashed"};
  ASSERT_THAT(store.results(filter), SizeIs(1));
  EXPECT_EQ(store.results(filter)[0].cell.key, cell(5).key);
  filter = {};
  filter.keys = {cell(7).key, "it's"};
  EXPECT_THAT(store.results(filter), SizeIs(1));
  filter.cases = {"no such case"};
  EXPECT_THAT(store.results(filter), IsEmpty());
  filter = {};
  filter.statuses = {"pending"};
  EXPECT_THAT(store.unfinished(filter), SizeIs(4));
}

TEST(Store, ResultsAreTheSameHoweverManyCellsAreSelected) {
  // Few cells are looked up one by one, many by reading a metric of all: both ways must tell the same.
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 64;
  Store store = Store::create(folder.path(), kIdentity, "", cells(kCells));
  store.start(false);
  for (std::size_t i = 0; i < kCells; ++i) run(store, (i * 37) % kCells);
  const std::vector<CellResult> all = store.results({});
  ASSERT_THAT(all, SizeIs(kCells));
  for (std::size_t i = 1; i < kCells; ++i)
    EXPECT_LT(std::tie(all[i - 1].cell.case_name, all[i - 1].cell.estimator, all[i - 1].cell.seed),
              std::tie(all[i].cell.case_name, all[i].cell.estimator, all[i].cell.seed));
  for (const CellResult& expected : all) {
    ResultFilter filter;
    filter.keys = {expected.cell.key};
    const std::vector<CellResult> one = store.results(filter);
    ASSERT_THAT(one, SizeIs(1));
    expect_equal(one[0].cell, expected.cell);
    ASSERT_EQ(one[0].metrics.size(), expected.metrics.size());
    for (std::size_t k = 0; k < one[0].metrics.size(); ++k) expect_equal(one[0].metrics[k], expected.metrics[k]);
  }
}

TEST(Store, GroupsHoldAllCellsAndTheValuesOfTheCausalEstimate) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(12));
  store.start(false);
  for (std::size_t i = 0; i < 9; ++i) run(store, i, i == 4 ? "crashed" : "ok");
  ASSERT_TRUE(store.claim(cell(9).key));
  ResultFilter filter;
  filter.metrics = {"ate_se3_rmse_m", "kitti_trans_percent", "unheard_of"};
  const std::vector<CellGroup> groups = store.groups(filter, {"case", "estimator"});
  ASSERT_THAT(groups, SizeIs(4));
  EXPECT_THAT(groups[1].by, ElementsAre("brake motion.peak=0", "kiss-icp"));
  EXPECT_THAT(groups[1].statuses, ElementsAre(testing::Pair("crashed", 1), testing::Pair("ok", 2)));
  EXPECT_THAT(groups[1].metrics[0].values, ElementsAre(*metrics(0)[0].value, *metrics(2)[0].value));
  EXPECT_EQ(groups[1].metrics[0].unit, "m");
  EXPECT_THAT(groups[1].metrics[1].values, IsEmpty());
  EXPECT_EQ(groups[1].metrics[1].missing, metrics(0)[2].status);
  EXPECT_THAT(groups[1].metrics[2].values, IsEmpty());
  EXPECT_THAT(groups[2].statuses,
              ElementsAre(testing::Pair("ok", 1), testing::Pair("pending", 1), testing::Pair("running", 1)));
  EXPECT_THAT(message_of<core::InputError>([&] { store.groups({}, {"estimatr"}); }),
              AllOf(HasSubstr("estimatr"), HasSubstr("did you mean 'estimator'")));
  EXPECT_THAT(store.distinct("seed"), ElementsAre("1", "2", "3"));
  EXPECT_THAT(store.distinct("parameter"), ElementsAre("motion.peak", "rig.lidar.model"));
  EXPECT_THAT(store.distinct("metric"), ElementsAre("ate_se3_rmse_m", "kitti_trans_percent", "sweep_time_p50_ms"));
}

TEST(Store, AMethodWithAFinalEstimateAloneCountsByThat) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(1));
  store.start(false);
  ASSERT_TRUE(store.claim(cell(0).key));
  MetricValue batch = metric("ate_se3_rmse_m", 0.25, "m");
  batch.estimate = "final";
  store.finish(cell(0).key, outcome(0), std::vector<MetricValue>{batch});
  ResultFilter filter;
  filter.metrics = {"ate_se3_rmse_m"};
  EXPECT_THAT(store.groups(filter, {"estimator"}).at(0).metrics.at(0).values, ElementsAre(0.25));
}

TEST(Store, ValuesComeBackToTheLastBit) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(1));
  store.start(false);
  ASSERT_TRUE(store.claim(cell(0).key));
  const std::vector<MetricValue> odd = {
      metric("a", 0.1, ""),      metric("b", 5e-324, ""), metric("c", 1.7976931348623157e308, ""),
      metric("d", INFINITY, ""), metric("e", NAN, ""),    metric("f", -3.0, "µm")};
  CellOutcome message = outcome(0);
  message.message = "line one\nline 'two'\twith a tab";
  store.finish(cell(0).key, message, odd);
  const CellResult result = store.results({}).at(0);
  EXPECT_EQ(result.outcome.message, message.message);
  for (const std::size_t i : {0, 1, 2, 3, 5}) EXPECT_EQ(result.metrics[i].value, odd[i].value) << i;
  EXPECT_EQ(result.metrics[5].unit, "µm");
  EXPECT_FALSE(result.metrics[4].value) << "not a number is no value";
  EXPECT_THAT(dump(store),
              AllOf(HasSubstr("\t0.10000000000000001\t"), HasSubstr("line one\\nline 'two'\\twith a tab")));
}

TEST(Store, TheDumpIsTheSameInWhateverOrderCellsFinish) {
  const TemporaryFolder folder;
  constexpr std::size_t kCells = 12;
  std::vector<Cell> backwards = cells(kCells);
  std::reverse(backwards.begin(), backwards.end());
  Store a = Store::create(folder / "a", kIdentity, "", cells(kCells));
  Store b = Store::create(folder / "b", kIdentity, "", backwards);
  a.start(false);
  b.start(false);
  for (std::size_t i = 0; i < 10; ++i) run(a, i, i == 3 ? "crashed" : "ok");
  for (std::size_t i = 10; i-- > 0;) {
    ASSERT_TRUE(b.claim(cell(i).key));
    CellOutcome slower = outcome(i, i == 3 ? "crashed" : "ok");
    slower.wall_s *= 3;  // what differs from run to run is not in it
    slower.command = "another";
    std::vector<MetricValue> reordered = i == 3 ? std::vector<MetricValue>{} : metrics(i);
    std::reverse(reordered.begin(), reordered.end());
    for (MetricValue& m : reordered)
      if (!m.deterministic) m.value = 1.0;
    b.finish(cell(i).key, slower, reordered);
  }
  EXPECT_EQ(dump(a), dump(b));
  EXPECT_THAT(dump(a), AllOf(HasSubstr("ate_se3_rmse_m"), testing::Not(HasSubstr("sweep_time_p50_ms"))));
  run(a, 10);
  EXPECT_NE(dump(a), dump(b));
}

TEST(Store, ViewsShowCellsWithoutMetricsToo) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(4));
  store.start(false);
  run(store, 0);
  run(store, 1, "crashed");
  const Store::Table all = store.query("select cell, status, metric, value from results order by cell, metric");
  ASSERT_THAT(all.rows, SizeIs(5));
  EXPECT_THAT(all.rows[4], ElementsAre(cell(1).key, "crashed", std::nullopt, std::nullopt));
  const Store::Table deterministic =
      store.query("select metric, estimate from deterministic where cell = '" + cell(0).key + "'");
  EXPECT_THAT(deterministic.rows, testing::UnorderedElementsAre(ElementsAre("ate_se3_rmse_m", "causal"),
                                                                ElementsAre("ate_se3_rmse_m", "final"),
                                                                ElementsAre("kitti_trans_percent", "causal")));
  EXPECT_THAT(store.query("select status, count(*) from all_cells group by status order by status").rows,
              ElementsAre(ElementsAre("crashed", "1"), ElementsAre("ok", "1"), ElementsAre("pending", "2")));
  EXPECT_THAT(store.query("select \"case\", case_name from results limit 1").columns, ElementsAre("case", "case_name"));
}

TEST(StoreQuery, ReadsAndNothingElse) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(2));
  store.start(false);
  run(store, 0);
  const std::string before = dump(store);
  const std::string elsewhere = (folder / "other.sqlite").string();
  for (const std::string& sql :
       {std::string("delete from outcomes"), std::string("insert into meta values('a', 'b')"),
        std::string("update cells set seed = 7"), std::string("drop table cells"), std::string("create table t(a)"),
        std::string("create temp table t(a)"), "attach '" + elsewhere + "' as other", "vacuum into '" + elsewhere + "'",
        std::string("pragma user_version = 9"), std::string("pragma journal_mode = delete"), std::string("begin"),
        std::string("with x as (select 1) delete from cells")}) {
    EXPECT_THAT(message_of<core::InputError>([&] { store.query(sql); }), HasSubstr("may only read")) << sql;
  }
  EXPECT_FALSE(fs::exists(elsewhere));
  EXPECT_EQ(dump(store), before);
  EXPECT_THAT(message_of<core::InputError>([&] { store.query("select nonsense from results"); }),
              HasSubstr("no such column: nonsense"));
  EXPECT_THAT(message_of<core::InputError>([&] { store.query("selct 1"); }), HasSubstr("syntax error"));
  EXPECT_THAT(message_of<core::InputError>([&] { store.query("select 1; select 2"); }),
              AllOf(HasSubstr("one statement"), HasSubstr("select 2")));
  EXPECT_THAT(message_of<core::InputError>([&] { store.query("  "); }), HasSubstr("no statement"));
  EXPECT_THAT(store.query("select 1 + 1 as two, null, 0.5, 'x';").rows,
              ElementsAre(ElementsAre("2", std::nullopt, "0.5", "x")));
}

TEST(StoreQuery, CanBeInterrupted) {
  const TemporaryFolder folder;
  const Store store = Store::create(folder.path(), kIdentity, "", cells(1));
  struct Stopped {};
  int asked = 0;
  const auto stop = [&] {
    if (++asked == 3) throw Stopped();
  };
  const char* endless = "with recursive n(i) as (select 1 union all select i + 1 from n) select count(*) from n";
  EXPECT_THROW(store.query(endless, stop), Stopped);
  EXPECT_EQ(asked, 3);
}

/// SQLite's plan of a statement, a line a step.
std::string plan(const Store& store, const std::string& sql) {
  // The authoriser lets no EXPLAIN of writes through, but one of a select is a select.
  std::string text;
  for (const auto& row : store.query("explain query plan " + sql).rows) text += row.at(3).value_or("") + "\n";
  return text;
}

TEST(StoreQuery, TheReportsQuestionsAreAnsweredThroughIndices) {
  const TemporaryFolder folder;
  Store store = Store::create(folder.path(), kIdentity, "", cells(8));
  store.start(false);
  for (std::size_t i = 0; i < 8; ++i) run(store, i);
  const std::string one_metric = plan(store, "select cell, value from results where metric = 'ate_se3_rmse_m'");
  EXPECT_THAT(one_metric, AllOf(HasSubstr("SEARCH n USING COVERING INDEX sqlite_autoindex_metric_names_1 (metric=?)"),
                                HasSubstr("SEARCH v USING PRIMARY KEY (metric=?)"),
                                HasSubstr("SEARCH c USING INTEGER PRIMARY KEY"), testing::Not(HasSubstr("SCAN v"))));
  const std::string one_cell = plan(store, "select metric, value from results where cell = '" + cell(3).key + "'");
  EXPECT_THAT(one_cell, AllOf(HasSubstr("SEARCH c USING INDEX sqlite_autoindex_cells_1 (key=?)"),
                              testing::Not(HasSubstr("SCAN v")), testing::Not(HasSubstr("SCAN c"))));
  EXPECT_THAT(
      plan(store, "select cell, value from results where metric = 'ate_se3_rmse_m' order by value desc limit 9"),
      testing::Not(HasSubstr("SCAN v")));
  EXPECT_THAT(plan(store, "select cell, wall_s from all_cells where wall_s > 9"),
              HasSubstr("outcomes_by_wall (wall_s>?)"));
}

TEST(StoreDocs, NameEveryWayInWhichACellEnds) {
  std::string names;
  for (const char* status : kOutcomeStatuses) names += fmt::format("{}`{}`", names.empty() ? "" : ", ", status);
  EXPECT_THAT(core::read_file(TARMAC_DOCS "/store.md"), HasSubstr("| how it ended: " + names + " |"));
}

}  // namespace
}  // namespace tarmac::scenarios
