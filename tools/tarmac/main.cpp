// The `tarmac` program: its command line. What the commands do is in the files named after them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <functional>

#include "core/config.h"
#include "core/error.h"
#include "io/world/mesh_readers.h"
#include "tools/tarmac/build_info.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/interrupt.h"

namespace tarmac::tools {
namespace {

constexpr int kBadUsage = 2, kInternalError = 4;

struct Arguments {
  CommonArguments common;
  ScenarioArguments scenario;
  EstimateArguments estimate;
  EvaluateArguments evaluate;
  ReportArguments report;
  DescribeArguments describe;
  TransferArguments transfer;
  BenchArguments bench;
  TableArguments table;
  QueryArguments query;
  MergeArguments merge;
  SweepArguments sweep;
  GateArguments gate;
  BaselineArguments baseline;
  CompareArguments compare;
  std::string list_kind;
  std::function<int()> chosen;
};

CLI::App* add(CLI::App& app, Arguments& a, const char* name, const char* what, std::function<int()> action) {
  CLI::App* command = app.add_subcommand(name, what);
  command->add_flag("-q,--quiet", a.common.quiet, "say nothing but results and errors");
  command->add_flag("--json", a.common.json, "print results as JSON rows");
  command->callback([&a, action = std::move(action)] { a.chosen = action; });
  return command;
}

void add_jobs(CLI::App* command, Arguments& a) {
  command
      ->add_option("--jobs", a.common.jobs,
                   "threads inside the simulator and inside each estimator (default: all cores)")
      ->check(CLI::Range(1, 1024));
}

void add_scenario_options(CLI::App* command, Arguments& a, bool needs_out) {
  command->add_option("scenario", a.scenario.scenario, "scenario file, or its name")->required();
  auto* out = command->add_option("-o,--out", a.scenario.out, "folder for the results");
  if (needs_out) out->required();
  command->add_option("--seed", a.scenario.seeds, "one seed, or a range such as 1..5 (results in DIR/seed-N)");
  command->add_option("--set", a.scenario.sets, "override a field: motion.cruise_m_s=5 (repeatable)")
      ->allow_extra_args(false);
  command->add_flag("--fast", a.scenario.fast, "lift the pinned instruction set of the ray tracer");
  command->add_flag("--force", a.scenario.force, "go on where the disk seems to have too little room");
  add_jobs(command, a);
}

void add_estimator_options(CLI::App* command, std::string& estimators, std::string& config, std::string& diagnostics) {
  command->add_option("-e,--estimators", estimators, "names separated by commas, or all (the default)");
  command->add_option("--config", config, "YAML file with an `estimators:` block");
  command->add_option("--diagnostics", diagnostics, "what is recorded per sweep: none, system or full (default)")
      ->check(CLI::IsMember({"none", "system", "full"}));
}

void add_store_commands(CLI::App& app, Arguments& a) {
  CLI::App* table = add(app, a, "table", "the cells of a sweep as a table: how they ended and what was measured",
                        [&a] { return table_command(a.table, a.common); });
  table->add_option("folder", a.table.folder, "folder of a sweep")->required();
  const auto list = [&](const char* name, std::vector<std::string>& values, const char* what) {
    return table->add_option(name, values, what)->delimiter(',')->allow_extra_args(false);
  };
  list("--by", a.table.by, "columns that make a line: case, estimator, scenario, block, seed, world, status");
  list("--metrics", a.table.metrics, "which metrics, separated by commas");
  list("--scenario", a.table.scenarios, "only these");
  // Names of cases may hold commas.
  table->add_option("--case", a.table.cases, "only this (repeatable)")->allow_extra_args(false);
  list("-e,--estimator", a.table.estimators, "only these");
  list("--status", a.table.statuses, "only cells that ended so, or are pending or running");
  table->add_option("--seed", a.table.seeds, "only this seed, or a range such as 1..3");
  table->add_option("--where", a.table.where, "only cells with that parameter: motion.peak=3 (repeatable)")
      ->allow_extra_args(false);
  table->add_option("--sort", a.table.sort, "column that lines are sorted by, lowest first");
  table->add_flag("--reverse", a.table.reverse, "the other way round");
  table->add_flag("--cells", a.table.cells, "one line a cell");
  table->add_flag("--dump", a.table.dump, "all that is the same whenever and wherever the sweep runs, sorted");
  table->add_option("--csv", a.table.csv, "write the table there as CSV (- for standard output)");

  CLI::App* query = add(app, a, "query", "ask the store of a sweep in SQL (reading only)",
                        [&a] { return query_command(a.query, a.common); });
  query->add_option("folder", a.query.folder, "folder of a sweep")->required();
  query->add_option("select", a.query.sql, "such as: select * from results where metric = 'ate_se3_rmse_m'")
      ->required();
  query->add_option("--csv", a.query.csv, "write the rows there as CSV (- for standard output)");

  CLI::App* merge =
      add(app, a, "merge", "the stores of a sweep's shards as one", [&a] { return merge_command(a.merge, a.common); });
  merge->add_option("folders", a.merge.folders, "folders of the shards")->required();
  merge->add_option("-o,--out", a.merge.out, "folder for the whole sweep")->required();
}

void add_sweep_command(CLI::App& app, Arguments& a) {
  CLI::App* sweep = add(app, a, "sweep", "run the cells of a sweep file into a store",
                        [&a] { return sweep_command(a.sweep, a.common); });
  sweep->add_option("sweep", a.sweep.sweep, "sweep file, or its name")->required();
  sweep->add_option("-o,--out", a.sweep.out, "folder of the store");
  sweep->add_option("--jobs", a.common.jobs, "cells at once, one thread each (default: all cores)")
      ->check(CLI::Range(1, 1024));
  sweep->add_flag("--resume", a.sweep.resume, "go on with a store that is there: run what is not finished");
  sweep->add_flag("--rerun-failed", a.sweep.rerun_failed, "the same, and what failed once more");
  sweep->add_flag("--dry-run", a.sweep.dry_run, "list the cells with estimates of time and disk; run nothing");
  sweep->add_option("--shard", a.sweep.shard, "I/N: the I-th of N parts; `tarmac merge` makes one store of them");
  sweep->add_option("--set", a.sweep.sets, "set a field in all blocks: duration_s=5 (repeatable)")
      ->allow_extra_args(false);
  sweep->add_option("--config", a.sweep.config, "YAML file with an `estimators:` block");
  sweep->add_option("--cache", a.sweep.cache, "folder of recordings, which several sweeps may share (default: in DIR)");
  sweep
      ->add_option("--cache-limit-gb", a.sweep.cache_limit_gb,
                   "room that recordings may take; 0 = no limit (default 20)")
      ->check(CLI::NonNegativeNumber);
  sweep
      ->add_option("--estimator-program", a.sweep.estimator_program,
                   "another build's tarmac-estimate: its estimators, this build's simulator and metrics")
      ->check(CLI::ExistingFile);
  sweep->add_flag("--fast", a.sweep.fast, "lift the pinned instruction set of the ray tracer");
}

void add_gate_commands(CLI::App& app, Arguments& a) {
  CLI::App* gate = add(app, a, "gate", "hold a sweep's results to a gate file; exit code 1 when a row fails",
                       [&a] { return gate_command(a.gate, a.common); });
  gate->add_option("folder", a.gate.folder, "folder of a sweep")->required();
  gate->add_option("--gate", a.gate.gate, "gate file, or its name")->required();
  gate->add_option("--junit", a.gate.junit, "write JUnit XML");
  gate->add_option("--markdown", a.gate.markdown, "write Markdown for a pull request");
  gate->add_option("--link", a.gate.link, "address of the whole report, for the Markdown");

  CLI::App* baseline = app.add_subcommand("baseline", "what gates hold results to");
  baseline->require_subcommand(1);
  CLI::App* update = add(*baseline, a, "update", "write a baseline from sweeps' results, and say what changes",
                         [&a] { return baseline_update_command(a.baseline, a.common); });
  update->add_option("folders", a.baseline.folders, "folders of sweeps")->required();
  update->add_option("-o,--out", a.baseline.out, "baseline file")->required();
  update->add_option("--gate", a.baseline.gate, "gate file, or its name: the metrics to keep (default: the main ones)");
  update->add_flag("--allow-incomplete", a.baseline.allow_incomplete,
                   "also of a shard; leave out cells that failed or are not finished");
}

void add_compare_command(CLI::App& app, Arguments& a) {
  CLI::App* compare = add(app, a, "compare", "two builds, or two estimators, in pairs over the same seeds",
                          [&a] { return compare_command(a.compare, a.common); });
  compare->add_option("folders", a.compare.folders, "A and B: a sweep's folder or a run's; one alone with --a and --b")
      ->required()
      ->expected(1, 2);
  compare->add_option("-o,--out", a.compare.out, "the page to write");
  compare->add_option("--markdown", a.compare.markdown, "Markdown to write, for a pull request");
  compare->add_option("--a", a.compare.a, "estimator of A (default: each one against its namesake)");
  compare->add_option("--b", a.compare.b, "estimator of B");
  compare->add_option("--metrics", a.compare.metrics, "these alone, separated by commas (default: all)")
      ->delimiter(',');
  compare->add_option("--case", a.compare.case_name, "this case alone");
}

void add_commands(CLI::App& app, Arguments& a) {
  add_gate_commands(app, a);

  CLI::App* run = add(app, a, "run", "simulate a scenario, run estimators, evaluate them and write the report",
                      [&a] { return run_command(a.scenario, a.common); });
  add_scenario_options(run, a, false);
  add_estimator_options(run, a.scenario.estimators, a.scenario.config, a.scenario.diagnostics);

  run->add_option("--estimator-program", a.scenario.estimator_program, "another build's tarmac-estimate")
      ->check(CLI::ExistingFile);

  CLI::App* simulate = add(app, a, "simulate", "make a recording, with the truth beside it",
                           [&a] { return simulate_command(a.scenario, a.common); });
  add_scenario_options(simulate, a, true);
  simulate->add_flag("--point-truth", a.scenario.point_truth,
                     "store every point's true range, normal and incidence too (as truth.per_point=true)");

  CLI::App* estimate = add(app, a, "estimate", "run estimators on a recording (or a plain folder)",
                           [&a] { return estimate_command(a.estimate, a.common); });
  estimate->add_option("recording", a.estimate.recording, "folder of a run, a recording, or the plain format")
      ->required();
  estimate->add_option("-o,--out", a.estimate.out, "folder for the results")->required();
  estimate->add_option("--set", a.estimate.sets, "override an option: kiss-icp.voxel_size_m=0.5 (repeatable)")
      ->allow_extra_args(false);
  add_estimator_options(estimate, a.estimate.estimators, a.estimate.config, a.estimate.diagnostics);
  add_jobs(estimate, a);

  CLI::App* evaluate = add(app, a, "evaluate", "score estimates against the truth",
                           [&a] { return evaluate_command(a.evaluate, a.common); });
  evaluate->add_option("folders", a.evaluate.folders, "folders of runs");
  evaluate->add_option("--truth", a.evaluate.truth, "true trajectory (TUM, KITTI or EuRoC)");
  evaluate->add_option("--estimate", a.evaluate.estimate, "estimated trajectory (TUM, KITTI or EuRoC)");
  evaluate
      ->add_option("--align", a.evaluate.align,
                   "alignment of the headline: none, first-pose, yaw-pos, se3 (default) or sim3")
      ->check(CLI::IsMember({"none", "first-pose", "yaw-pos", "se3", "sim3"}));
  add_jobs(evaluate, a);

  CLI::App* report = add(app, a, "report", "write the HTML page of one or several runs",
                         [&a] { return report_command(a.report, a.common); });
  report->add_option("folders", a.report.folders, "folders of runs")->required();
  report->add_option("-o,--out", a.report.out, "the page to write")->required();

  add_compare_command(app, a);

  CLI::App* list = add(app, a, "list", "what there is", [&a] { return list_command(a.list_kind, a.common); });
  list->add_option("kind", a.list_kind,
                   "scenarios, sweeps, gates, scenes, aircraft, equipment, motions, sensors, imus, faults, estimators "
                   "or metrics (default: all)");

  CLI::App* describe = add(app, a, "describe", "one thing in full: options, defaults, ranges, sources",
                           [&a] { return describe_command(a.describe, a.common); });
  describe
      ->add_option("kind", a.describe.kind,
                   "scenario, sweep, gate, scene, aircraft, equipment, motion, sensor, imu, fault, estimator or metric")
      ->required();
  describe->add_option("name", a.describe.name, "its name, or all")->required();
  describe->add_option("-o,--out", a.describe.picture,
                       "write a picture (scene, scenario, aircraft, equipment; of all: a contact sheet), .png or .jpg");
  describe->add_option(
      "--eye", a.describe.eye,
      "x,y,z: see the picture from there, in metres of the scene's world (aircraft, equipment: front to "
      "-x, floor at z = 0); needs --look-at");
  describe->add_option("--look-at", a.describe.look_at, "x,y,z: the middle of what --eye sees");

  CLI::App* bench = add(app, a, "bench", "what simulating, estimating and scoring cost on this machine",
                        [&a] { return bench_command(a.bench, a.common); });
  bench->add_option("benches", a.bench.benches, "sim, estimators, metrics, store, trajectories, window (default: all)");

  add_store_commands(app, a);

  add_sweep_command(app, a);

  for (const bool importing : {true, false}) {
    CLI::App* transfer = importing ? add(app, a, "import", "make a recording (or a TUM file) from another format",
                                         [&a] { return import_command(a.transfer, a.common); })
                                   : add(app, a, "export", "write a recording or a trajectory in another format",
                                         [&a] { return export_command(a.transfer, a.common); });
    std::vector<std::string> formats = {"plain", "kitti", "tum"};
    if (!importing) formats.push_back("exr");
    transfer->add_option("--format", a.transfer.format, importing ? "plain, kitti or tum" : "plain, kitti, tum or exr")
        ->required()
        ->check(CLI::IsMember(formats));
    transfer->add_option("from", a.transfer.from, importing ? "what to read" : "folder of a run or a recording")
        ->required();
    transfer->add_option("-o,--out", a.transfer.to, "what to write")->required();
    if (importing) continue;
    transfer->add_option("-e,--estimator", a.transfer.estimator, "whose trajectory (default: the truth's)");
    transfer->add_option("--sweep", a.transfer.sweep, "exr: index of the one sweep to write (default: all)")
        ->check(CLI::NonNegativeNumber);
    transfer->add_option("--lidar", a.transfer.lidar, "exr: number of the LiDAR")->check(CLI::NonNegativeNumber);
    transfer->add_flag("--no-truth", a.transfer.no_truth, "exr: leave out normal, incidence, label and the like");
  }
}

bool is_command(const CLI::App& app, const std::string& word) {
  const auto named = app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; });
  return !named.empty();
}

