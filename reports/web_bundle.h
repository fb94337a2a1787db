/// The page's script and style, bundled from reports/web when the library is built.
#pragma once

#include <string_view>

namespace tarmac::reports {

std::string_view page_script();
std::string_view page_style();

}  // namespace tarmac::reports
