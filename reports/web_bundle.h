/// Script and style of the report and of the comparison, bundled from reports/web when the library is built.
#pragma once

#include <string_view>

namespace tarmac::reports {

std::string_view page_script();
std::string_view page_style();
std::string_view compare_script();
std::string_view compare_style();

}  // namespace tarmac::reports
