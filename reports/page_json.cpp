#include "reports/page_json.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "metrics/registry.h"

namespace tarmac::reports {

using nlohmann::json;

json page_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

json page_numbers(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) list.push_back(page_number(value));
  return list;
}

json metric_table(const std::set<std::string>& names) {
  json table = json::object();
  for (const auto& name : names) {
    const metrics::MetricEntry* const entry = metrics::find_metric(name);
    if (!entry) continue;
    table[name] = {
        {"name", entry->name},           {"unit", entry->unit},       {"lower_is_better", entry->lower_is_better},
        {"alignment", entry->alignment}, {"meaning", entry->meaning}, {"source", entry->source}};
  }
  return table;
}

// No "<" may stand in a script element's data: "</script>" would end it.
std::string inside_script(const json& data) {
  // Bytes that are no UTF-8 (an estimator's message may hold any) are shown as replacement characters.
  const std::string text = data.dump(-1, ' ', /*ensure_ascii=*/false, json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace tarmac::reports
