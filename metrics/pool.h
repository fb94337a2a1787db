/// Rows of several seeds as one.
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/evaluation.h"

namespace tarmac::metrics {

/// A metric over seeds. row.value is the median; [row.ci_low, row.ci_high] holds the true median with probability
/// `confidence`, whatever the distribution: order statistics x_(k) and x_(n+1-k), with the largest k for which
/// 1 - 2 P(Binomial(n, 1/2) < k) is at least 0.9. Five seeds give their range (0.9375), below five there is no
/// interval. Source: David and Nagaraja, Order Statistics, section 7.1.
struct PooledRow {
  Row row;
  std::size_t n = 0;      ///< seeds that have a value
  std::size_t seeds = 0;  ///< seeds that were run
  double confidence = 0;  ///< 0: no interval
};

/// Pools evaluations of one estimator on one scenario, one a seed. Rows come in the first evaluation's order. A row
/// that some seeds lack is the median of the others, and its status says so: "ok: 4 of 5 seeds". None has it: n/a with
/// the first reason. One evaluation alone is given back as it is.
std::vector<PooledRow> pool(const std::vector<const Evaluation*>& evaluations);

/// The k of the interval for n values, and its confidence; k = 0 when there is none.
std::size_t median_interval_rank(std::size_t n, double& confidence);

}  // namespace tarmac::metrics
