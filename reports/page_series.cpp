#include "reports/page_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace tarmac::reports {

namespace {

using nlohmann::json;

json thinned(const std::vector<double>& values, std::size_t step) {
  json list = json::array();
  for (std::size_t i = 0; i < values.size(); i += step) list.push_back(number(values[i]));
  return list;
}

std::size_t columns(const metrics::Series& series) {
  return series.low.empty() || series.high.empty() ? 2 : 4;
}

}  // namespace

json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

std::size_t longest_series(const std::vector<ReportRun>& runs, std::size_t max_values) {
  std::vector<std::pair<std::size_t, std::size_t>> sizes;  // samples, columns
  for (const auto& run : runs) {
    for (const auto& evaluation : run.evaluations) {
      for (const auto& series : evaluation.series) sizes.emplace_back(series.x.size(), columns(series));
    }
  }
  std::sort(sizes.begin(), sizes.end());
  std::size_t left = max_values, columns_left = 0;
  for (const auto& [samples, count] : sizes) columns_left += count;
  for (const auto& [samples, count] : sizes) {
    const std::size_t share = left / columns_left;
    if (samples > share) return std::max(kMinSamplesEach, share);  // and so are all that follow
    left -= samples * count;
    columns_left -= count;
  }
  return std::max(kMinSamplesEach, sizes.empty() ? 0 : sizes.back().first);
}

SeriesWriter::SeriesWriter(std::size_t max_samples) : max_samples_(max_samples) {}

json SeriesWriter::write(const metrics::Series& series) {
  const std::size_t step = std::max<std::size_t>(1, (series.x.size() + max_samples_ - 1) / max_samples_);
  const auto [entry, is_new] = number_of_.try_emplace(thinned(series.x, step).dump(), grids_.size());
  if (is_new) grids_.push_back(entry->first);
  json out = {{"x_label", series.x_label}, {"y_label", series.y_label},   {"step", step}, {"first", 0},
              {"x", entry->second},        {"y", thinned(series.y, step)}};
  if (!series.low.empty() && !series.high.empty()) {
    out["low"] = thinned(series.low, step);
    out["high"] = thinned(series.high, step);
  }
  return out;
}

json SeriesWriter::grids() const {
  json list = json::array();
  for (const std::string& grid : grids_) list.push_back(json::parse(grid));
  return list;
}

}  // namespace tarmac::reports
