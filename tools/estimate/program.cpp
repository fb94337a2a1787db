#include "tools/estimate/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "estimators/registry.h"
#include "estimators/run.h"
#include "tools/estimate/outputs.h"

namespace tarmac::tools {
namespace {

struct Arguments {
  std::string recording, estimator, options, output, diagnostics = "full";
  int jobs = 1;
  int progress_fd = STDERR_FILENO;
};

void declare(CLI::App& app, Arguments& a) {
  app.add_option("--recording", a.recording, "recording folder")->required();
  app.add_option("--estimator", a.estimator, "name of the estimator")->required();
  app.add_option("--options", a.options, "YAML file with the estimator's options; without it, the defaults");
  app.add_option("--output", a.output, "folder for the results")->required();
  app.add_option("--jobs", a.jobs, "threads inside the estimator")->check(CLI::Range(1, 1024));
  app.add_option("--diagnostics", a.diagnostics, "what is recorded of every sweep: none, system or full");
  app.add_option("--progress-fd", a.progress_fd, "file descriptor for progress lines")->check(CLI::NonNegativeNumber);
}

const estimators::EstimatorEntry& find(const std::string& name) {
  if (const estimators::EstimatorEntry* entry = estimators::find_estimator(name)) return *entry;
  std::vector<std::string> names;
  for (const estimators::EstimatorEntry* entry : estimators::estimators()) names.emplace_back(entry->name);
  const std::string meant = core::did_you_mean(name, names);
  throw core::InputError(fmt::format("--estimator {}: there is none of that name{}; there are {}", name,
                                     meant.empty() ? "" : fmt::format(" (did you mean {}?)", meant),
                                     fmt::join(names, ", ")));
}

/// At most ten lines a second, and the last one.
class ProgressLines {
 public:
  explicit ProgressLines(int fd) : fd_(fd) {}
  void operator()(double fraction, const std::string& note) {
    const auto now = std::chrono::steady_clock::now();
    if (fraction < 1 && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    const std::string line = fmt::format("progress {:.4f} {}\n", fraction, note);
    [[maybe_unused]] const auto written = ::write(fd_, line.data(), line.size());
  }

 private:
  int fd_;
  std::chrono::steady_clock::time_point last_{};
};

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void log_run(const estimators::RunResult& run) {
  for (const std::string& line : run.log) say(line);
  const auto& sweeps = run.estimate.sweeps;
  const auto ok = std::count_if(sweeps.begin(), sweeps.end(),
                                [](const core::SweepResult& s) { return s.status == core::SweepStatus::ok; });
  say(fmt::format("{}: {}, {} of {} sweeps ok, {:.1f} s, peak memory {:.0f} MB", run.estimate.estimator,
                  core::name_of(run.estimate.status), ok, sweeps.size(), run.timing.wall_s, run.timing.peak_memory_mb));
  if (!run.estimate.message.empty()) say(run.estimate.message);
}

int estimate(const Arguments& a, const RecordingChange& change) {
  const estimators::EstimatorEntry& entry = find(a.estimator);
  const core::DiagnosticsLevel level = core::diagnostics_level(a.diagnostics);
  const core::ConfigNode options = a.options.empty() ? core::ConfigNode() : core::ConfigNode::load(a.options);
  begin_outputs(a.output);  // from here on an earlier result cannot be taken for this run's
  core::Recording recording = core::Recording::open(a.recording);
  if (change) recording = change(recording, a.output);
  say(fmt::format("{}: {} sweeps of recording {}, threads: {}", entry.name,
                  recording.rig().lidars.empty() ? 0 : recording.sweep_count(), recording.hash(), a.jobs));
  std::optional<core::DiagnosticsWriter> diagnostics;  // without a sweep there is no file
  const estimators::RunResult run = estimators::run_estimator(
      recording, entry, options, {.rig = recording.rig(), .threads = a.jobs, .diagnostics = level},
      ProgressLines(a.progress_fd), [&](const core::SweepDiagnostics& sweep) {
        if (!diagnostics) diagnostics.emplace(std::filesystem::path(a.output) / "diagnostics.bin");
        diagnostics->append(sweep);
      });
  if (diagnostics) diagnostics->finish();
  write_outputs(a.output, run);
  log_run(run);
  return run.estimate.status == core::RunStatus::failed ? 3 : 0;
}

}  // namespace

int estimate_program(int argc, char** argv, const RecordingChange& change) {
  std::signal(SIGPIPE, SIG_IGN);  // a parent that no longer listens is no reason to stop
  CLI::App app("Runs one estimator over one recording. `tarmac estimate` calls it.", "tarmac-estimate");
  Arguments arguments;
  declare(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return estimate(arguments, change);
  } catch (const core::InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return 4;
  }
}

}  // namespace tarmac::tools
