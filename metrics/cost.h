/// What a run took: time, memory, iterations.
#pragma once

#include <vector>

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "metrics/evaluation.h"
#include "metrics/row_set.h"

namespace tarmac::metrics {

/// sweep_time_*, sweep_cpu_*, real_time_factor (from the first sweep's begin to the last one's end, over the run's wall
/// time), peak_memory_mb. `timing` may be nullptr: n/a.
void add_cost_rows(const core::RunTiming* timing, const core::Estimate& estimate, RowSet& rows);

/// iterations_mean, over sweeps that took at least one. `diagnostics` may be nullptr: n/a.
void add_effort_rows(const std::vector<core::SweepDiagnostics>* diagnostics, RowSet& rows);

/// sweep_time_vs_time and iterations_vs_time, over the time of the sweep's end.
void add_cost_series(const core::RunTiming* timing, const std::vector<core::SweepDiagnostics>* diagnostics,
                     const core::Estimate& estimate, core::Time t_zero, std::vector<Series>& series);

}  // namespace tarmac::metrics
