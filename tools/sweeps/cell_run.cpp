#include "tools/sweeps/cell_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/files.h"
#include "metrics/evaluation.h"
#include "metrics/registry.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/provenance.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

// A program that fails with less room than this has failed for want of room.
constexpr std::uintmax_t kLeastRoomBytes = 4u << 20;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// The last words of a log.
std::string tail_of(const fs::path& file, std::size_t bytes = 400) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const auto size = static_cast<std::size_t>(in.tellg());
  in.seekg(static_cast<std::streamoff>(size > bytes ? size - bytes : 0));
  std::string text(std::min(size, bytes), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

std::string last_line(const std::string& text) {
  const std::size_t at = text.rfind('\n');
  return at == std::string::npos ? text : text.substr(at + 1);
}

/// Something has failed: was it for want of room?
void throw_if_no_room(const fs::path& folder, const std::string& words_of_ours) {
  if (!lacks_room(folder, words_of_ours)) return;
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  throw NoRoom(fmt::format("{}: no room left on the disk ({:.1f} MB available){}", folder.string(),
                           error ? 0.0 : 1e-6 * static_cast<double>(space.available),
                           words_of_ours.empty() ? "" : "; last words: " + last_line(words_of_ours)));
}

/// A folder that is gone again unless it has been moved away.
class StagingFolder {
 public:
  explicit StagingFolder(fs::path path) : path_(std::move(path)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~StagingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct HelperResult {
  ChildResult child;
  Json said;  ///< when the child was ok
};

/// tarmac-cell, with its log beside `result`.
HelperResult run_helper(std::vector<std::string> words, const fs::path& result, const fs::path& log,
                        const ChildLimits& of_estimators, const core::Progress& progress) {
  ChildRequest request;
  request.limits.wall_s = 10 * of_estimators.wall_s;
  request.limits.memory_mb = 4 * of_estimators.memory_mb;
  request.command = {(program_folder() / "tarmac-cell").string()};
  request.command.insert(request.command.end(), words.begin(), words.end());
  request.command.insert(request.command.end(), {"--result", fs::absolute(result).string()});
  request.working_folder = fs::current_path();
  request.log_file = log;
  if (progress) request.progress_argument = "--progress-fd";
  request.on_progress = progress;
  HelperResult helper;
  helper.child = run_child(request);
  if (helper.child.end == ChildResult::End::not_started) throw core::InputError(helper.child.message + "; build it");
  if (helper.child.ok()) helper.said = Json::parse(core::read_file(result));
  fs::remove(result);
  return helper;
}

/// Where a cell's provenance finds the recording: relative where both lie in the store, so that it can be moved.
std::string seen_from(const fs::path& cell_folder, const fs::path& store, const fs::path& target) {
  const fs::path inside =
      fs::absolute(target).lexically_normal().lexically_relative(fs::absolute(store).lexically_normal());
  const bool below = !inside.empty() && *inside.begin() != "..";
  if (!below) return fs::absolute(target).lexically_normal().string();
  return fs::absolute(target)
      .lexically_normal()
      .lexically_relative(fs::absolute(cell_folder).lexically_normal())
      .string();
}

void save_cell_provenance(const fs::path& file, const PlannedCell& cell, const PlannedWorld& world,
                          const CachedRecording& recording, const std::string& recording_place,
                          const std::string& truth_place) {
  Provenance provenance;
  provenance.scenario = world.scenario.name;
  provenance.seed = world.seed;
  provenance.scenario_hash = world.key;
  provenance.recording_hash = recording.recording_hash;
  provenance.recording = recording_place;
  provenance.truth = truth_place;
  provenance.command = cell.command;
  provenance.options = cell.request.name + ":\n" + cell.options;
  save_provenance(file, provenance);
}

std::vector<scenarios::MetricValue> metrics_of(const metrics::Evaluation& evaluation) {
  std::vector<scenarios::MetricValue> values;
  for (const metrics::Row& row : evaluation.rows) {
    const metrics::MetricEntry* entry = metrics::find_metric(row.metric);
    const bool cost = entry && std::string_view(entry->family) == "cost";
    values.push_back({row.estimate, row.metric, row.value, row.unit, row.ci_low, row.ci_high, row.status, !cost});
  }
  return values;
}

/// Removes what the sweep does not keep.
void prune(const fs::path& folder, const std::string& keep) {
  std::vector<const char*> dropped;
  if (keep != "everything") dropped = {"diagnostics.bin", "map_sample.bin"};
  if (keep == "scores") {
    dropped.insert(dropped.end(),
                   {"trajectory.bin", "trajectory.tum", "reference.tum", "degeneracy.csv", "foreign.tum"});
  }
  for (const char* name : dropped) fs::remove(folder / name);
}

/// Scores a finished estimate; turns a failure into the cell's outcome. Returns the time of the scoring itself.
double score_cell(const StagingFolder& staging, const CachedRecording& recording, const std::string& estimator,
                  const ChildLimits& limits, FinishedCell& cell) {
  const fs::path log = staging.path() / "score.txt";
  const HelperResult scored =
      run_helper({"score", staging.path().string()}, staging.path() / "score.json", log, limits, {});
  if (!scored.child.ok()) {
    throw_if_no_room(staging.path(), tail_of(log));
    cell.outcome.status = scored.child.end == ChildResult::End::killed ? "killed" : "not_scored";
    cell.outcome.message = without_folders(fmt::format("scoring {}: {}", scored.child.message, last_line(tail_of(log))),
                                           {staging.path(), recording.folder});
    return 0;
  }
  fs::remove(log);
  const metrics::Evaluation evaluation = metrics::load_evaluation(staging.path() / estimator);
  cell.metrics = metrics_of(evaluation);
  return scored.said.at("work_s").get<double>();
}

FinishedCell with_outcome(const Outcome& outcome) {
  FinishedCell cell;
  cell.outcome.status = outcome.status;
  cell.outcome.message = outcome.message;
  cell.outcome.recording_hash = outcome.recording_hash;
  cell.outcome.wall_s = outcome.wall_s;
  cell.outcome.cpu_s = outcome.cpu_s;
  cell.outcome.peak_memory_mb = outcome.peak_memory_mb;
  return cell;
}

void put_cell_in_place(const StagingFolder& staging, const fs::path& target) {
  fs::create_directories(target.parent_path());
  fs::remove_all(target);
  fs::rename(staging.path(), target);
}

}  // namespace

bool lacks_room(const fs::path& folder, const std::string& words_of_ours) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (!error && space.available < kLeastRoomBytes) return true;
  return words_of_ours.find(std::strerror(ENOSPC)) != std::string::npos ||
         words_of_ours.find(std::strerror(EDQUOT)) != std::string::npos;
}

SimulatedDrive simulate_drive(const PlannedWorld& world, const fs::path& folder, const CellSettings& settings,
                              const core::Progress& progress) {
  const fs::path log = folder / "log.txt", scenario = folder / "scenario.yaml";
  core::write_file(scenario, world.resolved);
  std::vector<std::string> words = {"simulate", scenario.string(), folder.string()};
  if (settings.fast) words.emplace_back("--fast");
  const HelperResult made = run_helper(std::move(words), folder / "result.json", log, settings.limits, progress);
  if (made.child.ok()) {
    return {made.said.at("recording_hash").get<std::string>(), made.said.at("work_s").get<double>()};
  }
  const std::string words_of_log = tail_of(log);
  throw_if_no_room(folder, words_of_log);
  throw NotSimulated(
      made.child.end == ChildResult::End::killed ? "killed" : "not_simulated",
      without_folders(fmt::format("simulating {}: {}", made.child.message, last_line(words_of_log)), {folder}));
}

FinishedCell run_cell(const PlannedCell& planned, const PlannedWorld& world, const CachedRecording& recording,
                      const CellFolders& folders, const CellSettings& settings, const core::Progress& progress) {
  const auto began = Clock::now();
  const StagingFolder staging(folders.work / planned.cell.key);
  const fs::path target = folders.cell(planned.cell);
  const std::string& name = planned.request.name;
  const EstimatorRunSettings run_settings{1, settings.diagnostics, settings.limits, folders.work,
                                          settings.estimator_program};
  const Outcome outcome = run_one_estimator(planned.request, recording.recording(), recording.recording_hash,
                                            staging.path() / name, run_settings, progress);
  if (outcome.failed()) {
    throw_if_no_room(staging.path(), planned.request.bundled ? tail_of(staging.path() / name / "log.txt") : "");
  }
  FinishedCell cell = with_outcome(outcome);
  double work_s = outcome.wall_s;
  core::write_file(staging.path() / "scenario.yaml", resolve_scenario(world.scenario, world.seed, {planned.request}));
  const fs::path provenance = staging.path() / "provenance.json";
  if (outcome.status == "ok") {
    save_cell_provenance(provenance, planned, world, recording, recording.recording().string(),
                         recording.truth().string());
    work_s += score_cell(staging, recording, name, settings.limits, cell);
  }
  save_cell_provenance(provenance, planned, world, recording, seen_from(target, folders.store, recording.recording()),
                       seen_from(target, folders.store, recording.truth()));
  prune(staging.path() / name, settings.keep);
  put_cell_in_place(staging, target);
  cell.outcome.folder = target.lexically_relative(folders.store).string();
  cell.outcome.command = planned.command;
  cell.outcome.overhead_s = seconds_since(began) - work_s;
  return cell;
}

FinishedCell cell_without_recording(const PlannedCell& cell, const NotSimulated& why) {
  FinishedCell finished;
  finished.outcome.status = why.status;
  finished.outcome.message = why.what();
  finished.outcome.command = cell.command;
  return finished;
}

}  // namespace tarmac::tools
