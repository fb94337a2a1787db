/// tarmac-cell: the parts of a sweep's cell that are not the estimator, each in a process of its own: simulating a
/// drive, and scoring an estimate. `tarmac sweep` calls it.
///
///   tarmac-cell simulate SCENARIO.yaml FOLDER --result F    resolved scenario -> FOLDER/recording, FOLDER/truth
///   tarmac-cell score RUN_FOLDER --result F                 as `tarmac evaluate` does, one thread
///
/// F: what it says of its work, as JSON. Exit codes: 0 done, 2 bad input, 4 internal error.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/world/mesh_readers.h"
#include "core/files.h"
#include "scenarios/scenario.h"
#include "tools/tarmac/evaluation_run.h"
#include "tools/tarmac/interrupt.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct Arguments {
  std::string scenario, folder, result;
  bool fast = false;
};

/// "progress FRACTION NOTE" on descriptor 3, at most five times a second.
core::Progress progress_lines(int fd) {
  return [fd, last = Clock::time_point{}](double fraction, const std::string& note) mutable {
    throw_if_interrupted();
    if (fraction < 1 && Clock::now() - last < std::chrono::milliseconds(200)) return;
    last = Clock::now();
    const std::string line = fmt::format("progress {:.4f} {}\n", fraction, note);
    [[maybe_unused]] const auto written = ::write(fd, line.data(), line.size());
  };
}

Json simulate_world(const Arguments& a, int progress_fd) {
  const scenarios::Scenario scenario = scenarios::load_scenario(a.scenario, {});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  const sim::SimulationInput input = build_world(scenario, seed, core::read_file(a.scenario));
  sim::check(input);
  const std::filesystem::path folder = a.folder;
  const sim::SimulationSummary summary = sim::simulate(input, {.threads = 1, .fast = a.fast}, folder / "recording",
                                                       folder / "truth", progress_lines(progress_fd));
  return {{"recording_hash", summary.recording_hash},
          {"isa", summary.isa},
          {"sweeps", summary.sweeps},
          {"rays", summary.rays},
          {"points", summary.points},
          {"wall_s", summary.wall_s},
          {"real_time_factor", summary.real_time_factor}};
}

Json score(const Arguments& a) {
  const auto evaluations = evaluate_run(RunFolder{a.folder}, 1, Console(true));
  return {{"evaluations", evaluations.size()}};
}

int run(int argc, char** argv) {
  const auto began = Clock::now();
  CLI::App app("Simulates or scores for one cell of a sweep. `tarmac sweep` calls it.", "tarmac-cell");
  app.require_subcommand(1);
  Arguments a;
  int progress_fd = STDERR_FILENO;
  CLI::App* simulating = app.add_subcommand("simulate", "a resolved scenario -> recording and truth");
  simulating->add_option("scenario", a.scenario)->required();
  simulating->add_option("folder", a.folder)->required();
  simulating->add_flag("--fast", a.fast);
  simulating->add_option("--progress-fd", progress_fd);
  CLI::App* scoring = app.add_subcommand("score", "a run's folder -> evaluation.json");
  scoring->add_option("folder", a.folder)->required();
  for (CLI::App* command : {simulating, scoring}) command->add_option("--result", a.result)->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  install_interrupt_handler();
  try {
    Json result = *simulating ? simulate_world(a, progress_fd) : score(a);
    result["work_s"] = std::chrono::duration<double>(Clock::now() - began).count();
    core::write_file(a.result, result.dump() + "\n");
    return 0;
  } catch (const core::InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return 4;
  }
}

}  // namespace
}  // namespace tarmac::tools

int main(int argc, char** argv) {
  tarmac::io::world::install_mesh_readers();
  return tarmac::tools::run(argc, argv);
}
