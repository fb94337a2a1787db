#include "tools/compare/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "metrics/compare.h"
#include "scenarios/store.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/provenance.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// Version and commit of a provenance.json; empty where it does not say.
std::string build_of(const std::string& provenance_json) {
  const auto json = nlohmann::json::parse(provenance_json, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("build") || !json["build"].is_object()) return "";
  const auto& build = json["build"];
  return fmt::format("{} {}", build.value("version", ""), build.value("commit", ""));
}

void remember_build(const std::string& build, ComparedFolder& into) {
  if (build.empty() || into.build.find(build) != std::string::npos) return;
  into.build += (into.build.empty() ? "" : ", ") + build;
}

template <class T>
void remember(const T& value, std::vector<T>& list) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

void keep_wanted(const FolderFilter& filter, ComparedRun run, ComparedFolder& into) {
  remember(run.case_name, into.cases);
  remember(run.estimator, into.estimators);
  if (!filter.case_name.empty() && run.case_name != filter.case_name) return;
  if (!filter.estimator.empty() && run.estimator != filter.estimator) return;
  std::erase_if(run.rows, [&](const metrics::Row& row) { return !filter.wants(row.metric); });
  into.runs.push_back(std::move(run));
}

ComparedRun read_run(const fs::path& folder, const Provenance& provenance, const fs::path& root) {
  if (!fs::is_regular_file(folder / "evaluation.json")) {
    throw core::InputError(
        fmt::format("{}: has no evaluation.json; run `tarmac evaluate {}` first", folder.string(), root.string()));
  }
  metrics::Evaluation evaluation = metrics::load_evaluation(folder);
  ComparedRun run;
  run.case_name = provenance.scenario.empty() ? "recording " + provenance.recording_hash : provenance.scenario;
  run.seed = provenance.seed;
  run.estimator = std::move(evaluation.estimator);
  run.status = std::move(evaluation.status);
  run.message = std::move(evaluation.message);
  run.recording_hash = provenance.recording_hash;
  run.folder = folder;
  run.rows = std::move(evaluation.rows);
  return run;
}

ComparedFolder read_runs(const fs::path& path, const FolderFilter& filter, const core::Progress& progress) {
  ComparedFolder out;
  out.path = path;
  const std::vector<RunFolder> runs = runs_below(path);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    progress(static_cast<double>(i) / static_cast<double>(runs.size()), runs[i].root.string());
    const std::string text = core::read_file(runs[i].provenance());
    if (out.provenance_json.empty()) out.provenance_json = text;
    remember_build(build_of(text), out);
    const Provenance provenance = load_provenance(runs[i].provenance());
    for (const fs::path& folder : estimator_folders(runs[i]))
      keep_wanted(filter, read_run(folder, provenance, runs[i].root), out);
  }
  progress(1, "");
  return out;
}

metrics::Row row_of(const scenarios::MetricValue& value) {
  return {value.estimate, value.metric, value.value, value.unit, value.ci_low, value.ci_high, value.status};
}

ComparedRun run_of(scenarios::CellResult& result, const fs::path& store) {
  ComparedRun run;
  run.case_name = result.cell.case_name;
  run.seed = result.cell.seed;
  run.estimator = result.cell.estimator;
  run.status = result.outcome.status;
  run.message = result.outcome.message;
  run.recording_hash = result.outcome.recording_hash;
  run.folder = store / result.outcome.folder / result.cell.estimator;
  for (const scenarios::MetricValue& value : result.metrics) run.rows.push_back(row_of(value));
  return run;
}

ComparedFolder read_store(const fs::path& path, const FolderFilter& filter, const core::Progress& progress) {
  const scenarios::Store store = scenarios::Store::open(path, scenarios::Store::Access::read_only);
  ComparedFolder out;
  out.path = path;
  out.build = store.identity().build;
  out.cases = store.distinct("case");
  out.estimators = store.distinct("estimator");
  scenarios::ResultFilter wanted;
  if (!filter.case_name.empty()) wanted.cases = {filter.case_name};
  if (!filter.estimator.empty()) wanted.estimators = {filter.estimator};
  for (const std::string& metric : store.distinct("metric"))
    if (filter.wants(metric)) wanted.metrics.push_back(metric);
  if (wanted.metrics.empty()) wanted.metrics = {"-"};  // none would be all
  progress(0.1, "reading the store");
  std::vector<scenarios::CellResult> results = store.results(wanted);
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (i % 1000 == 0) progress(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(results.size()), "");
    out.runs.push_back(run_of(results[i], path));
    const fs::path provenance = path / results[i].outcome.folder / "provenance.json";
    if (out.provenance_json.empty() && fs::is_regular_file(provenance))
      out.provenance_json = core::read_file(provenance);
    results[i].metrics.clear();
  }
  for (const scenarios::Cell& cell : store.unfinished()) {
    out.unfinished += (filter.case_name.empty() || cell.case_name == filter.case_name) &&
                      (filter.estimator.empty() || cell.estimator == filter.estimator);
  }
  progress(1, "");
  return out;
}

}  // namespace

bool FolderFilter::wants(const std::string& metric) const {
  if (!metrics.empty()) return std::find(metrics.begin(), metrics.end(), metric) != metrics.end();
  const metrics::MetricEntry* entry = metrics::find_metric(metric);
  return !entry || !metrics::describes_drive(*entry);
}

ComparedFolder read_compared_folder(const fs::path& path, const FolderFilter& filter, const core::Progress& progress) {
  if (!fs::is_directory(path)) throw core::InputError(fmt::format("{}: there is no such folder", path.string()));
  return fs::exists(path / "store.sqlite") ? read_store(path, filter, progress) : read_runs(path, filter, progress);
}

}  // namespace tarmac::tools
