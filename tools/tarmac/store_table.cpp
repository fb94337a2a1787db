// `tarmac table`: the cells of a sweep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/config.h"
#include "core/error.h"
#include "core/files.h"
#include "metrics/pool.h"
#include "metrics/statistics.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/interrupt.h"
#include "tools/tarmac/store_filter.h"
#include "tools/tarmac/text_table.h"

namespace tarmac::tools {
namespace {

using Json = nlohmann::ordered_json;

/// A metric as a column: name, heading, factor to the heading's unit, decimals; decimals < 0: four digits that count.
struct Column {
  std::string metric, heading;
  double factor = 1;
  int decimals = -1;
};

std::vector<Column> metric_columns(const std::vector<std::string>& wanted) {
  const std::vector<Column> headline = {{"end_error_percent", "end error %", 1, 3},
                                        {"rpe_1sweep_trans_rmse_m", "RPE 1 sweep mm", 1e3, 2},
                                        {"deskew_error_rms_m", "deskew RMS mm", 1e3, 2},
                                        {"sweep_time_p50_ms", "ms/sweep p50", 1, 1}};
  if (wanted.empty()) return headline;
  std::vector<Column> columns;
  for (const std::string& metric : wanted) columns.push_back({metric, metric, 1, -1});
  return columns;
}

/// One field as people read it, as programs read it, and as it is sorted.
struct Field {
  std::string shown;
  std::string exact;
  std::optional<double> number;
};
Field words(const std::string& text) {
  return {text, text, {}};
}
Field count(std::size_t n) {
  return {std::to_string(n), std::to_string(n), static_cast<double>(n)};
}

/// A table before it is printed: names for --sort and CSV, headings for people.
struct Table {
  std::vector<std::string> names, headings;
  std::size_t left = 0;  ///< columns of words
  std::vector<std::vector<Field>> lines;

  void column(const std::string& name, const std::string& heading) {
    names.push_back(name);
    headings.push_back(heading);
  }
};

std::string shown(double value, const Column& column) {
  return column.decimals < 0 ? fmt::format("{:.4g}", value * column.factor)
                             : fmt::format("{:.{}f}", value * column.factor, column.decimals);
}

/// "12.31 [11.90, 12.75]", and how many cells it is over when some have no value.
Field median(std::vector<double> values, std::size_t cells, const Column& column) {
  if (values.empty()) return {"n/a", "", {}};
  std::sort(values.begin(), values.end());
  const double middle = metrics::quantile(values, 0.5);
  std::string text = shown(middle, column);
  double confidence = 0;
  if (const std::size_t k = metrics::median_interval_rank(values.size(), confidence); k > 0)
    text += fmt::format(" [{}, {}]", shown(values[k - 1], column), shown(values[values.size() - k], column));
  if (values.size() < cells) text += fmt::format(" ({} of {})", values.size(), cells);
  return {text, fmt::format("{}", middle), middle};
}

Field bound(const std::vector<double>& values, bool high) {
  double confidence = 0;
  const std::size_t k = metrics::median_interval_rank(values.size(), confidence);
  if (k == 0) return {"", "", {}};
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double value = high ? sorted[sorted.size() - k] : sorted[k - 1];
  return {"", fmt::format("{}", value), value};
}

std::size_t ended(const scenarios::CellGroup& group, bool failed) {
  std::size_t n = 0;
  for (const auto& [status, cells] : group.statuses) {
    scenarios::CellOutcome outcome;
    outcome.status = status;
    const bool open = status == "pending" || status == "running";
    if (!open && outcome.failed() == failed) n += cells;
  }
  return n;
}

std::size_t open_cells(const scenarios::CellGroup& group) {
  std::size_t n = 0;
  for (const char* status : {"pending", "running"})
    if (const auto found = group.statuses.find(status); found != group.statuses.end()) n += found->second;
  return n;
}

std::string statuses_of(const scenarios::CellGroup& group) {
  std::string text;
  for (const auto& [status, cells] : group.statuses) {
    if (status == "ok" || status == "pending" || status == "running") continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cells, status);
  }
  return text;
}

/// `exact`: with the interval and the number of values in columns of their own.
Table group_table(const scenarios::Store& store, scenarios::ResultFilter filter, const TableArguments& arguments,
                  bool exact) {
  const std::vector<Column> columns = metric_columns(arguments.metrics);
  filter.metrics.clear();
  for (const Column& column : columns) filter.metrics.push_back(column.metric);
  Table table;
  for (const std::string& name : arguments.by) table.column(name, name);
  table.left = arguments.by.size();
  for (const char* name : {"done", "failed", "pending"}) table.column(name, name);
  for (const Column& column : columns) {
    table.column(column.metric, column.heading);
    if (!exact) continue;
    for (const char* part : {"ci_low", "ci_high", "n"}) table.column(column.metric + "." + part, "");
  }
  table.column("outcomes", "outcomes");
  for (const scenarios::CellGroup& group : store.groups(filter, arguments.by)) {
    auto& line = table.lines.emplace_back();
    for (const std::string& value : group.by) line.push_back(words(value));
    const std::size_t done = ended(group, false), failed = ended(group, true);
    for (const std::size_t n : {done, failed, open_cells(group)}) line.push_back(count(n));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::vector<double>& values = group.metrics[i].values;
      line.push_back(median(values, done, columns[i]));
      if (!exact) continue;
      line.push_back(bound(values, false));
      line.push_back(bound(values, true));
      line.push_back(count(values.size()));
    }
    line.push_back(words(statuses_of(group)));
  }
  return table;
}

