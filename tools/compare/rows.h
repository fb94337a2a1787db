/// One method on one case: its metrics over seeds as rows of a comparison.
#pragma once

#include <vector>

#include "tools/compare/pairing.h"

namespace tarmac::tools {

/// Rows of one pair of methods, not judged yet, and the metrics that only one side has a value of.
void add_rows(const PairedRuns& paired, const std::vector<std::string>& metrics, Pairing& into);

/// Holm's rule over all rows but costs, over the costs apart; then the verdicts.
void judge_rows(std::vector<reports::CompareRow>& rows);

}  // namespace tarmac::tools
