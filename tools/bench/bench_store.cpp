// The store of a sweep, as large as they come.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "core/files.h"
#include "core/random.h"
#include "scenarios/store.h"
#include "tools/bench/cpu_clock.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

constexpr std::size_t kCells = 100'000;
constexpr std::size_t kMetrics = 60;
constexpr std::size_t kSeeds = 50, kEstimators = 5;  ///< of a case: 400 cases
constexpr std::size_t kBatch = 1000;
constexpr std::size_t kSingles = 200;  ///< cells that are finished one by one, as a sweep does
constexpr int kRuns = 3;

scenarios::Cell make_cell(std::size_t i) {
  scenarios::Cell cell;
  const std::size_t drive = i / kEstimators, number = drive / kSeeds;
  cell.key = core::hex16(0x5eed0000 + i);
  cell.world = core::hex16(0xd17e0000 + drive);
  cell.block = fmt::format("block-{}", number / 100);
  cell.scenario = "quick-brake";
  cell.case_name = fmt::format("{} motion.cruise_m_s={}", cell.block, number % 100);
  cell.seed = 1 + drive % kSeeds;
  cell.estimator = fmt::format("estimator-{}", i % kEstimators);
  cell.parameters = {{"motion.cruise_m_s", std::to_string(number % 100)}};
  return cell;
}

std::string metric_name(std::size_t k) {
  return fmt::format("metric_{:02}_rmse_m", k);
}

scenarios::CellResult make_result(const core::RandomStream& random, std::size_t i) {
  scenarios::CellResult result;
  result.cell = make_cell(i);
  result.outcome.status = i % 97 == 3 ? "timed_out" : "ok";
  result.outcome.recording_hash = result.cell.world;
  result.outcome.wall_s = 2 + std::abs(random.normal(i, kMetrics));
  result.outcome.folder = "cells/" + result.cell.key;
  result.outcome.command = "tarmac run quick-brake --seed 1 -e kiss-icp --set motion.cruise_m_s=5";
  if (result.outcome.failed()) return result;
  for (std::size_t k = 0; k < kMetrics; ++k) {
    scenarios::MetricValue metric;
    metric.metric = metric_name(k);
    metric.unit = "m";
    metric.deterministic = k % 10 != 0;
    if (k % 12 == 11) {
      metric.status = "n/a: no segment of that length";
    } else {
      metric.value = std::exp(0.3 * random.normal(i, static_cast<std::uint32_t>(k)));
    }
    if (k % 4 == 0) {
      metric.ci_low = 0.9 * metric.value.value_or(0);
      metric.ci_high = 1.1 * metric.value.value_or(0);
    }
    result.metrics.push_back(std::move(metric));
  }
  return result;
}

struct Filling {
  double bulk_s = 0, single_ms = 0;  ///< processor time: of all but the last cells; of each of the last
};

Filling fill(const std::filesystem::path& folder, const core::Progress& progress) {
  const core::RandomStream random(1, "bench/store");
  std::vector<scenarios::Cell> cells;
  for (std::size_t i = 0; i < kCells; ++i) cells.push_back(make_cell(i));
  auto store = scenarios::Store::create(folder, {"bench", "0", "bench"}, "", cells);
  store.start(false);
  Filling filling;
  std::vector<scenarios::CellResult> results;
  for (std::size_t i = 0; i < kCells - kSingles; ++i) {
    results.push_back(make_result(random, i));
    if (results.size() < kBatch && i + 1 < kCells - kSingles) continue;
    filling.bulk_s += cpu_s_of([&] { store.finish(results); });
    results.clear();
    progress(0.7 * static_cast<double>(i) / kCells, "");
  }
  for (std::size_t i = kCells - kSingles; i < kCells; ++i) {
    const scenarios::CellResult result = make_result(random, i);
    filling.single_ms += 1e3 / kSingles * cpu_s_of([&] {
                           store.claim(result.cell.key);
                           store.finish(result.cell.key, result.outcome, result.metrics);
                         });
  }
  return filling;
}

struct Question {
  const char* metric;
  std::size_t rows;  ///< that the answer must have
  std::function<std::size_t(const scenarios::Store&)> ask;
};

std::size_t rows_of(const scenarios::Store& store, const std::string& sql) {
  return store.query(sql).rows.size();
}

std::vector<Question> questions() {
  using scenarios::ResultFilter;
  using scenarios::Store;
  ResultFilter one_metric, four_metrics, one_cell;
  one_metric.metrics = {metric_name(1)};
  four_metrics.metrics = {metric_name(1), metric_name(2), metric_name(20), metric_name(50)};
  one_cell.keys = {make_cell(kCells / 2).key};
  const std::size_t groups = kCells / kSeeds;
  return {
      {"results_of_one_metric_s", kCells, [=](const Store& s) { return s.results(one_metric).size(); }},
      {"medians_of_four_metrics_s", groups,
       [=](const Store& s) {
         return s.groups(four_metrics, {"case", "estimator"}).size();
       }},
      {"counts_by_status_s", 2,
       [](const Store& s) { return rows_of(s, "select status, count(*) from all_cells group by status"); }},
      {"slowest_cells_s", 20,
       [](const Store& s) { return rows_of(s, "select cell, wall_s from all_cells order by wall_s desc limit 20"); }},
      {"worst_cells_s", 20,
       [](const Store& s) {
         return rows_of(s,
                        "select cell, value from results where metric = 'metric_01_rmse_m' order by value desc "
                        "limit 20");
       }},
      {"one_cell_s", kMetrics, [=](const Store& s) { return s.results(one_cell).at(0).metrics.size(); }},
      {"view_of_one_metric_s", kCells - (kCells + 93) / 97,
       [](const Store& s) {
         return rows_of(s,
                        "select cell, \"case\", seed, estimator, value from results where metric = "
                        "'metric_01_rmse_m'");
       }},
      {"view_means_by_case_s", groups,
       [](const Store& s) {
         return rows_of(s,
                        "select case_name, estimator, avg(value) from results where metric = 'metric_01_rmse_m' "
                        "group by case_name, estimator");
       }},
      {"pending_s", 0, [](const Store& s) { return s.pending().size(); }},
  };
}

/// The best of some runs, each with a connection of its own.
double seconds(const Question& question, const std::filesystem::path& folder) {
  double best_s = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const auto store = scenarios::Store::open(folder, scenarios::Store::Access::read_only);
    std::size_t rows = 0;
    best_s = std::min(best_s, cpu_s_of([&] { rows = question.ask(store); }));
    if (rows != question.rows)
      throw std::runtime_error(
          fmt::format("bench store: {} gave {} rows, expected {}", question.metric, rows, question.rows));
  }
  return best_s;
}

}  // namespace

BenchRows bench_store(const Console& console) {
  const core::Progress progress = console.progress("store");
  const PrivateFolder folder;
  const std::filesystem::path store = folder.path() / "store";
  const std::string variant = fmt::format("{}-cells-{}-metrics", kCells, kMetrics);
  const Filling filling = fill(store, progress);
  BenchRows rows = {{"store", variant, "fill_s", filling.bulk_s, "s"},
                    {"store", variant, "finish_one_cell_ms", filling.single_ms, "ms"}};
  const std::vector<Question> all = questions();
  for (const Question& question : all) {
    rows.push_back({"store", variant, question.metric, seconds(question, store), "s"});
    progress(0.7 + 0.3 * static_cast<double>(rows.size() - 2) / static_cast<double>(all.size()), "");
  }
  return rows;
}

}  // namespace tarmac::tools
