// Shards of a sweep as one store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/scenarios/store_cells.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::scenarios {
namespace {

using tarmac::tests::message_of;
using tarmac::tests::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;
using namespace scenarios::tests;
namespace fs = std::filesystem;

constexpr std::size_t kMergeCells = 12;

/// A store in which the named cells are finished, with their files.
fs::path sweep(const fs::path& folder, const std::vector<Cell>& planned, const std::vector<std::size_t>& finished,
               const StoreIdentity& identity = kIdentity) {
  Store store = Store::create(folder, identity, "name: regression\n", planned);
  store.start(false);
  for (const std::size_t i : finished) {
    fs::create_directories(folder / outcome(i).folder / "kiss-icp");
    core::write_file(folder / outcome(i).folder / "kiss-icp" / "evaluation.json", "of cell " + std::to_string(i));
    run(store, i, i == 7 ? "crashed" : "ok");
  }
  return folder;
}

/// Every n-th cell from `first` on.
std::vector<std::size_t> every(std::size_t n, std::size_t first) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = first; i < kMergeCells; i += n) numbers.push_back(i);
  return numbers;
}

std::vector<Cell> planned(const std::vector<std::size_t>& numbers) {
  std::vector<Cell> all;
  for (const std::size_t i : numbers) all.push_back(cell(i));
  return all;
}

std::string dump_of(const fs::path& folder) {
  return dump(Store::open(folder, Store::Access::read_only));
}

std::size_t merge(const std::vector<fs::path>& from, const fs::path& to) {
  return merge_stores(from, to);
}

TEST(StoreMerge, TwoShardsEqualTheUnshardedStore) {
  const TemporaryFolder folder;
  const fs::path whole = sweep(folder / "whole", cells(kMergeCells), every(1, 0));
  const fs::path a = sweep(folder / "a", planned(every(2, 0)), every(2, 0));
  const fs::path b = sweep(folder / "b", planned(every(2, 1)), every(2, 1));
  EXPECT_EQ(merge({a, b}, folder / "merged"), kMergeCells);
  EXPECT_EQ(dump_of(folder / "merged"), dump_of(whole));
  EXPECT_EQ(core::read_file(folder / "merged" / "sweep.yaml"), "name: regression\n");
  for (std::size_t i = 0; i < kMergeCells; ++i) {
    const fs::path file = fs::path(outcome(i).folder) / "kiss-icp" / "evaluation.json";
    EXPECT_EQ(core::read_file(folder.path() / "merged" / file), "of cell " + std::to_string(i));
    EXPECT_TRUE(fs::equivalent(folder.path() / "merged" / file, folder.path() / (i % 2 == 0 ? "a" : "b") / file))
        << "the same file, linked";
  }
  EXPECT_TRUE(fs::is_empty(folder / "merged" / "work"));
  // What differs from run to run comes along too.
  const auto results = Store::open(folder / "merged", Store::Access::read_only).results({});
  const auto expected = Store::open(whole, Store::Access::read_only).results({});
  ASSERT_EQ(results.size(), expected.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].outcome.wall_s, expected[i].outcome.wall_s);
    EXPECT_EQ(results[i].metrics.size(), expected[i].metrics.size());
  }
}

TEST(StoreMerge, ShardsThatEachPlannedTheWholeSweepAndOverlap) {
  const TemporaryFolder folder;
  const fs::path whole = sweep(folder / "whole", cells(kMergeCells), {0, 1, 2, 3, 4, 5, 6, 7, 8});
  const fs::path a = sweep(folder / "a", cells(kMergeCells), {0, 1, 2, 3, 4});
  const fs::path b = sweep(folder / "b", cells(kMergeCells), {3, 4, 5, 6, 7});
  const fs::path c = sweep(folder / "c", cells(kMergeCells), {7, 8});
  EXPECT_EQ(merge({a, b, c}, folder / "merged"), 9u);
  EXPECT_EQ(dump_of(folder / "merged"), dump_of(whole));
  Store merged = Store::open(folder / "merged", Store::Access::read_write);
  const StoreStart start = merged.start(false);
  EXPECT_EQ(start.pending, 3u) << "what nobody has finished can be run";
  EXPECT_EQ(start.failed, 1u);
  for (const std::size_t i : {9, 10, 11}) run(merged, i);
}

TEST(StoreMerge, AForgottenShardLeavesLessThanThePlan) {
  const TemporaryFolder folder;
  std::vector<std::string> keys;
  for (const Cell& one : cells(kMergeCells)) keys.push_back(one.key);
  StoreIdentity identity = kIdentity;
  identity.plan_hash = plan_hash_of(keys);
  std::vector<fs::path> shards;
  for (const std::size_t i : {0U, 1U, 2U})
    shards.push_back(sweep(folder / std::to_string(i), planned(every(3, i)), every(3, i), identity));
  EXPECT_EQ(merge({shards[0], shards[2]}, folder / "two"), 8u);
  EXPECT_FALSE(Store::open(folder / "two", Store::Access::read_only).holds_whole_plan());
  EXPECT_EQ(merge({shards[2], shards[0], shards[1]}, folder / "three"), kMergeCells);
  EXPECT_TRUE(Store::open(folder / "three", Store::Access::read_only).holds_whole_plan());
}

TEST(StoreMerge, WhatSomebodyKilledIsNotFinished) {
  const TemporaryFolder folder;
  const fs::path a = sweep(folder / "a", cells(4), {0});
  const fs::path b = sweep(folder / "b", cells(4), {1});
  {
    Store store = Store::open(a, Store::Access::read_write);
    store.start(false);
    run(store, 1, "killed");
    run(store, 2, "killed");
  }
  EXPECT_EQ(merge({a, b}, folder / "merged"), 2u);
  EXPECT_THAT(Store::open(folder / "merged", Store::Access::read_only).pending(), SizeIs(2));
}

