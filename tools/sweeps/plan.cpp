#include "tools/sweeps/plan.h"

#include <fmt/format.h>

#include <map>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/store.h"
#include "sim/simulate.h"
#include "tools/tarmac/build_info.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/provenance.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// A scenario with what is set in it: the same for all seeds and, but for their options, all estimators.
struct LoadedScenario {
  fs::path file;
  scenarios::Scenario scenario;
  std::vector<core::ConfigNode> blocks;
  double rays = 0;
};

class Planner {
 public:
  Planner(const scenarios::SweepFile& file, const PlanSettings& settings) : file_(file), settings_(settings) {}

  void add(const scenarios::SweepCell& cell, SweepPlan& plan) {
    try {
      add_checked(cell, plan);
    } catch (const core::InputError& error) {
      throw core::InputError(fmt::format("{}: {}: {}", cell.place, cell.case_name, error.what()));
    }
  }

 private:
  void add_checked(const scenarios::SweepCell& cell, SweepPlan& plan) {
    const LoadedScenario& loaded = load(cell);
    PlannedCell planned;
    planned.request = request_estimators(cell.estimator, loaded.blocks).at(0);
    planned.options = resolved_options(planned.request);
    planned.world = world_of(cell, loaded, plan);
    const std::string& world = plan.worlds[planned.world].key;
    planned.cell = {"",        world,          cell.block,     loaded.scenario.name, cell.case_name,
                    cell.seed, cell.estimator, cell.parameters};
    planned.cell.key = core::hash_hex(fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n", cell.block, cell.case_name, cell.seed,
                                                  world, cell.estimator, planned.options, file_.diagnostics));
    planned.command = command_of(cell, loaded);
    plan.worlds[planned.world].cells.push_back(plan.cells.size());
    plan.cells.push_back(std::move(planned));
  }

  const LoadedScenario& load(const scenarios::SweepCell& cell) {
    std::string name = cell.scenario;
    for (const auto& [key, value] : cell.sets) name += "\n" + key + "=" + value;
    if (const auto found = loaded_.find(name); found != loaded_.end()) return found->second;
    LoadedScenario loaded;
    loaded.file = scenarios::find_scenario(cell.scenario, scenario_folders());
    loaded.scenario = scenarios::load_scenario(loaded.file, cell.sets);
    check_world(loaded.scenario);
    loaded.blocks = estimator_blocks(loaded.scenario, settings_.config, cell.sets);
    loaded.rays = static_cast<double>(sim::workload_of(loaded.scenario.rig, loaded.scenario.duration()).rays);
    return loaded_.emplace(name, std::move(loaded)).first->second;
  }

  std::size_t world_of(const scenarios::SweepCell& cell, const LoadedScenario& loaded, SweepPlan& plan) {
    PlannedWorld world;
    world.resolved = resolve_scenario(loaded.scenario, cell.seed, {});
    world.key = core::hash_hex(world.resolved);
    const auto [found, is_new] = worlds_.emplace(world.key, plan.worlds.size());
    if (is_new) {
      world.scenario = loaded.scenario;
      world.seed = cell.seed;
      world.rays = loaded.rays;
      plan.worlds.push_back(std::move(world));
    }
    return found->second;
  }

  std::string command_of(const scenarios::SweepCell& cell, const LoadedScenario& loaded) const {
    std::vector<std::string> words = {"tarmac", "run", loaded.file.string(), "--seed", std::to_string(cell.seed)};
    for (const auto& [key, value] : cell.sets) {
      words.push_back("--set");
      words.push_back(key + "=" + value);
    }
    if (!settings_.config.empty()) words.insert(words.end(), {"--config", settings_.config});
    words.insert(words.end(),
                 {"-e", cell.estimator, "--diagnostics", file_.diagnostics, "--jobs", "1", "-o", "one-cell"});
    return shell_command(words);
  }

  const scenarios::SweepFile& file_;
  const PlanSettings& settings_;
  std::map<std::string, LoadedScenario> loaded_;
  std::map<std::string, std::size_t> worlds_;
};

/// Keeps the worlds of one shard, and their cells.
void keep_shard(SweepPlan& plan, std::size_t shard, std::size_t shards) {
  if (shards == 1) return;
  SweepPlan kept;
  for (std::size_t w = shard; w < plan.worlds.size(); w += shards) {
    PlannedWorld world = std::move(plan.worlds[w]);
    for (std::size_t& c : world.cells) {
      plan.cells[c].world = kept.worlds.size();
      kept.cells.push_back(std::move(plan.cells[c]));
      c = kept.cells.size() - 1;
    }
    kept.worlds.push_back(std::move(world));
  }
  plan.worlds = std::move(kept.worlds);
  plan.cells = std::move(kept.cells);
}

}  // namespace

SweepPlan make_plan(const fs::path& sweep_file, const PlanSettings& settings) {
  SweepPlan plan;
  std::vector<scenarios::Override> sets;
  for (const std::string& set : settings.sets) sets.push_back(scenarios::parse_override(set));
  plan.file = scenarios::load_sweep(sweep_file, sets);
  plan.build = build_identity(settings.estimator_program);
  Planner planner(plan.file, settings);
  for (const scenarios::SweepCell& cell : plan.file.cells) planner.add(cell, plan);
  std::vector<std::string> keys;
  for (const PlannedCell& cell : plan.cells) keys.push_back(cell.cell.key);
  plan.hash = scenarios::plan_hash_of(std::move(keys));
  keep_shard(plan, settings.shard, settings.shards);
  return plan;
}

std::string build_identity(const fs::path& estimator_program) {
  const BuildInfo build = build_info();
  std::string identity = fmt::format("{} {} ({}, {})", build.version, build.commit, build.compiler, build.build_type);
  const bool told_by_commit = build.commit != "unknown" && !build.commit.ends_with("-modified");
  if (!told_by_commit) {
    std::string hashes;
    for (const char* program : {"tarmac-cell", "tarmac-estimate"}) {
      hashes += core::hash_hex(core::read_file(program_folder() / program));
    }
    identity += " programs " + core::hash_hex(hashes);
  }
  if (!estimator_program.empty()) identity += " estimators " + core::hash_hex(core::read_file(estimator_program));
  return identity;
}

}  // namespace tarmac::tools
