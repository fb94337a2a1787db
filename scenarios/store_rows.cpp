#include "scenarios/store_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "scenarios/store_conditions.h"
#include "scenarios/store_schema.h"

namespace tarmac::scenarios {
namespace {

/// One in so many cells or fewer: their metrics are looked up one by one instead of reading a metric of all cells.
constexpr std::size_t kFewCells = 16;

constexpr const char* kCellColumns = "c.id, c.key, c.world, c.block, c.scenario, c.case_name, c.seed, c.estimator";

/// Reads kCellColumns.
Cell read_cell(const Statement& row) {
  Cell cell;
  cell.key = row.text(1);
  cell.world = row.text(2);
  cell.block = row.text(3);
  cell.scenario = row.text(4);
  cell.case_name = row.text(5);
  cell.seed = static_cast<std::uint64_t>(row.integer(6));
  cell.estimator = row.text(7);
  return cell;
}

CellOutcome read_outcome(const Statement& row, int first) {
  CellOutcome outcome;
  outcome.status = row.text(first);
  outcome.message = row.text(first + 1);
  outcome.recording_hash = row.text(first + 2);
  outcome.wall_s = row.real(first + 3);
  outcome.cpu_s = row.real(first + 4);
  outcome.peak_memory_mb = row.real(first + 5);
  outcome.overhead_s = row.real(first + 6);
  outcome.folder = row.text(first + 7);
  outcome.command = row.text(first + 8);
  return outcome;
}
constexpr const char* kOutcomeColumns =
    "o.status, o.message, o.recording_hash, o.wall_s, o.cpu_s, o.peak_memory_mb, o.overhead_s, o.folder, o.command";

struct Found {
  std::int64_t id = 0;
  CellResult result;
};

std::vector<Found> find_cells(Database& db, const ResultFilter& filter) {
  Conditions where(filter);
  where.among("o.status", filter.statuses);
  Statement rows =
      db.prepare(fmt::format("select {}, {} from cells c join outcomes o on o.cell = c.id where 1{} "
                             "order by c.id",
                             kCellColumns, kOutcomeColumns, where.sql()));
  where.bind(rows);
  std::vector<Found> found;
  while (rows.step()) found.push_back({rows.integer(0), {read_cell(rows), read_outcome(rows, 8), {}}});
  return found;
}

struct MetricName {
  std::int64_t id = 0;
  MetricValue form;  ///< all but its value, interval and status
};

std::vector<MetricName> metric_names(Database& db, const std::vector<std::string>& wanted) {
  Conditions where;
  where.among("metric", wanted);
  Statement rows = db.prepare(fmt::format(
      "select id, estimate, metric, unit, deterministic from metric_names where 1{} order by id", where.sql()));
  where.bind(rows);
  std::vector<MetricName> names;
  while (rows.step()) {
    MetricName name{rows.integer(0), {}};
    name.form.estimate = rows.text(1);
    name.form.metric = rows.text(2);
    name.form.unit = rows.text(3);
    name.form.deterministic = rows.integer(4) != 0;
    names.push_back(std::move(name));
  }
  return names;
}

/// Gives each found cell its rows of a table whose last bound column and first read one are the cell. `found` is in
/// order of id.
void join_rows(Database& db, const char* of_one, const char* of_all, const std::vector<Bound>& bound,
               std::vector<Found>& found, const std::function<void(CellResult&, const Statement&)>& add) {
  const auto bind = [&](Statement& statement) {
    for (std::size_t i = 0; i < bound.size(); ++i) statement.bind(static_cast<int>(i) + 1, bound[i]);
  };
  if (found.size() * kFewCells < static_cast<std::size_t>(db.integer("select count(*) from cells"))) {
    Statement& rows = db.cached(of_one);
    bind(rows);
    for (Found& cell : found) {
      rows.bind(static_cast<int>(bound.size()) + 1, cell.id);
      while (rows.step()) add(cell.result, rows);
    }
    return;
  }
  Statement& rows = db.cached(of_all);
  bind(rows);
  auto next = found.begin();
  while (rows.step()) {
    while (next != found.end() && next->id < rows.integer(0)) ++next;
    if (next != found.end() && next->id == rows.integer(0)) add(next->result, rows);
  }
}

void load_parameters(Database& db, std::vector<Found>& found) {
  join_rows(db, "select cell, path, value from parameters where cell = ? order by position",
            "select cell, path, value from parameters order by cell, position", {}, found,
            [](CellResult& to, const Statement& row) { to.cell.parameters.emplace_back(row.text(1), row.text(2)); });
}

void load_metrics(Database& db, const std::vector<MetricName>& names, std::vector<Found>& found) {
  for (const MetricName& name : names) {
    join_rows(db, "select cell, value, ci_low, ci_high, status from metric_values where metric = ? and cell = ?",
              "select cell, value, ci_low, ci_high, status from metric_values where metric = ? order by cell",
              {name.id}, found, [&](CellResult& to, const Statement& row) {
                MetricValue& metric = to.metrics.emplace_back(name.form);
                metric.value = row.optional_real(1);
                metric.ci_low = row.optional_real(2);
                metric.ci_high = row.optional_real(3);
                metric.status = row.text(4);
              });
  }
}

auto order_of(const Cell& cell) {
  return std::tie(cell.case_name, cell.estimator, cell.seed, cell.key);
}

}  // namespace

std::int64_t MetricNames::id(Database& db, const MetricValue& metric) {
  const auto [entry, added] =
      known_.try_emplace({metric.metric, metric.estimate, metric.unit, metric.deterministic}, 0);
  if (!added) return entry->second;
  const int deterministic = metric.deterministic ? 1 : 0;
  db.run("insert or ignore into metric_names(metric, estimate, unit, deterministic) values(?, ?, ?, ?)",
         {metric.metric, metric.estimate, metric.unit, deterministic});
  entry->second =
      db.integer("select id from metric_names where metric = ? and estimate = ? and unit = ? and deterministic = ?",
                 {metric.metric, metric.estimate, metric.unit, deterministic});
  return entry->second;
}

void insert_cell(Database& db, const Cell& cell) {
  if (cell.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    throw core::InputError(fmt::format("seed {}: must be below 2^63", cell.seed));
  db.run("insert into cells(key, world, block, scenario, case_name, seed, estimator) values(?, ?, ?, ?, ?, ?, ?)",
         {cell.key, cell.world, cell.block, cell.scenario, cell.case_name, static_cast<std::int64_t>(cell.seed),
          cell.estimator});
  const std::int64_t id = db.last_id();
  std::int64_t position = 0;
  for (const auto& [path, value] : cell.parameters)
    db.run("insert into parameters values(?, ?, ?, ?)", {id, position++, path, value});
}

void insert_outcome(Database& db, MetricNames& names, std::int64_t run, std::int64_t cell, const CellOutcome& outcome,
                    std::span<const MetricValue> metrics) {
  db.run(
      "insert into outcomes values(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {cell, outcome.status, outcome.message, outcome.recording_hash, outcome.wall_s, outcome.cpu_s,
       outcome.peak_memory_mb, outcome.overhead_s, outcome.folder, outcome.command, run, now_text(), metrics.size()});
  for (const MetricValue& m : metrics)
    db.run("insert into metric_values values(?, ?, ?, ?, ?, ?)",
           {names.id(db, m), cell, m.value, m.ci_low, m.ci_high, m.status});
}

std::vector<Cell> read_cells(Database& db) {
  Statement rows = db.prepare(fmt::format("select {} from cells c order by c.id", kCellColumns));
  std::vector<Found> found;
  while (rows.step()) found.push_back({rows.integer(0), {read_cell(rows), {}, {}}});
  load_parameters(db, found);
  std::vector<Cell> cells;
  for (Found& one : found) cells.push_back(std::move(one.result.cell));
  return cells;
}

std::vector<CellResult> read_unfinished(Database& db, const ResultFilter& filter) {
  Conditions where(filter);
  where.among(kStatusColumn, filter.statuses);
  Statement rows =
      db.prepare(fmt::format("select {}, {} from cells c left join outcomes o on o.cell = c.id "
                             "left join claims l on l.cell = c.id where o.cell is null{} order by c.id",
                             kCellColumns, kStatusColumn, where.sql()));
  where.bind(rows);
  std::vector<Found> found;
  while (rows.step()) {
    Found& one = found.emplace_back(Found{rows.integer(0), {read_cell(rows), {}, {}}});
    one.result.outcome.status = rows.text(8);
  }
  load_parameters(db, found);
  std::vector<CellResult> cells;
  for (Found& one : found) cells.push_back(std::move(one.result));
  return cells;
}

std::vector<CellResult> read_results(Database& db, const ResultFilter& filter) {
  std::vector<Found> found = find_cells(db, filter);
  load_parameters(db, found);
  load_metrics(db, metric_names(db, filter.metrics), found);
  std::vector<std::size_t> order(found.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return order_of(found[a].result.cell) < order_of(found[b].result.cell);
  });
  std::vector<CellResult> results;
  results.reserve(found.size());
  for (const std::size_t i : order) results.push_back(std::move(found[i].result));
  return results;
}

}  // namespace tarmac::scenarios
