/// The page of a comparison: one HTML file that refers to nothing outside of itself.
#pragma once

#include <string>

#include "reports/compare.h"

namespace tarmac::reports {

std::string assemble_compare_page(const CompareInput& input);

/// The page's data block as JSON, safe inside a script element. Its form is described in reports/README.md.
std::string compare_page_data(const CompareInput& input);

}  // namespace tarmac::reports
