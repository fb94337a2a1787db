/// Pieces of a page's data block that the report and the comparison share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

namespace tarmac::reports {

/// Six significant digits: finer than any line can show, and half the size. NaN is null.
nlohmann::json page_number(double value);
nlohmann::json page_numbers(const std::vector<double>& values);

/// {name: {name, unit, lower_is_better, alignment, meaning, source}} of those that the registry knows.
nlohmann::json metric_table(const std::set<std::string>& names);

/// The data as text that may stand inside a script element.
std::string inside_script(const nlohmann::json& data);

}  // namespace tarmac::reports
