#include "metrics/consistency.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <unordered_map>

#include "metrics/statistics.h"
#include "metrics/trajectory_error.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr double kDimensions = 6;
constexpr double kChiSquared95 = 12.591587243743977;  // 95 % quantile, 6 degrees of freedom

}  // namespace

std::vector<StatedCovariance> stated_covariances(const DiagnosticsSource& diagnostics) {
  std::vector<StatedCovariance> stated;
  for (std::size_t i = 0; i < diagnostics.count; ++i) {
    const SweepDiagnostics sweep = diagnostics.sweep(i);
    if (!sweep.covariance.isZero(0)) stated.push_back({sweep.index, sweep.covariance});
  }
  return stated;
}

std::vector<Nees> nees_of(const std::vector<PosePair>& pairs, const std::vector<StatedCovariance>& stated,
                          std::size_t& left_out) {
  std::vector<Nees> all;
  if (pairs.empty()) return all;
  std::unordered_map<std::int64_t, const Matrix6*> by_index;
  for (const StatedCovariance& s : stated) by_index.emplace(s.index, &s.covariance);
  const SE3 T_map_world = first_pose_alignment(pairs).inverse();
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const auto found = by_index.find(pairs[k].index);
    if (found == by_index.end()) continue;
    const Eigen::LLT<Matrix6> llt(*found->second);
    const Vector6 xi = se3::log(pairs[k].T_map_body.inverse() * (T_map_world * pairs[k].T_world_body));
    const double nees = llt.info() == Eigen::Success ? xi.dot(llt.solve(xi)) : -1;
    if (std::isfinite(nees) && nees >= 0)
      all.push_back({pairs[k].t, nees});
    else
      ++left_out;
  }
  return all;
}

void add_consistency(const std::vector<PosePair>& pairs, const DiagnosticsSource* diagnostics, Time t_zero,
                     RowSet& rows, std::vector<Series>& series) {
  const auto missing = [&rows](const char* reason) {
    for (const char* metric : {"anees_per_dof", "anees_root_per_dof", "nees_covered_percent"})
      rows.missing(metric, reason);
  };
  if (!diagnostics) return missing("the run recorded no diagnostics");
  const std::vector<StatedCovariance> stated = stated_covariances(*diagnostics);
  if (stated.empty()) return missing("the method states no covariance of its poses");
  std::size_t left_out = 0;
  const std::vector<Nees> all = nees_of(pairs, stated, left_out);
  if (all.empty()) return missing("no scored sweep has a positive definite covariance");
  Series nees{"nees_vs_time", "time [s]", "NEES per degree of freedom", {}, {}, {}, {}};
  double covered = 0;
  for (const Nees& one : all) {
    nees.x.push_back(to_s(one.t - t_zero));
    nees.y.push_back(one.nees / kDimensions);
    covered += one.nees < kChiSquared95;
  }
  const double anees = mean(nees.y);
  std::string note = fmt::format("{} sweeps", all.size());
  if (left_out > 0) note += fmt::format("; {} without a positive definite covariance left out", left_out);
  rows.put("anees_per_dof", anees, note);
  rows.put("anees_root_per_dof", std::sqrt(anees), note);
  rows.put("nees_covered_percent", 100 * covered / static_cast<double>(all.size()), note);
  series.push_back(std::move(nees));
}

}  // namespace tarmac::metrics
