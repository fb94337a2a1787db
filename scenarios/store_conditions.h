/// A filter as SQL. Private to scenarios/.
#pragma once

#include <string>
#include <vector>

#include "scenarios/sqlite.h"
#include "scenarios/store.h"

namespace tarmac::scenarios {

/// " and column in (…) and …", with its values.
class Conditions {
 public:
  Conditions() = default;
  /// What the filter says of cells (`cells c`); not of statuses and metrics.
  explicit Conditions(const ResultFilter& filter);
  /// Nothing when the list is empty: it selects all.
  void among(const std::string& column, const std::vector<std::string>& values);
  const std::string& sql() const { return sql_; }
  void bind(Statement& statement) const;

 private:
  void add_list(const std::string& column, std::string json);
  std::string sql_;
  std::vector<std::string> bound_;
};

}  // namespace tarmac::scenarios
