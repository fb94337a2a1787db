#include "tools/tarmac/evaluation_run.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "metrics/degeneracy/oracle.h"
#include "metrics/evaluate.h"
#include "sim/truth/ground_truth.h"
#include "tools/tarmac/outcome.h"
#include "tools/tarmac/provenance.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// Paths in provenance are relative to the run's folder where they lie inside it.
fs::path resolve(const RunFolder& run, const std::string& path) {
  return fs::path(path).is_absolute() ? fs::path(path) : run.root / path;
}

metrics::Evaluation evaluate_one(const fs::path& folder, const Outcome& outcome, const core::Recording& recording,
                                 const sim::truth::GroundTruth* truth, const metrics::Oracle* oracle, int threads) {
  if (outcome.status != "ok") {
    metrics::Evaluation evaluation;
    if (truth) evaluation.scenario = truth->scenario;
    if (truth) evaluation.seed = truth->seed;
    evaluation.estimator = outcome.estimator;
    evaluation.status = outcome.status;
    evaluation.message = outcome.message;
    return evaluation;
  }
  const core::Estimate estimate = core::load_estimate(folder / "trajectory.bin");
  const core::RunTiming timing = core::load_timing(folder / "timing.json");
  std::optional<core::DiagnosticsReader> reader;
  metrics::DiagnosticsSource diagnostics;
  if (fs::is_regular_file(folder / "diagnostics.bin")) {
    reader.emplace(folder / "diagnostics.bin");
    diagnostics = metrics::diagnostics_of(*reader);
  }
  return metrics::evaluate(estimate, recording, truth, &timing, {.threads = threads}, reader ? &diagnostics : nullptr,
                           oracle);
}

}  // namespace

std::vector<metrics::Evaluation> evaluate_run(const RunFolder& run, int threads, const Console& console) {
  const Provenance provenance = load_provenance(run.provenance());
  const core::Recording recording = core::Recording::open(resolve(run, provenance.recording));
  std::optional<sim::truth::GroundTruth> truth;  // a recording from outside has none
  if (!provenance.truth.empty()) truth = sim::truth::load_ground_truth(resolve(run, provenance.truth));
  const std::vector<fs::path> folders = estimator_folders(run);
  const core::Progress progress = console.progress("evaluate");
  std::optional<metrics::Oracle> oracle;  // the recording's, for all its estimates
  if (truth && !folders.empty()) {
    progress(0, "oracle");
    oracle = metrics::make_oracle(recording, *truth, {.threads = threads});
  }
  std::vector<metrics::Evaluation> evaluations;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const Outcome outcome = load_outcome(folders[i]);
    if (outcome.recording_hash != recording.hash()) {
      throw core::InputError(
          fmt::format("{}: ran on recording {}, but the run's recording is {} now; run the estimator again",
                      folders[i].string(), outcome.recording_hash, recording.hash()));
    }
    progress(static_cast<double>(i) / static_cast<double>(folders.size()), outcome.estimator);
    evaluations.push_back(
        evaluate_one(folders[i], outcome, recording, truth ? &*truth : nullptr, oracle ? &*oracle : nullptr, threads));
    metrics::save_evaluation(folders[i], evaluations.back());
  }
  progress(1.0, "");
  return evaluations;
}

std::vector<metrics::Evaluation> load_evaluations(const RunFolder& run) {
  std::vector<metrics::Evaluation> evaluations;
  for (const fs::path& folder : estimator_folders(run)) {
    if (!fs::is_regular_file(folder / "evaluation.json")) {
      throw core::InputError(fmt::format("{}: has no evaluation.json; run `tarmac evaluate {}` first", folder.string(),
                                         run.root.string()));
    }
    evaluations.push_back(metrics::load_evaluation(folder));
  }
  return evaluations;
}

}  // namespace tarmac::tools
