/// Holds a sweep's results to a gate file. Definitions: docs/gates.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/gate_reports.h"
#include "scenarios/baseline.h"
#include "scenarios/cell.h"
#include "scenarios/gate_file.h"

namespace tarmac::tools {

struct GateInput {
  const scenarios::GateFile* gate = nullptr;
  std::vector<scenarios::CellResult> results;     ///< finished cells
  std::vector<scenarios::Cell> unfinished;        ///< pending, running or lost ones: they fail the rows that need them
  const scenarios::Baseline* baseline = nullptr;  ///< nullptr: the gate file names none
  std::string build;                              ///< that the results come from
  std::filesystem::path folder;                   ///< of the store: where logs lie
  std::string today;                              ///< "2026-12-31"
  bool whole = true;                              ///< false: a shard's results, of which no row can be judged
};

/// Rows in the gate file's order; what a row's patterns select in order of case, estimator, metric. A row (or an entry
/// of its lists) that selects nothing is a failed row; of a shard there is one row, and it failed. Throws InputError
/// when a row names a metric that there is not.
reports::GateReport judge_gate(const GateInput& input);

/// Throws InputError with the row's place and did-you-mean when a row names a metric that there is not.
void check_metrics(const scenarios::GateFile& gate);

/// Metrics that a gate names, sorted; those of rows held to the baseline only.
std::vector<std::string> metrics_held_to_baseline(const scenarios::GateFile& gate);

}  // namespace tarmac::tools
