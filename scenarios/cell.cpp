#include "scenarios/cell.h"

namespace tarmac::scenarios {

int headline_rank(const std::string& estimate) {
  return estimate == "causal" ? 0 : estimate == "final" ? 1 : 2;
}

const MetricValue* find_value(const CellResult& result, const std::string& metric, const std::string& estimate) {
  const MetricValue* found = nullptr;
  for (const MetricValue& value : result.metrics) {
    if (value.metric != metric || (!estimate.empty() && value.estimate != estimate)) continue;
    if (!found || headline_rank(value.estimate) < headline_rank(found->estimate)) found = &value;
  }
  return found;
}

}  // namespace tarmac::scenarios
