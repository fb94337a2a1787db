// What is asked of a store.
#include <algorithm>

#include "core/files.h"
#include "scenarios/store_schema.h"
#include "scenarios/store_state.h"

namespace tarmac::scenarios {

std::string plan_hash_of(std::vector<std::string> keys) {
  std::sort(keys.begin(), keys.end());
  std::string all;
  for (const std::string& key : keys) all += key + "\n";
  return core::hash_hex(all);
}

bool Store::holds_whole_plan() const {
  const std::lock_guard guard(state_->mutex);
  Statement& rows = state_->db->cached("select key from cells");
  std::vector<std::string> keys;
  while (rows.step()) keys.push_back(rows.text(0));
  return plan_hash_of(std::move(keys)) == identity().plan_hash;
}

std::vector<std::string> Store::pending() const {
  const std::lock_guard guard(state_->mutex);
  Statement& rows = state_->db->cached(
      "select key from cells c where not exists (select 1 from outcomes o where o.cell = c.id) and not exists "
      "(select 1 from claims l where l.cell = c.id) order by id");
  std::vector<std::string> keys;
  while (rows.step()) keys.push_back(rows.text(0));
  return keys;
}

std::vector<CellResult> Store::results(const ResultFilter& filter) const {
  const std::lock_guard guard(state_->mutex);
  const Snapshot snapshot(*state_->db);
  return read_results(*state_->db, filter);
}

std::vector<CellResult> Store::unfinished(const ResultFilter& filter) const {
  const std::lock_guard guard(state_->mutex);
  const Snapshot snapshot(*state_->db);
  return read_unfinished(*state_->db, filter);
}

std::vector<Cell> Store::unfinished() const {
  std::vector<Cell> cells;
  for (CellResult& one : unfinished(ResultFilter{})) cells.push_back(std::move(one.cell));
  return cells;
}

Store::Table Store::query(const std::string& sql, const std::function<void()>& check) const {
  // A connection of its own: the authoriser holds for all that a connection does.
  const std::unique_ptr<Database> db = open_database(state_->folder, Access::read_only);
  db->only_read();
  if (check) db->check_with(check);
  Statement rows = db->prepare(sql);
  Table table;
  for (int i = 0; i < rows.columns(); ++i) table.columns.push_back(rows.name(i));
  while (rows.step()) {
    auto& row = table.rows.emplace_back();
    auto& numbers = table.numbers.emplace_back();
    for (int i = 0; i < rows.columns(); ++i) {
      row.push_back(rows.value_text(i));
      numbers.push_back(rows.number(i));
    }
  }
  return table;
}

}  // namespace tarmac::scenarios
