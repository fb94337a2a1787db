// `tarmac query` and `tarmac merge`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/store.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/interrupt.h"
#include "tools/tarmac/text_table.h"

namespace tarmac::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kIncomplete = 3;

Json value_json(const std::optional<std::string>& value, bool is_number) {
  if (!value) return nullptr;
  if (!is_number) return *value;
  const Json number = Json::parse(*value, nullptr, false);
  return number.is_number() ? number : Json(nullptr);  // inf: JSON has none
}

void print_json(const scenarios::Store::Table& table) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    Json row = Json::object();
    for (std::size_t j = 0; j < table.columns.size(); ++j)
      row[table.columns[j]] = value_json(table.rows[i][j], table.numbers[i][j]);
    rows.push_back(std::move(row));
  }
  fmt::print("{}\n", rows.dump(1, ' ', false, Json::error_handler_t::replace));
}

std::vector<std::vector<std::string>> texts(const scenarios::Store::Table& table, const char* null) {
  std::vector<std::vector<std::string>> lines = {table.columns};
  for (const auto& row : table.rows) {
    auto& line = lines.emplace_back();
    for (const auto& value : row) line.push_back(value.value_or(null));
  }
  return lines;
}

/// What can be asked for, a line for each view and one for the tables.
std::string what_there_is(const scenarios::Store& store) {
  std::string text;
  for (const char* view : {"all_cells", "results", "deterministic"}) {
    const auto columns = store.query(fmt::format("select * from {} limit 0", view)).columns;
    text += fmt::format("\n  {}: {}", view, fmt::join(columns, ", "));
  }
  std::vector<std::string> tables;
  for (const auto& row : store.query("select name from sqlite_schema where type = 'table' order by name").rows)
    if (!row[0]->starts_with("sqlite_")) tables.push_back(*row[0]);
  return text + fmt::format("\n  tables: {} (select sql from sqlite_schema: their columns)", fmt::join(tables, ", "));
}

/// As Store::query; who asked for what there is not is told what there is.
scenarios::Store::Table ask(const scenarios::Store& store, const std::string& sql) {
  try {
    return store.query(sql, throw_if_interrupted);
  } catch (const core::InputError& error) {
    const std::string_view message = error.what();
    if (message.find("no such column") == message.npos && message.find("no such table") == message.npos) throw;
    throw core::InputError(fmt::format("{}; there are{}", message, what_there_is(store)));
  }
}

/// Cells of a store: finished, and not.
std::pair<std::size_t, std::size_t> cells_of(const scenarios::Store& store) {
  std::size_t finished = 0, open = 0;
  for (const scenarios::CellGroup& group : store.groups({}, {"status"})) {
    for (const auto& [status, cells] : group.statuses)
      (status == "pending" || status == "running" || status == "killed" ? open : finished) += cells;
  }
  return {finished, open};
}

}  // namespace

int query_command(const QueryArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const auto store = scenarios::Store::open(arguments.folder, scenarios::Store::Access::read_only);
  const scenarios::Store::Table table = ask(store, arguments.sql);
  if (common.json) {
    print_json(table);
  } else if (arguments.csv == "-") {
    fmt::print("{}", csv(texts(table, "")));
  } else if (!arguments.csv.empty()) {
    core::write_file(arguments.csv, csv(texts(table, "")));
  } else {
    print_table(texts(table, "n/a"));
    if (table.rows.empty()) console.warn("query: no row");
  }
  return 0;
}

int merge_command(const MergeArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const std::vector<std::filesystem::path> folders(arguments.folders.begin(), arguments.folders.end());
  const std::size_t merged = scenarios::merge_stores(folders, arguments.out);
  Json json = {{"from", Json::array()}, {"to", arguments.out}};
  for (const std::string& folder : arguments.folders) {
    const auto [finished, open] = cells_of(scenarios::Store::open(folder, scenarios::Store::Access::read_only));
    json["from"].push_back({{"folder", folder}, {"finished", finished}, {"unfinished", open}});
    if (!common.json) console.say(fmt::format("{}: {} cells finished, {} not", folder, finished, open));
  }
  const auto whole = scenarios::Store::open(arguments.out, scenarios::Store::Access::read_only);
  const std::size_t open = cells_of(whole).second;
  const bool complete = whole.holds_whole_plan();
  json["finished"] = merged;
  json["unfinished"] = open;
  json["whole_sweep"] = complete;
  if (common.json) {
    fmt::print("{}\n", json.dump(1));
  } else {
    fmt::print("{}: {} cells finished, {} not\n", arguments.out, merged, open);
  }
  if (complete) return 0;
  console.warn(
      fmt::format("merge: {} holds {} cells; the sweep '{}' has more: a shard is missing. Merge all of its shards "
                  "into a new folder",
                  arguments.out, merged + open, whole.identity().sweep));
  return kIncomplete;
}

}  // namespace tarmac::tools
