/// Metrics by name, for `tarmac list metrics`, `tarmac describe metric NAME` and the report's explanations.
#pragma once

#include <span>
#include <string>

namespace tarmac::metrics {

struct MetricEntry {
  const char* name;  ///< "ate_se3_rmse_m"
  const char* unit;  ///< "m"
  bool lower_is_better;
  const char* alignment;  ///< "first valid reference pose", "SE(3)", "none needed", ...
  const char* meaning;    ///< one sentence
  const char* source;     ///< definition or paper
  /// coverage | trajectory | drift | points | timing | residuals | degeneracy | consistency | effort | cost; cost = no
  /// two runs have the same
  const char* family;
};

/// In the order in which tables show them.
std::span<const MetricEntry> metrics();
const MetricEntry* find_metric(const std::string& name);

}  // namespace tarmac::metrics
