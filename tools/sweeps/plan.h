/// A sweep made ready: every scenario read, every option checked, every cell given its key, before anything runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cell.h"
#include "scenarios/sweep_file.h"
#include "tools/tarmac/estimator_run.h"

namespace tarmac::tools {

/// A drive: scenario, what is set in it, and seed. Its cells share one recording.
struct PlannedWorld {
  std::string key;
  std::string resolved;  ///< the scenario with every value written out, without estimators
  scenarios::Scenario scenario;
  std::uint64_t seed = 0;
  double rays = 0;
  std::vector<std::size_t> cells;
};

struct PlannedCell {
  scenarios::Cell cell;
  std::size_t world = 0;
  EstimatorRequest request;
  std::string options;  ///< resolved, as YAML
  std::string command;  ///< runs this cell alone
};

struct SweepPlan {
  scenarios::SweepFile file;
  std::vector<PlannedWorld> worlds;
  std::vector<PlannedCell> cells;
  std::string hash;   ///< over the keys of all cells, whatever the shard
  std::string build;  ///< of the programs that run it
};

struct PlanSettings {
  std::vector<std::string> sets;            ///< --set, over the file's
  std::string config;                       ///< --config: a file with an `estimators:` block
  std::filesystem::path estimator_program;  ///< another build's tarmac-estimate
  bool fast = false;                        ///< the tracer's instruction set is not pinned
  std::size_t shard = 0, shards = 1;        ///< worlds are dealt out: this one has those with index % shards == shard
};

/// Throws InputError that names the sweep file's place and the case.
SweepPlan make_plan(const std::filesystem::path& sweep_file, const PlanSettings& settings);

/// Version, commit and compiler; where the commit does not say it all (a modified tree, no git), and for a program from
/// elsewhere, also a hash of the programs; "fast" where the tracer's instruction set is not pinned.
std::string build_identity(const std::filesystem::path& estimator_program, bool fast);

}  // namespace tarmac::tools
