#include "tools/tarmac/results_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/diagnostics.h"
#include "core/error.h"
#include "core/estimate.h"
#include "metrics/pool.h"

namespace tarmac::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The columns of the printed table: metric, heading, factor to the heading's unit, decimals.
struct Column {
  const char* metric;
  const char* heading;
  double factor;
  int decimals;
};
constexpr Column kColumns[] = {{"end_error_percent", "end error %", 1, 3},
                               {"ate_se3_rmse_m", "ATE SE3 m", 1, 3},
                               {"rpe_1sweep_trans_rmse_m", "RPE 1 sweep mm", 1e3, 1},
                               {"point_error_rms_m", "point RMS m", 1, 3},
                               {"deskew_error_rms_m", "deskew RMS mm", 1e3, 1},
                               {"sweep_time_p50_ms", "ms/sweep p50", 1, 1},
                               {"coverage_percent", "coverage %", 1, 1}};

Json optional_json(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json row_json(const metrics::Row& row, const std::string& scenario, std::uint64_t seed, const std::string& estimator) {
  return {{"scenario", scenario},
          {"seed", seed},
          {"estimator", estimator},
          {"estimate", row.estimate},
          {"metric", row.metric},
          {"value", optional_json(row.value)},
          {"unit", row.unit},
          {"ci_low", optional_json(row.ci_low)},
          {"ci_high", optional_json(row.ci_high)},
          {"status", row.status}};
}

/// Estimators in order of first appearance, each with its evaluations; scenarios apart.
std::vector<std::pair<std::string, std::vector<const metrics::Evaluation*>>> by_estimator(
    const std::vector<metrics::Evaluation>& evaluations, bool one_scenario) {
  const auto name_of = [&](const metrics::Evaluation& e) {
    return one_scenario ? e.estimator : e.scenario + "/" + e.estimator;
  };
  std::vector<std::pair<std::string, std::vector<const metrics::Evaluation*>>> groups;
  for (const metrics::Evaluation& evaluation : evaluations) {
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == name_of(evaluation); });
    if (group == groups.end()) group = groups.insert(groups.end(), {name_of(evaluation), {}});
    group->second.push_back(&evaluation);
  }
  return groups;
}

std::string status_text(const std::vector<const metrics::Evaluation*>& seeds) {
  std::string text;
  for (const metrics::Evaluation* e : seeds) {
    if (e->status == "ok" || text.find(e->status) != std::string::npos) continue;
    text += (text.empty() ? "" : ", ") + e->status;
  }
  return text.empty() ? "ok" : text;
}

std::vector<std::string> pooled_line(const std::string& name, const std::vector<const metrics::Evaluation*>& seeds) {
  std::vector<std::string> line = {name};
  const auto has_rows = [](const metrics::Evaluation* e) { return !e->rows.empty(); };
  std::vector<metrics::PooledRow> rows;
  if (std::any_of(seeds.begin(), seeds.end(), has_rows)) rows = metrics::pool(seeds);
  line.push_back(fmt::format("{} of {}", std::count_if(seeds.begin(), seeds.end(), has_rows), seeds.size()));
  for (const Column& column : kColumns) {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.row.metric == column.metric; });
    line.push_back(found == rows.end() || !found->row.value
                       ? "n/a"
                       : fmt::format("{:.{}f}", *found->row.value * column.factor, column.decimals));
  }
  line.push_back(status_text(seeds));
  return line;
}

}  // namespace

void print_results(const std::vector<metrics::Evaluation>& evaluations, bool json) {
  if (json) {
    Json rows = Json::array();
    for (const metrics::Evaluation& e : evaluations) {
      for (const metrics::Row& row : e.rows) rows.push_back(row_json(row, e.scenario, e.seed, e.estimator));
      if (e.rows.empty()) {
        metrics::Row none;
        none.status = "failed: " + e.status;
        rows.push_back(row_json(none, e.scenario, e.seed, e.estimator));
      }
    }
    fmt::print("{}\n", rows.dump(1));
    return;
  }
  const bool one_scenario = std::all_of(evaluations.begin(), evaluations.end(),
                                        [&](const auto& e) { return e.scenario == evaluations.front().scenario; });
  const auto groups = by_estimator(evaluations, one_scenario);
  std::vector<std::vector<std::string>> lines = {{"estimator", "runs scored"}};
  for (const Column& column : kColumns) lines[0].emplace_back(column.heading);
  lines[0].emplace_back("status");
  for (const auto& [name, seeds] : groups) lines.push_back(pooled_line(name, seeds));
  print_table(lines);
  const auto several = [](const auto& group) { return group.second.size() > 1; };
  if (std::any_of(groups.begin(), groups.end(), several))
    fmt::print("figures are medians over the runs that were scored\n");
}

void print_estimates(const RunFolder& run, const std::vector<Outcome>& outcomes, bool json) {
  std::vector<std::vector<std::string>> lines = {
      {"estimator", "sweeps", "ok", "path m", "shortest step m", "longest step m", "CPU s", "status"}};
  Json rows = Json::array();
  for (const Outcome& outcome : outcomes) {
    std::size_t sweeps = 0, ok = 0;
    double path_m = 0, shortest_m = INFINITY, longest_m = 0;
    if (outcome.status == "ok") {
      const core::Estimate estimate = core::load_estimate(run.root / outcome.estimator / "trajectory.bin");
      const core::SweepResult* before = nullptr;
      sweeps = estimate.sweeps.size();
      for (const core::SweepResult& sweep : estimate.sweeps) {
        if (sweep.status != core::SweepStatus::ok) continue;
        ++ok;
        if (before) {
          const double step_m = (sweep.T_map_body.translation() - before->T_map_body.translation()).norm();
          path_m += step_m;
          shortest_m = std::min(shortest_m, step_m);
          longest_m = std::max(longest_m, step_m);
        }
        before = &sweep;
      }
    }
    const bool has_steps = ok > 1;
    lines.push_back({outcome.estimator, std::to_string(sweeps), std::to_string(ok), fmt::format("{:.3f}", path_m),
                     has_steps ? fmt::format("{:.4f}", shortest_m) : "n/a",
                     has_steps ? fmt::format("{:.4f}", longest_m) : "n/a", fmt::format("{:.2f}", outcome.cpu_s),
                     outcome.status});
    rows.push_back({{"estimator", outcome.estimator},
                    {"status", outcome.status},
                    {"message", outcome.message},
                    {"sweeps", sweeps},
                    {"sweeps_ok", ok},
                    {"path_m", path_m},
                    {"shortest_step_m", has_steps ? Json(shortest_m) : Json(nullptr)},
                    {"longest_step_m", has_steps ? Json(longest_m) : Json(nullptr)},
                    {"cpu_s", outcome.cpu_s}});
  }
  json ? fmt::print("{}\n", rows.dump(1)) : print_table(lines);
}

void print_rows(const std::vector<metrics::Row>& rows, bool json) {
  if (json) {
    Json out = Json::array();
    for (const metrics::Row& row : rows) out.push_back(row_json(row, "", 0, ""));
    fmt::print("{}\n", out.dump(1));
    return;
  }
  std::vector<std::vector<std::string>> lines = {{"metric", "value", "unit", "status"}};
  for (const metrics::Row& row : rows) {
    lines.push_back({row.metric, row.value ? fmt::format("{:.6g}", *row.value) : "n/a", row.unit, row.status});
  }
  print_table(lines);
}

}  // namespace tarmac::tools
