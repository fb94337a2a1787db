#include "metrics/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "metrics/non_inferiority.h"
#include "metrics/paired_logs.h"

namespace tarmac::metrics {

namespace {

constexpr double kSignificance = 0.05;

void judge(double p, double significance, PairedComparison& c) {
  if (c.pairs < kLeastPairs)
    c.difference = Difference::too_few;
  else if (p >= significance)
    c.difference = Difference::not_significant;
  else
    c.difference = c.ratio < 1 ? Difference::lower : Difference::higher;
}

/// Headline values of one estimator by seed.
std::map<std::uint64_t, double> values_of(const std::vector<const Evaluation*>& evaluations,
                                          const std::string& estimator, const std::string& metric) {
  std::map<std::uint64_t, double> values;
  for (const Evaluation* e : evaluations) {
    if (e->estimator != estimator || e->status != "ok") continue;
    const Row* row = e->row(metric);
    if (!row || !row->value) row = e->row(metric, "final");
    if (row && row->value) values[e->seed] = *row->value;
  }
  return values;
}

PairedComparison compare_two(const std::vector<const Evaluation*>& evaluations, const std::string& a,
                             const std::string& b, const std::string& metric) {
  const auto of_a = values_of(evaluations, a, metric), of_b = values_of(evaluations, b, metric);
  std::vector<double> values_a, values_b;
  for (const auto& [seed, value] : of_a)
    if (const auto found = of_b.find(seed); found != of_b.end()) {
      values_a.push_back(value);
      values_b.push_back(found->second);
    }
  PairedComparison c = compare_paired(values_a, values_b);
  c.a = a;
  c.b = b;
  c.metric = metric;
  return c;
}

}  // namespace

const char* name_of(Difference difference) {
  switch (difference) {
    case Difference::lower:
      return "lower";
    case Difference::higher:
      return "higher";
    case Difference::not_significant:
      return "not_significant";
    case Difference::too_few:
      return "too_few";
  }
  return "unknown";
}

PairedComparison compare_paired(const std::vector<double>& a, const std::vector<double>& b, double significance) {
  if (a.size() != b.size()) throw std::invalid_argument("compare_paired: the two lists belong together in pairs");
  const std::vector<double> logs = log_ratios(a, b);
  PairedComparison c;
  c.pairs = logs.size();
  const auto count = [&](auto&& is_so) {
    return static_cast<std::size_t>(std::count_if(logs.begin(), logs.end(), is_so));
  };
  c.a_lower = count([](double d) { return d < -kLogRounding; });
  c.b_lower = count([](double d) { return d > kLogRounding; });
  c.low = 0;
  c.high = std::numeric_limits<double>::infinity();
  if (logs.empty()) return c;
  const LogSummary summary = summarise(logs);
  c.ratio = std::exp(summary.mean);
  if (c.pairs < kLeastPairs) return c;
  const double half_width = summary.error * student_quantile(c.pairs, 0.975);
  c.low = std::exp(summary.mean - half_width);
  c.high = std::exp(summary.mean + half_width);
  if (std::abs(summary.mean) <= kLogRounding)
    c.p = 1;  // however well the seeds agree on it
  else if (summary.error > 0)
    c.p = 2 * student_above(c.pairs, std::abs(summary.mean) / summary.error);
  else
    c.p = 0;  // the same ratio on every seed
  c.p_adjusted = c.p;
  judge(c.p, significance, c);
  return c;
}

void judge_by_holm(std::span<PairedComparison> comparisons, double significance) {
  std::vector<PairedComparison*> tested;
  std::vector<double> p;
  for (PairedComparison& c : comparisons) {
    const bool same = c.a_lower == 0 && c.b_lower == 0;
    if (c.pairs < kLeastPairs || same) continue;
    tested.push_back(&c);
    p.push_back(c.p);
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t k = 0; k < tested.size(); ++k) {
    tested[k]->p_adjusted = adjusted[k];
    judge(adjusted[k], significance, *tested[k]);
  }
}

Better better_of(const MetricEntry& metric) {
  if (metric.lower_is_better) return Better::lower;
  const std::string_view name = metric.name, family = metric.family;
  const bool score = family == "coverage" || name.starts_with("degeneracy_") || name == "real_time_factor";
  return score ? Better::higher : Better::neither;
}

bool describes_drive(const MetricEntry& metric) {
  const std::string_view name = metric.name;
  return better_of(metric) == Better::neither && (name == "path_length_m" || name.starts_with("oracle_"));
}

PairedComparison turned_around(const PairedComparison& comparison) {
  PairedComparison c = comparison;
  std::swap(c.a, c.b);
  std::swap(c.a_lower, c.b_lower);
  c.ratio = 1 / comparison.ratio;
  c.low = 1 / comparison.high;  // of "cannot be told", 0 and infinity, this makes the same again
  c.high = 1 / comparison.low;
  if (comparison.difference == Difference::lower) c.difference = Difference::higher;
  if (comparison.difference == Difference::higher) c.difference = Difference::lower;
  return c;
}

std::vector<PairedComparison> compare_all(const std::vector<const Evaluation*>& evaluations,
                                          const std::string& metric) {
  std::vector<std::string> names;
  for (const Evaluation* e : evaluations)
    if (std::find(names.begin(), names.end(), e->estimator) == names.end()) names.push_back(e->estimator);
  std::vector<PairedComparison> comparisons;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j)
      comparisons.push_back(compare_two(evaluations, names[i], names[j], metric));
  judge_by_holm(comparisons);
  return comparisons;
}

std::string in_words(const PairedComparison& c) {
  switch (c.difference) {
    case Difference::lower:
    case Difference::higher:
      return fmt::format("{}'s {} is {:.3g} times {}'s (95 % interval {:.3g} to {:.3g}, lower on {} of {} seeds)", c.a,
                         c.metric, c.ratio, c.b, c.low, c.high, c.a_lower, c.pairs);
    case Difference::not_significant:
      return fmt::format(
          "{} and {} do not differ significantly in {} (ratio {:.3g}, 95 % interval {:.3g} to {:.3g}, "
          "{} seeds{})",
          c.a, c.b, c.metric, c.ratio, c.low, c.high, c.pairs,
          c.p < kSignificance ? "; several pairs were tested" : "");
    case Difference::too_few:
      break;
  }
  return fmt::format("{} and {} cannot be compared in {}: {} seeds with both, at least {} are needed", c.a, c.b,
                     c.metric, c.pairs, kLeastPairs);
}

}  // namespace tarmac::metrics
