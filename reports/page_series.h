/// How much of the evaluations' series a page can carry.
#pragma once

#include <cstddef>
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

}  // namespace tarmac::reports
