#include "metrics/pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/statistics.h"

namespace tarmac::metrics {

namespace {

constexpr double kLeastConfidence = 0.9;

PooledRow pool_metric(const Row& like, const std::vector<const Evaluation*>& evaluations) {
  PooledRow pooled{like, 0, evaluations.size(), 0};
  std::vector<double> values;
  for (const Evaluation* e : evaluations)
    if (const Row* row = e->row(like.metric, like.estimate); row && row->value) {
      if (values.empty()) pooled.row.status = row->status;
      values.push_back(*row->value);
    }
  pooled.n = values.size();
  if (values.empty()) return pooled;
  std::sort(values.begin(), values.end());
  pooled.row.value = quantile(values, 0.5);
  const std::size_t k = median_interval_rank(values.size(), pooled.confidence);
  if (k > 0) {
    pooled.row.ci_low = values[k - 1];
    pooled.row.ci_high = values[values.size() - k];
  }
  if (pooled.n < pooled.seeds) pooled.row.status = fmt::format("ok: {} of {} seeds", pooled.n, pooled.seeds);
  return pooled;
}

}  // namespace

std::size_t median_interval_rank(std::size_t n, double& confidence) {
  confidence = 0;
  std::size_t rank = 0;
  double below = 0;  // P(Binomial(n, 1/2) < k)
  double term = std::pow(0.5, static_cast<double>(n));
  for (std::size_t k = 1; 2 * k <= n; ++k) {
    below += term;
    term *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    if (1 - 2 * below < kLeastConfidence) break;
    rank = k;
    confidence = 1 - 2 * below;
  }
  return rank;
}

std::vector<PooledRow> pool(const std::vector<const Evaluation*>& evaluations) {
  std::vector<PooledRow> pooled;
  std::vector<Row> seen;
  for (const Evaluation* e : evaluations)
    for (const Row& row : e->rows) {
      const bool known = std::any_of(
          seen.begin(), seen.end(), [&](const Row& r) { return r.metric == row.metric && r.estimate == row.estimate; });
      if (known) continue;
      seen.push_back(row);
      if (evaluations.size() == 1)
        pooled.push_back({row, row.value ? std::size_t{1} : std::size_t{0}, 1, 0});
      else
        pooled.push_back(pool_metric(row, evaluations));
    }
  return pooled;
}

}  // namespace tarmac::metrics
