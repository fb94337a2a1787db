/// Runs a plan's pending cells, several at once, into a store.
#pragma once

#include <filesystem>

#include "scenarios/store.h"
#include "tools/sweeps/plan.h"
#include "tools/tarmac/console.h"

namespace tarmac::tools {

struct ExecuteSettings {
  int jobs = 1;                 ///< cells at once, one thread each
  std::filesystem::path cache;  ///< recordings
  double cache_limit_gb = 20;   ///< 0 = no limit
  std::filesystem::path estimator_program;
  bool fast = false;
};

struct ExecuteSummary {
  std::size_t ok = 0, failed = 0,
              killed = 0;  ///< cells of this run; failed: outcomes other than ok and not_initialised
  std::size_t recordings_made = 0, recordings_found = 0;
  double wall_s = 0;
  double overhead_mean_s = 0, overhead_max_s = 0;  ///< a cell, outside of estimating and scoring
  double overhead_recording_mean_s = 0;            ///< a recording, outside of simulating
};

/// The store is started already. A failed cell does not stop the others. Throws NoRoom (the disk is full) and
/// Interrupted, both with the running cells given back and the finished ones kept.
ExecuteSummary execute(const SweepPlan& plan, scenarios::Store& store, const ExecuteSettings& settings,
                       const Console& console);

}  // namespace tarmac::tools
