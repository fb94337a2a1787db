#include "tools/compare/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "metrics/paired_logs.h"
#include "metrics/registry.h"
#include "metrics/statistics.h"

namespace tarmac::tools {
namespace {

using metrics::Better;
using reports::CompareRow;
using reports::CompareVerdict;

/// Values of one metric by estimate ("causal", "final"), a list as long as the seeds.
using Values = std::map<std::string, std::vector<std::optional<double>>>;

struct Metric {
  std::string name, unit;
  Values a, b;
  std::string reason_a, reason_b;  ///< why a value is missing: the first one
};

void collect(const std::vector<const ComparedRun*>& runs, Values Metric::*side, std::string Metric::*reason,
             const std::vector<std::string>& wanted, std::vector<Metric>& metrics) {
  for (std::size_t seed = 0; seed < runs.size(); ++seed) {
    for (const metrics::Row& row : runs[seed]->rows) {
      if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), row.metric) == wanted.end()) continue;
      auto found = std::find_if(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.name == row.metric; });
      if (found == metrics.end()) {
        metrics.push_back({row.metric, row.unit, {}, {}, {}, {}});
        found = metrics.end() - 1;
      }
      if (!row.value || !std::isfinite(*row.value)) {
        if ((*found).*reason == "") (*found).*reason = row.status;
        continue;
      }
      auto& values = ((*found).*side)[row.estimate];
      values.resize(runs.size());
      values[seed] = *row.value;
    }
  }
}

/// The headline: causal where there is one.
const std::string& headline(const Values& values) {
  const auto causal = values.find("causal");
  return causal != values.end() ? causal->first : values.begin()->first;
}

bool is_better(Better better, double value, double than) {
  return better == Better::higher ? value > than : value < than;
}

/// A row over the seeds on which both have a value; nothing when there is none.
std::optional<CompareRow> row_of(const PairedRuns& paired, const Metric& metric, const std::string& estimate_a,
                                 const std::string& estimate_b) {
  std::vector<double> a, b;
  const auto& values_a = metric.a.at(estimate_a);
  const auto& values_b = metric.b.at(estimate_b);
  for (std::size_t k = 0; k < values_a.size(); ++k) {
    if (!values_a[k] || !values_b[k]) continue;
    a.push_back(*values_a[k]);
    b.push_back(*values_b[k]);
  }
  if (a.empty()) return std::nullopt;
  CompareRow row;
  row.case_name = paired.case_name;
  row.estimator_a = paired.estimator_a;
  row.estimator_b = paired.estimator_b;
  row.metric = metric.name;
  row.unit = metric.unit;
  row.estimate = estimate_a == estimate_b ? estimate_a : estimate_a + ", " + estimate_b;
  if (const metrics::MetricEntry* entry = metrics::find_metric(metric.name)) {
    row.cost = std::string(entry->family) == "cost";
    row.better = metrics::better_of(*entry);
  }
  row.seeds = a.size();
  for (std::size_t k = 0; k < a.size(); ++k) row.same += a[k] == b[k];
  // A lag or a scale has a sign, and the nearer to 0 the better.
  const auto negative = [](double v) { return v < 0; };
  row.magnitude = row.better == Better::lower &&
                  (std::any_of(a.begin(), a.end(), negative) || std::any_of(b.begin(), b.end(), negative));
  if (row.magnitude) {
    for (double& v : a) v = std::abs(v);
    for (double& v : b) v = std::abs(v);
  }
  for (std::size_t k = 0; k < a.size(); ++k) row.b_better += is_better(row.better, b[k], a[k]);
  row.a_median = metrics::quantile(a, 0.5);
  row.b_median = metrics::quantile(b, 0.5);
  row.comparison = metrics::compare_paired(b, a);
  row.comparison.a = paired.estimator_b;
  row.comparison.b = paired.estimator_a;
  row.comparison.metric = metric.name;
  return row;
}

