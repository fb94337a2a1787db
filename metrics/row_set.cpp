#include "metrics/row_set.h"

#include <cmath>
#include <stdexcept>

#include "metrics/registry.h"

namespace tarmac::metrics {

Row& RowSet::at(const std::string& metric) {
  const MetricEntry* entry = find_metric(metric);
  if (!entry) throw std::logic_error("metric " + metric + " is not in metrics/registry.cpp");
  Row& row = rows_[metric];
  row.estimate = estimate_;
  row.metric = metric;
  row.unit = entry->unit;
  return row;
}

void RowSet::put(const std::string& metric, double value, const std::string& note) {
  if (!std::isfinite(value)) return missing(metric, "the value is not finite");
  Row& row = at(metric);
  row.value = value;
  row.status = note.empty() ? "ok" : "ok: " + note;
}

void RowSet::interval(const std::string& metric, double low, double high) {
  Row& row = at(metric);
  if (!row.value || !std::isfinite(low) || !std::isfinite(high)) return;
  row.ci_low = low;
  row.ci_high = high;
}

void RowSet::missing(const std::string& metric, const std::string& reason) {
  Row& row = at(metric);
  row.value.reset();
  row.status = "n/a: " + reason;
}

void RowSet::put_or_missing(const std::string& metric, const std::optional<double>& value, const std::string& reason) {
  value ? put(metric, *value) : missing(metric, reason);
}

void RowSet::all_missing(const std::string& reason) {
  for (const MetricEntry& entry : metrics())
    if (!rows_.contains(entry.name)) missing(entry.name, reason);
}

std::vector<Row> RowSet::rows() const {
  std::vector<Row> rows;
  for (const MetricEntry& entry : metrics())
    if (const auto found = rows_.find(entry.name); found != rows_.end()) rows.push_back(found->second);
  return rows;
}

}  // namespace tarmac::metrics
