#include "reports/page_comparisons.h"

namespace tarmac::reports {

namespace {

using metrics::PairedComparison;

/// Errors only: times of one machine are no sample over seeds.
constexpr const char* kCompared[] = {"end_error_percent",          "ate_se3_rmse_m",       "kitti_trans_percent",
                                     "rpe_1sweep_trans_rmse_m",    "point_error_rms_m",    "deskew_error_rms_m",
                                     "deskew_error_braking_rms_m", "drift_50m_yaw_rms_deg"};

std::vector<const metrics::Evaluation*> all_of(const std::vector<ReportRun>& runs) {
  std::vector<const metrics::Evaluation*> all;
  for (const auto& run : runs) {
    for (const auto& evaluation : run.evaluations) all.push_back(&evaluation);
  }
  return all;
}

/// Every pair in both orders: the reader chooses which estimator the others stand against.
std::vector<PairedComparison> both_ways(const std::vector<const metrics::Evaluation*>& all, const std::string& metric) {
  const std::vector<PairedComparison> pairs = metrics::compare_all(all, metric);
  std::vector<PairedComparison> list = pairs;
  for (const PairedComparison& c : pairs) list.push_back(metrics::turned_around(c));
  return list;
}

}  // namespace

std::vector<PairedComparison> comparisons(const std::vector<ReportRun>& runs) {
  std::vector<PairedComparison> list;
  if (runs.size() < 2) return list;
  const auto all = all_of(runs);
  for (const char* metric : kCompared) {
    for (const PairedComparison& c : both_ways(all, metric)) {
      if (c.pairs > 0) list.push_back(c);
    }
  }
  return list;
}

PairedComparison comparison_of(const std::vector<ReportRun>& runs, const std::string& a, const std::string& b,
                               const std::string& metric) {
  for (const PairedComparison& c : both_ways(all_of(runs), metric)) {
    if (c.a == a && c.b == b) return c;
  }
  return {};
}

}  // namespace tarmac::reports
