#include "reports/page_series.h"

#include <algorithm>

namespace tarmac::reports {

namespace {

std::size_t columns(const metrics::Series& series) {
  return series.low.empty() || series.high.empty() ? 2 : 4;
}

}  // namespace

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

}  // namespace tarmac::reports
