/// Series as the page's data block holds them: thinned to what a page can carry, with shared x written once.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/report.h"

namespace tarmac::reports {

/// Values that a page holds at most over all series: some 6 MB of text where no two series share their x, half of it
/// where they do.
inline constexpr std::size_t kMaxValues = 600000;
/// However many series there are, each keeps that many samples: enough for a curve that reads.
inline constexpr std::size_t kMinSamplesEach = 200;

/// The longest that a series may be without being thinned. Short series (curves by phase, drift by length) leave their
/// share to the long ones; all series of one length are thinned alike, so that what belongs together by index still
/// does.
std::size_t longest_series(const std::vector<ReportRun>& runs, std::size_t max_values = kMaxValues);

/// Six significant digits: finer than any line can show, and half the size. NaN is null.
nlohmann::json number(double value);

/// Writes series; every distinct x once.
class SeriesWriter {
 public:
  explicit SeriesWriter(std::size_t max_samples);
  /// {x_label, y_label, first, step, x: number of its grid, y, low?, high?}
  nlohmann::json write(const metrics::Series& series);
  /// The grids, by their numbers.
  nlohmann::json grids() const;

 private:
  std::size_t max_samples_;
  std::map<std::string, std::size_t> number_of_;  ///< by the grid's text
  std::vector<std::string> grids_;
};

}  // namespace tarmac::reports
