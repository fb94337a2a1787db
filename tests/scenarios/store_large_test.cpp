// A store as large as they come: the answers are the right ones there too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenarios/store_cells.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::scenarios {
namespace {

using tarmac::tests::TemporaryFolder;
using testing::SizeIs;
using namespace scenarios::tests;

constexpr std::size_t kCells = 100'000, kMetrics = 20;

/// Of cell i and metric k: exact in binary, so that sums are too.
double value(std::size_t i, std::size_t k) {
  return static_cast<double>((i * 7919 + k * 104729) % 65536) / 256;
}

TEST(LargeStore, AHundredThousandCellsAreAnsweredRightly) {
  const TemporaryFolder folder;
  {
    Store store = Store::create(folder.path(), kIdentity, "", cells(kCells));
    store.start(false);
    std::vector<CellResult> batch;
    for (std::size_t i = 0; i < kCells; ++i) {
      CellResult& result = batch.emplace_back(CellResult{cell(i), outcome(i), {}});
      for (std::size_t k = 0; k < kMetrics; ++k)
        result.metrics.push_back(metric(fmt::format("metric_{}_m", k), value(i, k), "m"));
      if (batch.size() < 1000) continue;
      store.finish(batch);
      batch.clear();
    }
  }
  const Store store = Store::open(folder.path(), Store::Access::read_only);
  EXPECT_THAT(store.pending(), SizeIs(0));

  ResultFilter filter;
  filter.metrics = {"metric_7_m"};
  const std::vector<CellResult> results = store.results(filter);
  ASSERT_THAT(results, SizeIs(kCells));
  double sum = 0, expected = 0;
  for (const CellResult& result : results) sum += result.metrics.at(0).value.value();
  for (std::size_t i = 0; i < kCells; ++i) expected += value(i, 7);
  EXPECT_EQ(sum, expected);
  EXPECT_EQ(store.query("select sum(value) from results where metric = 'metric_7_m'").rows.at(0).at(0),
            fmt::format("{}", expected));

  filter.metrics = {"metric_3_m", "metric_19_m"};
  const std::vector<CellGroup> groups = store.groups(filter, {"case", "estimator"});
  double of_groups = 0;
  std::size_t members = 0;
  for (const CellGroup& group : groups) {
    for (const double x : group.metrics.at(1).values) of_groups += x;
    members += group.statuses.at("ok");
  }
  expected = 0;
  for (std::size_t i = 0; i < kCells; ++i) expected += value(i, 19);
  EXPECT_EQ(of_groups, expected);
  EXPECT_EQ(members, kCells);

  filter = {};
  filter.keys = {cell(54321).key};
  const std::vector<CellResult> one = store.results(filter);
  ASSERT_THAT(one, SizeIs(1));
  ASSERT_THAT(one[0].metrics, SizeIs(kMetrics));
  for (std::size_t k = 0; k < kMetrics; ++k) EXPECT_EQ(one[0].metrics[k].value, value(54321, k));
}

}  // namespace
}  // namespace tarmac::scenarios