std::size_t count(const Values& values) {
  std::size_t most = 0;
  for (const auto& [estimate, list] : values)
    most = std::max(most, static_cast<std::size_t>(
                              std::count_if(list.begin(), list.end(), [](const auto& v) { return v.has_value(); })));
  return most;
}

/// Lines of one kind and metric are one line; details are kept as long as they read.
void add_missing(const std::string& kind, const Metric& metric, const PairedRuns& paired, std::size_t runs,
                 const std::string& reason, std::vector<reports::CompareMissing>& missing) {
  const std::string what = "metric " + metric.name;
  const std::string where = fmt::format("{} {}", paired.case_name, paired.estimator_b);
  for (reports::CompareMissing& line : missing) {
    if (line.kind != kind || line.what != what) continue;
    line.count += runs;
    constexpr std::size_t kReadable = 160;
    if (line.detail.size() < kReadable)
      line.detail += "; " + where;
    else if (!line.detail.ends_with(" ..."))
      line.detail += " ...";
    return;
  }
  missing.push_back({kind, what, (reason.empty() ? "" : reason + ": ") + where, runs});
}

CompareVerdict verdict_of(const CompareRow& row) {
  if (row.same == row.seeds) return CompareVerdict::identical;
  switch (row.comparison.difference) {
    case metrics::Difference::too_few:
      return row.seeds >= metrics::kLeastPairs ? CompareVerdict::no_ratio : CompareVerdict::too_few;
    case metrics::Difference::not_significant:
      return CompareVerdict::no_difference;
    case metrics::Difference::lower:
    case metrics::Difference::higher:
      break;
  }
  if (row.better == Better::neither) return CompareVerdict::different;
  const bool lower = row.comparison.difference == metrics::Difference::lower;
  return lower == (row.better == Better::lower) ? CompareVerdict::better : CompareVerdict::worse;
}

}  // namespace

void add_rows(const PairedRuns& paired, const std::vector<std::string>& wanted, Pairing& into) {
  std::vector<Metric> metrics;
  collect(paired.a, &Metric::a, &Metric::reason_a, wanted, metrics);
  collect(paired.b, &Metric::b, &Metric::reason_b, wanted, metrics);
  for (const Metric& metric : metrics) {
    if (metric.a.empty() && metric.b.empty()) continue;  // n/a on both sides: nothing is lost by the comparison
    std::size_t used = 0;
    const auto add = [&](const std::string& estimate_a, const std::string& estimate_b) {
      if (auto row = row_of(paired, metric, estimate_a, estimate_b)) {
        used = std::max(used, row->seeds);
        into.rows.push_back(std::move(*row));
      }
    };
    std::set<std::string> common;
    for (const auto& [estimate, values] : metric.a)
      if (metric.b.contains(estimate)) common.insert(estimate);
    for (const std::string& estimate : common) add(estimate, estimate);
    if (common.empty() && !metric.a.empty() && !metric.b.empty()) add(headline(metric.a), headline(metric.b));
    if (const std::size_t n = count(metric.a); n > used)
      add_missing("value only in A", metric, paired, n - used, metric.reason_b, into.missing);
    if (const std::size_t n = count(metric.b); n > used)
      add_missing("value only in B", metric, paired, n - used, metric.reason_a, into.missing);
  }
}

void judge_rows(std::vector<CompareRow>& rows) {
  for (const bool cost : {false, true}) {
    std::vector<metrics::PairedComparison> comparisons;
    for (const CompareRow& row : rows)
      if (row.cost == cost) comparisons.push_back(row.comparison);
    metrics::judge_by_holm(comparisons);
    std::size_t k = 0;
    for (CompareRow& row : rows)
      if (row.cost == cost) row.comparison = comparisons[k++];
  }
  for (CompareRow& row : rows) row.verdict = verdict_of(row);
}

}  // namespace tarmac::tools
