#include "tools/tarmac/estimator_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "estimators/registry.h"
#include "io/sensor/plain.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/foreign.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bundled_names() {
  std::vector<std::string> names;
  for (const auto* entry : estimators::estimators()) names.emplace_back(entry->name);
  return names;
}

/// The block of that name, from the first of `blocks` that has one.
core::ConfigNode find_block(const std::string& name, const std::vector<core::ConfigNode>& blocks) {
  for (const core::ConfigNode& block : blocks) {
    if (const core::ConfigNode node = block.child(name); node.present()) return node;
  }
  return {};
}

/// Names become folders beside the recording and the truth.
void check_foreign_name(const EstimatorRequest& request) {
  const std::string& name = request.name;
  const bool plain = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") == std::string::npos &&
                     name.front() != '-' && name.front() != '_';
  const bool taken = name == "recording" || name == "truth" || name == "latest";
  if (plain && !taken) return;
  request.options.fail(fmt::format("'{}' cannot name an estimator: {}", name,
                                   taken ? "a run has a folder of that name"
                                         : "expected small letters, digits, '-' and '_', a letter or digit first"));
}

EstimatorRequest request_one(const std::string& name, const std::vector<core::ConfigNode>& blocks,
                             const std::vector<std::string>& known) {
  EstimatorRequest request;
  request.name = name;
  request.options = find_block(name, blocks);
  request.bundled = estimators::find_estimator(name);
  if (request.bundled) {
    if (request.options.child("command").present()) {
      request.options.fail(fmt::format("'{}' is a bundled estimator; give the foreign program another name", name));
    }
    request.bundled->resolve(request.options);  // throws for bad options
    return request;
  }
  if (!request.options.present()) {
    const std::string guess = core::did_you_mean(name, known);
    throw core::InputError(fmt::format(
        "-e {}: there is no such estimator{}; bundled are {}; a program of your own needs a block "
        "`{}: {{command: [...]}}` under `estimators:` in the scenario or in a --config file",
        name, guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess), fmt::join(bundled_names(), ", "), name));
  }
  check_foreign_name(request);
  request.options.read(request.tool);
  if (request.tool.command.empty()) {
    request.options.fail_at("command", "is missing; expected [program, '{input}', '{output}']");
  }
  return request;
}

/// Moves a finished staging folder into place, replacing what stands there.
void put_in_place(const fs::path& from, const fs::path& to) {
  fs::path staged = to;
  staged += ".part";
  fs::remove_all(staged);
  std::error_code error;
  fs::rename(from, staged, error);
  if (error) fs::copy(from, staged, fs::copy_options::recursive);
  fs::remove_all(to);
  fs::rename(staged, to);
}

Outcome outcome_of(const EstimatorRequest& request, const ChildResult& child, int threads) {
  Outcome outcome{request.name, "ok", child.message, child.wall_s, child.cpu_s, child.peak_memory_mb, threads, {}};
  switch (child.end) {
    case ChildResult::End::not_started:
      outcome.status = "failed";
      break;
    case ChildResult::End::signalled:
      outcome.status = "crashed";
      break;
    case ChildResult::End::killed:
      outcome.status = "killed";
      break;
    case ChildResult::End::timed_out:
      outcome.status = "timed_out";
      break;
    case ChildResult::End::out_of_memory:
      outcome.status = "out_of_memory";
      break;
    case ChildResult::End::exited:
      outcome.status = child.code == 0 ? "ok" : "failed";
      break;
  }
  return outcome;
}

/// One run's inputs, laid out in a private folder: recording/ or input/, options.yaml, output/.
class Workplace {
 public:
  Workplace(const fs::path& recording_folder, const EstimatorRequest& request, const fs::path& below)
      : folder_(below.empty() ? fs::temp_directory_path() : below) {
    fs::create_directory(output());
    if (request.bundled) {
      lend_files(recording_folder, folder_.path() / "recording");
      core::write_file(folder_.path() / "options.yaml", request.options.present() ? request.options.text() : "{}\n");
    } else {
      io::export_plain(core::Recording::open(recording_folder), folder_.path() / "input",
                       [](double, const std::string&) {});
    }
  }
  fs::path output() const { return folder_.path() / "output"; }
  const fs::path& path() const { return folder_.path(); }

 private:
  PrivateFolder folder_;
};

ChildRequest bundled_command(const EstimatorRequest& request, const EstimatorRunSettings& settings) {
  ChildRequest child;
  const fs::path& given = settings.estimator_program;
  child.command = {given.empty() ? (program_folder() / "tarmac-estimate").string() : fs::absolute(given).string(),
                   "--recording",
                   "recording",
                   "--estimator",
                   request.name,
                   "--options",
                   "options.yaml",
                   "--output",
                   "output",
                   "--jobs",
                   std::to_string(settings.threads),
                   "--diagnostics",
                   settings.diagnostics};
  child.progress_argument = "--progress-fd";
  return child;
}

/// Reads what a bundled estimator wrote; turns damage into an outcome.
void check_bundled(const fs::path& output, Outcome& outcome) {
  if (outcome.failed()) return;
  try {
    const core::Estimate estimate = core::load_estimate(output / "trajectory.bin");
    if (estimate.status == core::RunStatus::ok) return;
    outcome.status = name_of(estimate.status);
    outcome.message = estimate.message;
  } catch (const core::InputError& error) {
    outcome.status = fs::exists(output / "trajectory.bin") ? "bad_output" : "no_output";
    outcome.message = error.what();
  }
}

}  // namespace

