#include "tools/compare/drives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tarmac::tools {
namespace {

constexpr const char* kSeries[] = {"deskew_error_vs_time", "error_vs_time"};
constexpr double kBlock_s = 1, kSignificance = 0.05;

bool belongs(const reports::CompareRow& row, const PairedRuns& paired) {
  return row.case_name == paired.case_name && row.estimator_a == paired.estimator_a &&
         row.estimator_b == paired.estimator_b;
}

/// Size of the largest significant change, costs apart; 0: none.
double strength(const Pairing& pairing, const PairedRuns& paired) {
  double most = 0;
  for (const reports::CompareRow& row : pairing.rows)
    if (!row.cost && row.significant() && belongs(row, paired))
      most = std::max(most, std::abs(std::log(row.comparison.ratio)));
  return most;
}

/// The true path of the first seed with the times of its samples: both are at the sweeps' ends.
void add_path(const metrics::Evaluation& evaluation, reports::CompareDrive& drive) {
  const metrics::Series* path = evaluation.find("path_true");
  const metrics::Series* times = evaluation.find("speed_vs_time");
  if (!path || !times || path->x.size() != times->x.size()) return;
  drive.path_seed = evaluation.seed;
  drive.path_t_s = times->x;
  drive.path_x_m = path->x;
  drive.path_y_m = path->y;
}

bool has_evaluation(const ComparedRun& run) {
  return std::filesystem::is_regular_file(run.folder / "evaluation.json");
}

reports::CompareDrive compare_drive(const PairedRuns& paired, bool located,
                                    std::vector<reports::CompareMissing>& missing) {
  reports::CompareDrive drive;
  drive.case_name = paired.case_name;
  drive.estimator_a = paired.estimator_a;
  drive.estimator_b = paired.estimator_b;
  drive.located = located;
  std::vector<metrics::Evaluation> a, b;
  std::vector<std::uint64_t> without;
  for (std::size_t k = 0; k < paired.seeds.size(); ++k) {
    if (!has_evaluation(*paired.a[k]) || !has_evaluation(*paired.b[k])) {
      without.push_back(paired.seeds[k]);
      continue;
    }
    a.push_back(metrics::load_evaluation(paired.a[k]->folder));
    b.push_back(metrics::load_evaluation(paired.b[k]->folder));
  }
  drive.seeds = a.size();
  if (!without.empty())
    missing.push_back({"no series", fmt::format("{} on case {}", paired.estimator_b, paired.case_name),
                       fmt::format("evaluation.json is not there: seeds {}", seed_list(without)), without.size()});
  for (const char* name : kSeries) {
    std::vector<metrics::SeriesPair> pairs;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const metrics::Series *of_a = a[k].find(name), *of_b = b[k].find(name);
      if (of_a && of_b && !of_a->x.empty() && !of_b->x.empty()) pairs.push_back({of_a, of_b});
    }
    if (pairs.empty()) continue;
    // The series of a drive are read together: they share the 5 %.
    metrics::SeriesComparison series =
        metrics::compare_series(pairs, kBlock_s, kSignificance / static_cast<double>(std::size(kSeries)));
    if (!located) series.stretches.clear();
    drive.series.push_back(std::move(series));
  }
  if (!a.empty()) add_path(a.front(), drive);
  return drive;
}

}  // namespace

std::vector<reports::CompareDrive> compare_drives(const Pairing& pairing, std::size_t most,
                                                  const core::Progress& progress,
                                                  std::vector<reports::CompareMissing>& missing) {
  std::vector<std::pair<double, const PairedRuns*>> order;
  for (const PairedRuns& paired : pairing.pairs) order.push_back({strength(pairing, paired), &paired});
  std::stable_sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  if (order.size() > most) order.resize(most);
  std::vector<reports::CompareDrive> drives;
  for (std::size_t k = 0; k < order.size(); ++k) {
    progress(static_cast<double>(k) / static_cast<double>(order.size()),
             fmt::format("{} {}", order[k].second->case_name, order[k].second->estimator_b));
    reports::CompareDrive drive = compare_drive(*order[k].second, order[k].first > 0, missing);
    if (!drive.series.empty()) drives.push_back(std::move(drive));
  }
  progress(1, "");
  return drives;
}

}  // namespace tarmac::tools
