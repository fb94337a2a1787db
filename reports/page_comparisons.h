/// Estimators compared over seeds, for the page.
#pragma once

#include <string>
#include <vector>

#include "metrics/compare.h"
#include "reports/report.h"

namespace tarmac::reports {

/// Every ordered pair of estimators by every metric of the summary that both have on some seed; empty where there is
/// one seed or one estimator.
std::vector<metrics::PairedComparison> comparisons(const std::vector<ReportRun>& runs);

/// Of two estimators by one metric, among all that are compared by it (Holm's rule counts them).
metrics::PairedComparison comparison_of(const std::vector<ReportRun>& runs, const std::string& a, const std::string& b,
                                        const std::string& metric);

}  // namespace tarmac::reports
