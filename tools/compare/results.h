/// What `tarmac compare` prints: a table for people, rows for programs.
#pragma once

#include "reports/compare.h"

namespace tarmac::tools {

/// The verdict, the significant changes, and counts of the rest; as JSON every row.
void print_comparison(const reports::CompareInput& input, bool json);

}  // namespace tarmac::tools
