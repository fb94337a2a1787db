/// What a run took: time, memory, iterations.
#pragma once

#include <vector>

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "metrics/evaluation.h"
#include "metrics/row_set.h"
#include "metrics/sweep_source.h"

namespace tarmac::metrics {

/// sweep_time_*, sweep_cpu_*, real_time_factor (from the first sweep's begin to the last one's end, over the run's wall
/// time), peak_memory_mb. `timing` may be nullptr: n/a.
void add_cost_rows(const core::RunTiming* timing, const core::Estimate& estimate, RowSet& rows);

/// How many iterations a sweep took.
struct SweepEffort {
  std::int64_t index = 0;
  int iterations = 0;
};
std::vector<SweepEffort> effort_of(const DiagnosticsSource& diagnostics);

/// iterations_mean, over sweeps that took at least one. `effort` may be nullptr: n/a.
void add_effort_rows(const std::vector<SweepEffort>* effort, RowSet& rows);

/// sweep_time_vs_time and iterations_vs_time, over the time of the sweep's end.
void add_cost_series(const core::RunTiming* timing, const std::vector<SweepEffort>* effort,
                     const core::Estimate& estimate, core::Time t_zero, std::vector<Series>& series);

}  // namespace tarmac::metrics