/// Finished cells, then those that are not.
std::vector<scenarios::CellResult> all_cells(const scenarios::Store& store, const scenarios::ResultFilter& filter) {
  std::vector<scenarios::CellResult> cells = store.results(filter);
  for (scenarios::CellResult& cell : store.unfinished(filter)) cells.push_back(std::move(cell));
  return cells;
}

std::vector<Field> cell_line(const scenarios::CellResult& cell, const std::vector<Column>& columns) {
  std::vector<Field> line = {words(cell.cell.key), words(cell.cell.case_name), words(cell.cell.estimator),
                             words(std::to_string(cell.cell.seed)), words(cell.outcome.status)};
  line[3].number = static_cast<double>(cell.cell.seed);
  const bool open = cell.outcome.status == "pending" || cell.outcome.status == "running";
  const double wall_s = cell.outcome.wall_s;
  line.push_back(open ? Field{"", "", {}} : Field{fmt::format("{:.1f}", wall_s), fmt::format("{}", wall_s), wall_s});
  for (const Column& column : columns) {
    const scenarios::MetricValue* metric = scenarios::find_value(cell, column.metric);
    line.push_back(metric && metric->value
                       ? Field{shown(*metric->value, column), fmt::format("{}", *metric->value), *metric->value}
                       : Field{open ? "" : "n/a", "", {}});
  }
  line.push_back(words(cell.outcome.message));
  return line;
}

Table cell_table(const scenarios::Store& store, scenarios::ResultFilter filter, const TableArguments& arguments) {
  const std::vector<Column> columns = metric_columns(arguments.metrics);
  filter.metrics.clear();
  for (const Column& column : columns) filter.metrics.push_back(column.metric);
  Table table;
  for (const char* name : {"cell", "case", "estimator", "seed", "status"}) table.column(name, name);
  table.left = 3;
  table.column("wall_s", "wall s");
  for (const Column& column : columns) table.column(column.metric, column.heading);
  table.column("message", "message");
  for (const scenarios::CellResult& cell : all_cells(store, filter)) table.lines.push_back(cell_line(cell, columns));
  return table;
}

void sort_lines(Table& table, const TableArguments& arguments) {
  if (!arguments.sort.empty()) {
    const auto found = std::find(table.names.begin(), table.names.end(), arguments.sort);
    if (found == table.names.end()) {
      const std::string guess = core::did_you_mean(arguments.sort, table.names);
      throw core::InputError(fmt::format("--sort {}: there is no such column{}; there are {}", arguments.sort,
                                         guess.empty() ? "" : fmt::format(" (did you mean '{}'?)", guess),
                                         fmt::join(table.names, ", ")));
    }
    const auto i = static_cast<std::size_t>(found - table.names.begin());
    std::stable_sort(table.lines.begin(), table.lines.end(), [&](const auto& a, const auto& b) {
      if (a[i].number && b[i].number)
        return arguments.reverse ? *a[i].number > *b[i].number : *a[i].number < *b[i].number;
      if (a[i].number || b[i].number) return a[i].number.has_value();  // n/a comes last, either way
      return arguments.reverse ? a[i].exact > b[i].exact : a[i].exact < b[i].exact;
    });
  } else if (arguments.reverse) {
    std::reverse(table.lines.begin(), table.lines.end());
  }
}

