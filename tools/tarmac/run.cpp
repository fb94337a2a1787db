// `tarmac run` and `tarmac simulate`: from a scenario file to a recording, estimates, scores and a page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "core/error.h"
#include "core/files.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/evaluation_run.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/provenance.h"
#include "tools/tarmac/results_table.h"
#include "tools/tarmac/world.h"
#include "tools/tarmac/write_page.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// Everything that the command line asks for, checked before anything is written.
struct Plan {
  scenarios::Scenario scenario;
  std::vector<EstimatorRequest> estimators;
  std::vector<std::uint64_t> seeds;
  bool seed_folders = false;  ///< a range was asked for: results in DIR/seed-N
  fs::path out;

  RunFolder folder(std::uint64_t seed) const {
    return RunFolder{seed_folders ? out / fmt::format("seed-{}", seed) : out};
  }
};

/// Results of one seed and of several lie in one folder differently; mixing them, or seeds of different runs, would
/// pool what does not belong together.
void refuse_mixed_layouts(const Plan& plan) {
  if (!fs::is_directory(plan.out)) return;
  const auto refuse = [&](const std::string& what) {
    throw core::InputError(
        fmt::format("{}: holds {}; give another folder with -o, or remove that first", plan.out.string(), what));
  };
  if (plan.seed_folders && fs::exists(RunFolder{plan.out}.provenance())) refuse("a run of one seed");
  for (const auto& entry : fs::directory_iterator(plan.out)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || !name.starts_with("seed-") || !fs::exists(RunFolder{entry.path()}.provenance()))
      continue;
    const bool ours = plan.seed_folders && std::any_of(plan.seeds.begin(), plan.seeds.end(), [&](std::uint64_t seed) {
                        return name == fmt::format("seed-{}", seed);
                      });
    if (!ours) refuse(fmt::format("{} of an earlier run", name));
  }
}

Plan make_plan(const ScenarioArguments& arguments, bool with_estimators) {
  Plan plan;
  std::vector<scenarios::Override> overrides;
  for (const std::string& set : arguments.sets) overrides.push_back(scenarios::parse_override(set));
  if (arguments.point_truth) overrides.emplace_back("truth.per_point", "true");
  const fs::path file = scenarios::find_scenario(arguments.scenario, scenario_folders());
  plan.scenario = scenarios::load_scenario(file, overrides);
  check_world(plan.scenario);
  if (with_estimators) {
    plan.estimators =
        request_estimators(arguments.estimators, estimator_blocks(plan.scenario, arguments.config, overrides));
  }
  plan.seeds = {static_cast<std::uint64_t>(plan.scenario.seed)};
  if (!arguments.seeds.empty()) plan.seeds = scenarios::parse_seeds(arguments.seeds);
  plan.seed_folders = arguments.seeds.find("..") != std::string::npos;
  plan.out = arguments.out.empty() ? fs::path("out") / plan.scenario.name : fs::path(arguments.out);
  refuse_mixed_layouts(plan);
  return plan;
}

/// What all seeds of the plan about take on the disk. Full diagnostics hold some bytes a ray for each estimator.
double bytes_of(const Plan& plan, const std::string& diagnostics) {
  constexpr double diagnostics_bytes_per_ray = 5, files_bytes = 5e5;
  const sim::Workload work =
      sim::workload_of(plan.scenario.rig, plan.scenario.duration(), plan.scenario.truth.per_point);
  double bytes = work.bytes + files_bytes;
  const double a_ray = diagnostics == "full" ? diagnostics_bytes_per_ray : 0;
  bytes += static_cast<double>(plan.estimators.size()) * (files_bytes + a_ray * static_cast<double>(work.rays));
  return bytes * static_cast<double>(plan.seeds.size());
}

/// Says what a plan takes on the disk, before anything is written; throws InputError where there is less room.
void check_room(const Plan& plan, const ScenarioArguments& arguments, const Console& console) {
  fs::path at = fs::absolute(plan.out);
  while (!fs::exists(at) && at.has_relative_path()) at = at.parent_path();
  const double needed_mb = 1e-6 * bytes_of(plan, arguments.diagnostics);
  const double free_mb = 1e-6 * static_cast<double>(fs::space(at).available);
  console.say(fmt::format("disk: about {:.0f} MB, of {:.0f} MB that are free", std::ceil(needed_mb), free_mb));
  if (needed_mb <= free_mb) return;
  const std::string words =
      fmt::format("{}: about {:.0f} MB are needed, and the disk has {:.0f} MB free", at.string(), needed_mb, free_mb);
  if (!arguments.force)
    throw core::InputError(words +
                           "; make room, ask for a shorter drive or a smaller sensor, give another folder with "
                           "-o, or --force");
  console.warn(words + "; going on, as --force was given");
}

