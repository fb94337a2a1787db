/// What is printed: tables for people, rows for programs.
#pragma once

#include <string>
#include <vector>

#include "metrics/evaluation.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/outcome.h"
#include "tools/tarmac/text_table.h"

namespace tarmac::tools {

/// One line an estimator with the main metrics, seeds pooled by their median; as JSON every row of every seed.
void print_results(const std::vector<metrics::Evaluation>& evaluations, bool json);

/// One line an estimator: sweeps, path length, steps, cost. For estimates that have no truth to be scored against.
void print_estimates(const RunFolder& run, const std::vector<Outcome>& outcomes, bool json);

/// Rows of the two-file form of `tarmac evaluate`.
void print_rows(const std::vector<metrics::Row>& rows, bool json);

}  // namespace tarmac::tools