std::string no_such_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const std::string guess = core::did_you_mean(word, names);
  return fmt::format("there is no command '{}'{}; there are {}", word,
                     guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess), fmt::join(names, ", "));
}

int run_main(int argc, char** argv) {
  Arguments a;
  a.common.words.assign(argv, argv + argc);
  CLI::App app("Tarmac: a testbench for continuous-time LiDAR registration");
  app.require_subcommand(1);
  const BuildInfo build = build_info();
  app.set_version_flag("--version", fmt::format("tarmac {} ({}, {}, {})", build.version, build.commit, build.compiler,
                                                build.build_type));
  add_commands(app, a);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    if (argc < 2 || argv[1][0] == '-' || is_command(app, argv[1])) {
      app.exit(error);
      return kBadUsage;
    }
    fmt::print(stderr, "error: {}\n", no_such_command(app, argv[1]));
    return kBadUsage;
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : kBadUsage;
  }
  install_interrupt_handler();
  try {
    return a.chosen();
  } catch (const Interrupted&) {
    fmt::print(stderr, "\ninterrupted: what was finished is kept, the rest is left unfinished and will be refused\n");
    return kInterruptedExit;
  } catch (const core::InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kBadUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return kInternalError;
  }
}

}  // namespace
}  // namespace tarmac::tools

int main(int argc, char** argv) {
  tarmac::io::world::install_mesh_readers();
  return tarmac::tools::run_main(argc, argv);
}
