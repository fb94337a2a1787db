/// Rows of the tables as cells, outcomes and metrics, and back. Private to scenarios/.
#pragma once

#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "scenarios/sqlite.h"
#include "scenarios/store.h"

namespace tarmac::scenarios {

/// Numbers of metrics' names in a store; new names are added. To be cleared after a rollback.
class MetricNames {
 public:
  std::int64_t id(Database& db, const MetricValue& metric);
  void clear() { known_.clear(); }

 private:
  /// By metric, estimate, unit, deterministic.
  std::map<std::tuple<std::string, std::string, std::string, bool>, std::int64_t> known_;
};

/// Throws InputError for a seed that SQLite cannot hold.
void insert_cell(Database& db, const Cell& cell);
/// Throws std::logic_error when a metric stands twice.
void insert_outcome(Database& db, MetricNames& names, std::int64_t run, std::int64_t cell, const CellOutcome& outcome,
                    std::span<const MetricValue> metrics);

/// A cell's status: that of its outcome, or pending or running. Of cells c, outcomes o and claims l.
inline constexpr const char* kStatusColumn =
    "coalesce(o.status, case when l.cell is null then 'pending' else 'running' end)";

/// All cells, in order of insertion.
std::vector<Cell> read_cells(Database& db);
/// Cells without an outcome, in order of insertion.
std::vector<CellResult> read_unfinished(Database& db, const ResultFilter& filter);
/// As Store::results.
std::vector<CellResult> read_results(Database& db, const ResultFilter& filter);

}  // namespace tarmac::scenarios