void write(const std::string& text, const std::string& file) {
  if (file == "-") {
    fmt::print("{}", text);
  } else {
    core::write_file(file, text);
  }
}

std::vector<std::vector<std::string>> texts(const Table& table, bool exact) {
  std::vector<std::vector<std::string>> lines = {exact ? table.names : table.headings};
  for (const auto& line : table.lines) {
    auto& text = lines.emplace_back();
    for (const Field& field : line) text.push_back(exact ? field.exact : field.shown);
  }
  return lines;
}

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json row(const scenarios::CellResult& cell, const scenarios::MetricValue& metric) {
  Json parameters = Json::object();
  for (const auto& [path, value] : cell.cell.parameters) parameters[path] = value;
  return {{"scenario", cell.cell.scenario},  {"case", cell.cell.case_name},       {"parameters", std::move(parameters)},
          {"seed", cell.cell.seed},          {"estimator", cell.cell.estimator},  {"estimate", metric.estimate},
          {"metric", metric.metric},         {"value", number(metric.value)},     {"unit", metric.unit},
          {"ci_low", number(metric.ci_low)}, {"ci_high", number(metric.ci_high)}, {"status", metric.status},
          {"cell", cell.cell.key},           {"outcome", cell.outcome.status}};
}

/// One by one: there may be millions.
void print_json(const std::vector<scenarios::CellResult>& cells) {
  const char* before = "[";
  const auto print = [&](const Json& json) {
    fmt::print("{}\n {}", before, json.dump());
    before = ",";
  };
  for (const scenarios::CellResult& cell : cells) {
    throw_if_interrupted();
    for (const scenarios::MetricValue& metric : cell.metrics) print(row(cell, metric));
    if (!cell.metrics.empty()) continue;
    scenarios::MetricValue none;
    const bool open = cell.outcome.status == "pending" || cell.outcome.status == "running";
    none.status = open                    ? cell.outcome.status
                  : cell.outcome.failed() ? "failed: " + cell.outcome.status
                                          : "n/a: " + cell.outcome.status;
    print(row(cell, none));
  }
  fmt::print("{}\n]\n", cells.empty() ? "[" : "");
}

void check_usage(const TableArguments& arguments, const CommonArguments& common) {
  if (static_cast<int>(arguments.dump) + static_cast<int>(common.json) + static_cast<int>(!arguments.csv.empty()) > 1)
    throw core::InputError("table: --dump, --json and --csv are three forms of the output; give one of them");
  if (arguments.by.empty()) throw core::InputError("table: --by names no column; expected such as --by case,estimator");
}

}  // namespace

int table_command(const TableArguments& arguments, const CommonArguments& common) {
  check_usage(arguments, common);
  const Console console(common.quiet);
  const auto store = scenarios::Store::open(arguments.folder, scenarios::Store::Access::read_only);
  const scenarios::ResultFilter filter = store_filter(store, arguments);
  if (arguments.dump) {
    store.dump(std::cout);
    std::cout.flush();
    return 0;
  }
  if (common.json) {
    const std::vector<scenarios::CellResult> cells = all_cells(store, filter);
    if (cells.empty()) console.warn("table: no cell matches all of this");
    print_json(cells);
    return 0;
  }
  const bool exact = !arguments.csv.empty();
  Table table = arguments.cells ? cell_table(store, filter, arguments) : group_table(store, filter, arguments, exact);
  if (table.lines.empty()) console.warn("table: no cell matches all of this");
  sort_lines(table, arguments);
  if (exact) {
    write(csv(texts(table, true)), arguments.csv);
    return 0;
  }
  print_table(texts(table, false), table.left);
  if (!arguments.cells && !common.quiet)
    fmt::print(
        "figures are medians over cells; [low, high] holds the median with at least 90 %, from five values on\n");
  return 0;
}

}  // namespace tarmac::tools