void ForeignTool::visit(core::OptionVisitor& v) {
  v("command", command, "program and arguments; {input} becomes the plain folder, {output} the TUM file to write");
  v.choice("frame", frame, {"lidar", "body"}, "whose pose the program writes");
  v.choice("interpolation", interpolation, {"se3", "slerp", "hold"}, "what holds between two of its poses");
  v("timeout_s", timeout_s, "after which the program is ended", {.above = 0});
}

std::vector<core::ConfigNode> estimator_blocks(const scenarios::Scenario& scenario, const std::string& config,
                                               const std::vector<scenarios::Override>& overrides) {
  std::vector<core::ConfigNode> blocks;
  if (!config.empty()) {
    core::ConfigNode file = core::ConfigNode::load(config);
    // A block of --config stands in for the scenario's of that name; what --set says holds for either.
    for (const auto& [key, value] : overrides) {
      if (key.starts_with("estimators.")) file.set(key, value);
    }
    file.allow_only({"estimators"});
    blocks.push_back(file.child("estimators"));
  }
  blocks.push_back(scenario.estimators);
  return blocks;
}

std::vector<EstimatorRequest> request_estimators(const std::string& list, const std::vector<core::ConfigNode>& blocks) {
  std::vector<std::string> known = bundled_names(), wanted;
  for (const core::ConfigNode& block : blocks) {
    for (const std::string& key : block.keys()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      if (!block.child(key).child("command").present()) {
        const std::string guess = core::did_you_mean(key, bundled_names());
        block.child(key).fail(
            fmt::format("there is no such bundled estimator{}; a program of your own needs `command:`",
                        guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess)));
      }
      known.push_back(key);
    }
  }
  if (list == "all") {
    wanted = known;
  } else {
    std::istringstream in(list);
    for (std::string name; std::getline(in, name, ',');) {
      if (name.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) continue;
      wanted.push_back(name);
    }
  }
  if (wanted.empty()) throw core::InputError("-e: expected estimator names such as kiss-icp,rigid-icp, or all");
  std::vector<EstimatorRequest> requests;
  for (const std::string& name : wanted) requests.push_back(request_one(name, blocks, known));
  return requests;
}

std::string resolved_options(const EstimatorRequest& request) {
  if (request.bundled) return request.bundled->resolve(request.options);
  return core::write_options(request.tool, 4);
}

Outcome run_one_estimator(const EstimatorRequest& request, const fs::path& recording_folder,
                          const std::string& recording_hash, const fs::path& target,
                          const EstimatorRunSettings& settings, const core::Progress& progress) {
  const Workplace place(recording_folder, request, settings.work_folder);
  ChildRequest child =
      request.bundled ? bundled_command(request, settings) : foreign_command(request.tool, place.path());
  child.limits = settings.limits;
  if (!request.bundled) {
    const double own_s = request.tool.timeout_s, all_s = settings.limits.wall_s;
    child.limits.wall_s = all_s > 0 ? std::min(own_s, all_s) : own_s;
  }
  child.working_folder = place.path();
  child.log_file = place.output() / "log.txt";
  child.on_progress = [&](double fraction, const std::string& note) { progress(std::min(fraction, 0.999), note); };
  const ChildResult result = run_child(child);
  if (request.bundled && result.end == ChildResult::End::not_started) {
    // Not the method's failure: our own program is missing, as it is while a build links it.
    throw core::InputError(result.message + "; build it, or give another with --estimator-program");
  }

  Outcome outcome = outcome_of(request, result, request.bundled ? settings.threads : 0);
  outcome.recording_hash = recording_hash;
  if (request.bundled) {
    check_bundled(place.output(), outcome);
  } else {
    adopt_foreign_output(request.name, request.tool, recording_folder, place.output(), result, outcome);
  }
  outcome.message = without_folders(outcome.message, {place.output(), place.path()});
  save_outcome(place.output(), outcome);
  put_in_place(place.output(), target);
  progress(1.0, outcome.status == "ok" ? fmt::format("{:.1f} s CPU", outcome.cpu_s) : outcome.status);
  return outcome;
}

std::vector<Outcome> run_estimators(const std::vector<EstimatorRequest>& requests, const fs::path& recording_folder,
                                    const fs::path& folder, const EstimatorRunSettings& settings,
                                    const Console& console) {
  for (const EstimatorRequest& request : requests) fs::remove_all(folder / request.name);
  fs::create_directories(folder);
  const std::string hash = core::Recording::open(recording_folder).hash();
  std::vector<Outcome> outcomes;
  for (const EstimatorRequest& request : requests) {
    const Outcome outcome = run_one_estimator(request, recording_folder, hash, folder / request.name, settings,
                                              console.progress(request.name));
    if (outcome.failed()) {
      console.warn(fmt::format("{}: {}: {} (log: {})", request.name, outcome.status, outcome.message,
                               (folder / request.name / "log.txt").string()));
    }
    outcomes.push_back(outcome);
  }
  return outcomes;
}

}  // namespace tarmac::tools
