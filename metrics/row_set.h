/// Collects one estimate's rows; units come from the registry.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "metrics/evaluation.h"

namespace tarmac::metrics {

class RowSet {
 public:
  explicit RowSet(std::string estimate) : estimate_(std::move(estimate)) {}
  /// A note ("the positions lie on a line") makes the status "ok: note". NaN becomes n/a.
  /// Throws std::logic_error for a name that the registry has not.
  void put(const std::string& metric, double value, const std::string& note = "");
  /// The interval of a value that was put. NaN leaves it out.
  void interval(const std::string& metric, double low, double high);
  /// Status "n/a: reason".
  void missing(const std::string& metric, const std::string& reason);
  void put_or_missing(const std::string& metric, const std::optional<double>& value, const std::string& reason);
  /// Every metric without a row yet becomes n/a.
  void all_missing(const std::string& reason);
  /// In the registry's order.
  std::vector<Row> rows() const;

 private:
  Row& at(const std::string& metric);
  std::string estimate_;
  std::map<std::string, Row> rows_;
};

}  // namespace tarmac::metrics
