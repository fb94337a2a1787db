// The deterministic columns as text.
#include <fmt/format.h>

#include "scenarios/store_schema.h"
#include "scenarios/store_state.h"

namespace tarmac::scenarios {
namespace {

/// One line stays one line, one field one field.
std::string field(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\t':
        out += "\\t";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\\':
        out += "\\\\";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.17g}", *value) : "n/a";
}

std::string parameters(Database& db, std::int64_t cell) {
  Statement& rows = db.cached("select path, value from parameters where cell = ? order by position").with({cell});
  std::string text;
  while (rows.step()) text += fmt::format("{}{}={}", text.empty() ? "" : " ", field(rows.text(0)), field(rows.text(1)));
  return text;
}

/// A cell's line; columns as in dump().
void write_cell(Database& db, std::ostream& out, const Statement& row) {
  std::string line = "cell";
  for (int i = 1; i < row.columns(); ++i) line += "\t" + field(row.text(i));
  out << line << '\t' << parameters(db, row.integer(0)) << '\n';
}

struct Name {
  std::int64_t id;
  std::string start;  ///< of a line: estimate and metric
  std::string unit;
};

std::vector<Name> names(Database& db) {
  Statement& rows = db.cached(
      "select id, estimate, metric, unit from metric_names where deterministic order by metric, estimate, unit");
  std::vector<Name> all;
  while (rows.step())
    all.push_back({rows.integer(0), fmt::format("{}\t{}", field(rows.text(1)), field(rows.text(2))), rows.text(3)});
  return all;
}

void write_metrics(Database& db, std::ostream& out, std::int64_t cell, const std::string& key,
                   const std::vector<Name>& metrics) {
  Statement& row = db.cached("select value, ci_low, ci_high, status from metric_values where metric = ? and cell = ?");
  for (const Name& name : metrics) {
    row.reset();
    if (!row.with({name.id, cell}).step()) continue;
    out << fmt::format("metric\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", key, name.start, number(row.optional_real(0)),
                       field(name.unit), number(row.optional_real(1)), number(row.optional_real(2)),
                       field(row.text(3)));
  }
  row.reset();
}

}  // namespace

void Store::dump(std::ostream& out) const {
  const std::lock_guard guard(state_->mutex);
  Database& db = *state_->db;
  const Snapshot snapshot(db);
  const std::vector<Name> metrics = names(db);
  out << "# cell\tkey\tcase\testimator\tseed\tblock\tscenario\tworld\tstatus\tmessage\trecording_hash\tparameters\n"
         "# metric\tkey\testimate\tmetric\tvalue\tunit\tci_low\tci_high\tstatus\n";
  Statement& cells = db.cached(
      "select c.id, c.key, c.case_name, c.estimator, c.seed, c.block, c.scenario, c.world, "
      "coalesce(o.status, 'pending'), coalesce(o.message, ''), coalesce(o.recording_hash, '') "
      "from cells c left join outcomes o on o.cell = c.id order by c.case_name, c.estimator, c.seed, c.key");
  while (cells.step()) {
    write_cell(db, out, cells);
    write_metrics(db, out, cells.integer(0), cells.text(1), metrics);
  }
}

}  // namespace tarmac::scenarios