/// A store with one finished cell, whose outcome and metrics somebody has changed.
fs::path changed(const fs::path& folder, const std::function<void(CellOutcome&, std::vector<MetricValue>&)>& change) {
  Store store = Store::create(folder, kIdentity, "", cells(2));
  store.start(false);
  CellOutcome result = outcome(0);
  std::vector<MetricValue> values = metrics(0);
  result.folder = "";
  change(result, values);
  store.claim(cell(0).key);
  store.finish(cell(0).key, result, values);
  return folder;
}

TEST(StoreMerge, ACellThatGaveSomethingElseElsewhereIsRefusedByNameAndColumn) {
  using Change = std::function<void(CellOutcome&, std::vector<MetricValue>&)>;
  const std::vector<std::pair<std::string, Change>> cases = {
      {"status is 'failed'", [](CellOutcome& o, auto&) { o.status = "failed"; }},
      {"recording_hash is 'other'", [](CellOutcome& o, auto&) { o.recording_hash = "other"; }},
      {"ate_se3_rmse_m (causal), value is '0.10000000000000002'",
       [](auto&, auto& m) { m[0].value = std::nextafter(*m[0].value, 1.0); }},
      {"ate_se3_rmse_m (final), value is 'n/a'", [](auto&, auto& m) { m[1].value = {}; }},
      {"ate_se3_rmse_m (causal), ci_high", [](auto&, auto& m) { m[0].ci_high = 7; }},
      {"kitti_trans_percent (causal), status", [](auto&, auto& m) { m[2].status = "ok"; }},
      {"ate_se3_rmse_m (final), ci_high is 'absent'", [](auto&, auto& m) { m.erase(m.begin() + 1); }},
      {"map_error_m (causal), ci_high is 'n/a'", [](auto&, auto& m) { m.push_back(metric("map_error_m", 1.0, "m")); }}};
  const TemporaryFolder folder;
  const fs::path first = changed(folder / "first", [](auto&, auto&) {});
  for (const auto& [message, change] : cases) {
    const fs::path second = changed(folder / "second", change);
    EXPECT_THAT(message_of<core::InputError>([&] {
                  merge({first, second}, folder / "merged");
                }),
                AllOf(HasSubstr(cell(0).key), HasSubstr("kiss-icp"), HasSubstr("seed 1"), HasSubstr(message),
                      HasSubstr(second.string())));
    EXPECT_FALSE(fs::exists(folder / "merged" / "store.sqlite"));
    fs::remove_all(second);
  }
  // Costs differ from run to run: no contradiction.
  const fs::path second = changed(folder / "second", [](CellOutcome& o, auto& m) {
    o.wall_s = 99;
    m[3].value = 99;
  });
  EXPECT_EQ(merge({first, second}, folder / "merged"), 1u);
}

TEST(StoreMerge, OnlyShardsOfOneSweepAndBuildAreMerged) {
  const TemporaryFolder folder;
  const fs::path a = sweep(folder / "a", cells(4), {0});
  int n = 0;
  for (const auto& [what, change] : std::vector<std::pair<std::string, std::function<void(StoreIdentity&)>>>{
           {"sweep", [](StoreIdentity& i) { i.sweep = "smoke"; }},
           {"plan", [](StoreIdentity& i) { i.plan_hash = "00"; }},
           {"build", [](StoreIdentity& i) { i.build = "0.1.0 other"; }}}) {
    StoreIdentity identity = kIdentity;
    change(identity);
    const fs::path b = sweep(folder / ("b" + std::to_string(n++)), cells(4), {1}, identity);
    EXPECT_THAT(message_of<core::InputError>([&] {
                  merge({a, b}, folder / "merged");
                }),
                AllOf(HasSubstr("not of the same " + what), HasSubstr(b.string())));
  }
  EXPECT_THAT(message_of<core::InputError>([&] {
                merge({a, folder / "none"}, folder / "merged");
              }),
              AllOf(HasSubstr("none"), HasSubstr("no store.sqlite")));
  EXPECT_THAT(message_of<core::InputError>([&] { merge({a}, a); }), HasSubstr("already"));
  EXPECT_THAT(message_of<core::InputError>([&] { merge({}, folder / "merged"); }), HasSubstr("no store was named"));
  Cell other = cell(0);
  other.seed = 99;
  const fs::path c = sweep(folder / "c", {other}, {});
  EXPECT_THAT(message_of<core::InputError>([&] {
                merge({a, c}, folder / "merged");
              }),
              AllOf(HasSubstr(other.key), HasSubstr("seed 99")));
  EXPECT_FALSE(fs::exists(folder / "merged" / "store.sqlite"));
}

TEST(StoreMerge, MissingFilesAndStrayPathsAreRefused) {
  const TemporaryFolder folder;
  const fs::path a = sweep(folder / "a", cells(2), {0});
  fs::remove_all(a / outcome(0).folder);
  EXPECT_THAT(message_of<core::InputError>([&] { merge({a}, folder / "merged"); }),
              AllOf(HasSubstr((a / outcome(0).folder).string()), HasSubstr("missing")));
  EXPECT_FALSE(fs::exists(folder / "merged" / "store.sqlite"));
  const fs::path b = changed(folder / "b", [](CellOutcome& o, auto&) { o.folder = "cells/../../a"; });
  EXPECT_THAT(message_of<core::InputError>([&] { merge({b}, folder / "merged"); }), HasSubstr("not inside it"));
}

}  // namespace
}  // namespace tarmac::scenarios
