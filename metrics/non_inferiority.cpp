#include "metrics/non_inferiority.h"

#include <algorithm>
#include <boost/math/distributions/non_central_t.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "metrics/paired_logs.h"

namespace tarmac::metrics {

namespace {

void check(const NonInferiorityRule& rule) {
  if (!(rule.alpha > 0 && rule.alpha < 1)) throw std::invalid_argument("non-inferiority: alpha lies between 0 and 1");
  if (!(rule.power > 0 && rule.power < 1)) throw std::invalid_argument("non-inferiority: power lies between 0 and 1");
  if (!(rule.margin > -1)) throw std::invalid_argument("non-inferiority: the margin is above -1");
}

/// d of every pair that has one; the others are counted.
std::vector<double> worsening_of(const std::vector<double>& now, const std::vector<double>& baseline,
                                 bool lower_is_better, NonInferiority& result) {
  if (now.size() != baseline.size()) throw std::invalid_argument("non-inferiority: the lists belong together in pairs");
  std::vector<double> logs;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (!std::isfinite(now[k]) || !std::isfinite(baseline[k]))
      throw std::invalid_argument("non-inferiority: a value is not finite");
    if (now[k] == baseline[k])
      logs.push_back(0);
    else if (now[k] > 0 && baseline[k] > 0)
      logs.push_back(lower_is_better ? std::log(now[k] / baseline[k]) : std::log(baseline[k] / now[k]));
    else
      ++((now[k] > baseline[k]) == lower_is_better ? result.worse : result.better);
  }
  return logs;
}

/// P(T(n - 1) > excess / error), also where all pairs agree.
double p_of(std::size_t n, double excess, double error) {
  if (error > kLogRounding) return student_above(n, excess / error);
  return excess > kLogRounding ? 0 : 1;
}

NonInferiorityVerdict verdict_of(const NonInferiority& r, double upper, double threshold, double alpha) {
  if (r.worse > 0) return NonInferiorityVerdict::fail;
  if (r.better > 0 || r.pairs < 2) return NonInferiorityVerdict::inconclusive;
  if (r.p < alpha) return NonInferiorityVerdict::fail;
  return upper <= threshold + kLogRounding ? NonInferiorityVerdict::pass : NonInferiorityVerdict::inconclusive;
}

}  // namespace

const char* name_of(NonInferiorityVerdict verdict) {
  switch (verdict) {
    case NonInferiorityVerdict::pass:
      return "pass";
    case NonInferiorityVerdict::fail:
      return "fail";
    case NonInferiorityVerdict::inconclusive:
      return "inconclusive";
  }
  return "unknown";
}

NonInferiority test_non_inferiority(const std::vector<double>& now, const std::vector<double>& baseline,
                                    const NonInferiorityRule& rule) {
  check(rule);
  NonInferiority r;
  const LogSummary d = summarise(worsening_of(now, baseline, rule.lower_is_better, r));
  r.pairs = d.n;
  r.log_mean = d.mean;
  r.log_sd = d.sd;
  r.ratio = std::exp(d.mean);
  double upper = std::numeric_limits<double>::infinity();
  const double threshold = std::log1p(rule.margin);
  if (d.n >= 2) {
    const double half = student_quantile(d.n, 1 - rule.alpha) * d.error;
    const double half_of_interval = student_quantile(d.n, 0.975) * d.error;
    upper = d.mean + half;
    r.low = std::exp(d.mean - half);
    r.high = std::exp(upper);
    r.ci_low = std::exp(d.mean - half_of_interval);
    r.ci_high = std::exp(d.mean + half_of_interval);
    r.p = p_of(d.n, d.mean - threshold, d.error);
  }
  r.verdict = verdict_of(r, upper, threshold, rule.alpha);
  return r;
}

double power_of_paired_test(std::size_t n, double delta, double sd, double alpha) {
  if (n < 2) return 0;
  if (sd <= kLogRounding) return delta > kLogRounding ? 1 : 0;
  const double noncentrality = delta * std::sqrt(static_cast<double>(n)) / sd;
  const double critical = student_quantile(n, 1 - alpha);
  // Far out Boost's series no longer converges; there the test cannot miss.
  if (noncentrality > critical + 40) return 1;
  const boost::math::non_central_t distribution(static_cast<double>(n - 1), noncentrality);
  return boost::math::cdf(boost::math::complement(distribution, critical));
}

double minimum_detectable_change(std::size_t n, double sd, const NonInferiorityRule& rule) {
  check(rule);
  if (n < 2) return std::numeric_limits<double>::infinity();
  double low = 0, high = sd;
  if (sd > kLogRounding) {
    while (power_of_paired_test(n, high, sd, rule.alpha) < rule.power) high *= 2;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (power_of_paired_test(n, middle, sd, rule.alpha) < rule.power ? low : high) = middle;
    }
  }
  return std::expm1(std::log1p(rule.margin) + high);
}

std::size_t pairs_needed(double change, double sd, const NonInferiorityRule& rule) {
  check(rule);
  const double delta = std::log1p(change) - std::log1p(rule.margin);
  if (!(delta > 0)) throw std::invalid_argument("pairs_needed: the change must exceed the margin");
  const auto enough = [&](std::size_t n) { return power_of_paired_test(n, delta, sd, rule.alpha) >= rule.power; };
  std::size_t high = 2;
  while (!enough(high)) {
    high *= 2;
    if (high > 1'000'000) throw std::invalid_argument("pairs_needed: more than a million pairs");
  }
  std::size_t low = std::max<std::size_t>(high / 2, 1);  // not enough: the power grows with n
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - k) * p[order[k]]));
    adjusted[order[k]] = largest;
  }
  return adjusted;
}

}  // namespace tarmac::metrics
