#include "tools/compare/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
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

ComparedFolder read_runs(const fs::path& path, const core::Progress& progress) {
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
      out.runs.push_back(read_run(folder, provenance, runs[i].root));
  }
  progress(1, "");
  return out;
}

}  // namespace

ComparedFolder read_compared_folder(const fs::path& path, const core::Progress& progress) {
  return read_runs(path, progress);
}

}  // namespace tarmac::tools
