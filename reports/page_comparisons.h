/// Estimators compared over seeds, as the page's data block holds it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "metrics/compare.h"
#include "reports/report.h"

namespace tarmac::reports {

/// [{metric, a, b, pairs, a_lower, ratio, low, high, p, difference}] of every ordered pair of estimators and every
/// metric of the summary that both have on some seed; empty where there is one seed or one estimator. low and high are
/// null where there are too few seeds for an interval. See metrics/compare.h.
nlohmann::json comparisons(const std::vector<ReportRun>& runs);

/// Of two estimators by one metric, among all that are compared by it (Holm's rule counts them).
metrics::PairedComparison comparison_of(const std::vector<ReportRun>& runs, const std::string& a, const std::string& b,
                                        const std::string& metric);

}  // namespace tarmac::reports
