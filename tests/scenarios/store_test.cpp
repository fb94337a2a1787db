// One process and its store.
#include "scenarios/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
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

}  // namespace
}  // namespace tarmac::scenarios
