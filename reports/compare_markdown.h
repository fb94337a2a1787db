/// A comparison as Markdown, for a pull request.
#pragma once

#include <string>

#include "reports/compare.h"

namespace tarmac::reports {

/// Verdict, the significant changes as a table, and the rest folded away. `link` is where the page will be found;
/// empty: none is named.
std::string compare_markdown(const CompareInput& input, const std::string& link = "");

}  // namespace tarmac::reports
