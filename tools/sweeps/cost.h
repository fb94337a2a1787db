/// What cells will cost, before they run: for the plan that --dry-run prints, for the order, and for the bar.
#pragma once

#include "tools/sweeps/plan.h"

namespace tarmac::tools {

/// One core's seconds, and megabytes on the disk.
struct CellCost {
  double simulate_s = 0;  ///< of its drive; shared by the drive's cells
  double run_s = 0;       ///< estimating and scoring
  double recording_mb = 0;
  double files_mb = 0;
};

/// Rates per ray as the regression sweep took on one core of a two-core machine with other work on it: a figure to plan
/// with, right to a factor of two.
CellCost estimate_cost(const SweepPlan& plan, const PlannedCell& cell);
double cost_of_world(const SweepPlan& plan, const PlannedWorld& world);  ///< seconds, with all its cells

}  // namespace tarmac::tools
