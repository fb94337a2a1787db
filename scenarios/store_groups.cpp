// Tables over many cells, without making a CellResult of each.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/config.h"
#include "core/error.h"
#include "scenarios/store_conditions.h"
#include "scenarios/store_state.h"

namespace tarmac::scenarios {
namespace {

/// Names of columns as users know them, and what they are.
const std::vector<std::pair<std::string, std::string>>& columns() {
  static const std::vector<std::pair<std::string, std::string>> all = {
      {"case", "c.case_name"}, {"estimator", "c.estimator"}, {"scenario", "c.scenario"}, {"block", "c.block"},
      {"seed", "c.seed"},      {"world", "c.world"},         {"status", kStatusColumn}};
  return all;
}

const std::string& column(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, sql] : columns()) {
    if (known == name) return sql;
    names.push_back(known);
  }
  const std::string guess = core::did_you_mean(name, names);
  throw core::InputError(fmt::format("there is no column '{}'{}; there are {}", name,
                                     guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                     fmt::join(names, ", ")));
}

/// Which group each cell belongs to, by the cell's number; -1: none.
struct Grouping {
  std::vector<CellGroup> groups;
  std::vector<int> group_of;
};

Grouping group_cells(Database& db, const ResultFilter& filter, const std::vector<std::string>& by) {
  std::string selected;
  for (const std::string& name : by) selected += ", " + column(name);
  Conditions where(filter);
  where.among(kStatusColumn, filter.statuses);
  Statement rows =
      db.prepare(fmt::format("select c.id, {}{} from cells c left join outcomes o on o.cell = c.id "
                             "left join claims l on l.cell = c.id where 1{} order by c.id",
                             kStatusColumn, selected, where.sql()));
  where.bind(rows);
  Grouping grouping;
  grouping.group_of.assign(static_cast<std::size_t>(db.integer("select max(id) from cells")) + 1, -1);
  std::map<std::vector<std::string>, int> numbers;
  std::vector<std::string> values(by.size());
  while (rows.step()) {
    for (std::size_t i = 0; i < by.size(); ++i) values[i] = rows.text(static_cast<int>(i) + 2);
    const auto [entry, added] = numbers.try_emplace(values, static_cast<int>(grouping.groups.size()));
    if (added) grouping.groups.emplace_back().by = values;
    ++grouping.groups[static_cast<std::size_t>(entry->second)].statuses[rows.text(1)];
    grouping.group_of[static_cast<std::size_t>(rows.integer(0))] = entry->second;
  }
  return grouping;
}

/// What is stored under a metric's name.
struct MetricName {
  std::int64_t id = 0;
  std::string estimate, unit;
};

/// Those that count for the headline first.
std::vector<MetricName> names_of(Database& db, const std::string& metric) {
  Statement& rows = db.cached("select id, estimate, unit from metric_names where metric = ? order by estimate, id");
  rows.with({metric});
  std::vector<MetricName> names;
  while (rows.step()) names.push_back({rows.integer(0), rows.text(1), rows.text(2)});
  std::stable_sort(names.begin(), names.end(), [](const MetricName& a, const MetricName& b) {
    return headline_rank(a.estimate) < headline_rank(b.estimate);
  });
  return names;
}

/// Adds one metric's headline values.
void add_metric(Database& db, const std::string& metric, Grouping& grouping) {
  for (CellGroup& group : grouping.groups) group.metrics.emplace_back();
  std::vector<bool> seen(grouping.group_of.size(), false);
  for (const MetricName& name : names_of(db, metric)) {
    Statement& rows = db.cached("select cell, value, status from metric_values where metric = ?").with({name.id});
    while (rows.step()) {
      const auto cell = static_cast<std::size_t>(rows.integer(0));
      if (grouping.group_of[cell] < 0 || seen[cell]) continue;
      seen[cell] = true;
      CellGroup::Metric& to = grouping.groups[static_cast<std::size_t>(grouping.group_of[cell])].metrics.back();
      if (to.unit.empty()) to.unit = name.unit;
      if (!rows.null(1)) {
        to.values.push_back(rows.real(1));
      } else if (to.missing.empty()) {
        to.missing = rows.text(2);
      }
    }
  }
}

}  // namespace

std::vector<CellGroup> Store::groups(const ResultFilter& filter, const std::vector<std::string>& by) const {
  const std::lock_guard guard(state_->mutex);
  Database& db = *state_->db;
  const Snapshot snapshot(db);
  Grouping grouping = group_cells(db, filter, by);
  for (const std::string& metric : filter.metrics) add_metric(db, metric, grouping);
  std::sort(grouping.groups.begin(), grouping.groups.end(), [&](const CellGroup& a, const CellGroup& b) {
    for (std::size_t i = 0; i < by.size(); ++i) {
      if (a.by[i] == b.by[i]) continue;
      const bool numbers = by[i] == "seed" && a.by[i].size() != b.by[i].size();
      return numbers ? a.by[i].size() < b.by[i].size() : a.by[i] < b.by[i];
    }
    return false;
  });
  return std::move(grouping.groups);
}

std::vector<std::string> Store::distinct(const std::string& name) const {
  const std::lock_guard guard(state_->mutex);
  const std::string sql = name == "metric" ? "select distinct metric from metric_names order by id"
                          : name == "parameter"
                              ? "select distinct path from parameters order by path"
                              : fmt::format(
                                    "select distinct {} from cells c left join outcomes o on o.cell = c.id left "
                                    "join claims l on l.cell = c.id order by 1",
                                    column(name));
  Statement& rows = state_->db->cached(sql);
  std::vector<std::string> values;
  while (rows.step()) values.push_back(rows.text(0));
  return values;
}

}  // namespace tarmac::scenarios