/// Simulates one seed into its folder. Until provenance.json stands there again, the folder is no finished run.
Provenance simulate_seed(const Plan& plan, std::uint64_t seed, const ScenarioArguments& arguments,
                         const CommonArguments& common, const Console& console) {
  const RunFolder run = plan.folder(seed);
  const std::string resolved = resolve_scenario(plan.scenario, seed, plan.estimators);
  const sim::SimulationInput input = build_world(plan.scenario, seed, resolved);
  sim::check(input);
  // Nothing that could be refused is left: now what stands there from before goes, its marks of being whole first.
  fs::create_directories(run.root);
  fs::remove(run.provenance());
  fs::remove(run.recording() / "manifest.json");
  fs::remove(run.report());
  fs::remove(plan.out / "report.html");
  for (const fs::path& folder : estimator_folders(run)) fs::remove_all(folder);
  core::write_file(run.scenario(), resolved);
  const sim::SimulationSummary summary =
      sim::simulate(input, {.threads = common.threads(), .fast = arguments.fast}, run.recording(), run.truth(),
                    console.progress(plan.seed_folders ? fmt::format("simulate {}", seed) : "simulate"));
  Provenance provenance;
  provenance.scenario = plan.scenario.name;
  provenance.seed = seed;
  provenance.scenario_hash = core::hash_hex(resolved);
  provenance.recording_hash = summary.recording_hash;
  provenance.recording = "recording";
  provenance.truth = "truth";
  provenance.command = shell_command(common.words);
  provenance.isa = summary.isa;
  provenance.threads = summary.threads;
  provenance.simulate_wall_s = summary.wall_s;
  provenance.simulate_real_time_factor = summary.real_time_factor;
  provenance.simulate_mrays_per_s = summary.wall_s > 0 ? 1e-6 * static_cast<double>(summary.rays) / summary.wall_s : 0;
  for (const EstimatorRequest& request : plan.estimators) {
    provenance.options += fmt::format("{}:\n{}", request.name, resolved_options(request));
  }
  console.say(fmt::format("recording {}: {} sweeps, {:.1f} M points, {} IMU samples, {:.1f} Mrays/s, {:.1f}x real time",
                          summary.recording_hash, summary.sweeps, 1e-6 * static_cast<double>(summary.points),
                          summary.imu_samples, provenance.simulate_mrays_per_s, summary.real_time_factor));
  return provenance;
}

}  // namespace

int CommonArguments::threads() const {
  return jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int run_command(const ScenarioArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const Plan plan = make_plan(arguments, true);
  check_room(plan, arguments, console);
  bool failed = false;
  std::vector<RunFolder> runs;
  std::vector<metrics::Evaluation> evaluations;
  for (const std::uint64_t seed : plan.seeds) {
    const RunFolder run = plan.folder(seed);
    const Provenance provenance = simulate_seed(plan, seed, arguments, common, console);
    const EstimatorRunSettings settings{common.threads(), arguments.diagnostics, {}, {}, arguments.estimator_program};
    const auto outcomes = run_estimators(plan.estimators, run.recording(), run.root, settings, console);
    for (const Outcome& outcome : outcomes) failed = failed || outcome.failed();
    save_provenance(run.provenance(), provenance);
    for (metrics::Evaluation& evaluation : evaluate_run(run, common.threads(), console)) {
      evaluations.push_back(std::move(evaluation));
    }
    runs.push_back(run);
  }
  const fs::path page = plan.out / "report.html";
  write_page(runs, page, console);
  link_latest(plan.out);
  print_results(evaluations, common.json);
  console.say(fmt::format("report: {}", page.string()));
  return failed ? 3 : 0;
}

int simulate_command(const ScenarioArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const Plan plan = make_plan(arguments, false);
  check_room(plan, arguments, console);
  for (const std::uint64_t seed : plan.seeds) {
    const Provenance provenance = simulate_seed(plan, seed, arguments, common, console);
    save_provenance(plan.folder(seed).provenance(), provenance);
    if (common.json) {
      fmt::print("{}", core::read_file(plan.folder(seed).provenance()));
    } else {
      fmt::print("{} {}\n", provenance.recording_hash, plan.folder(seed).recording().string());
    }
  }
  link_latest(plan.out);
  return 0;
}

}  // namespace tarmac::tools
