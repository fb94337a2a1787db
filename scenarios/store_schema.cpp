#include "scenarios/store_schema.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <stdio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/error.h"
#include "scenarios/store_rows.h"

namespace tarmac::scenarios {
namespace {
namespace fs = std::filesystem;

constexpr std::int64_t kApplicationId = 0x5441524d;  // "TARM": what `file` shows, and no other program's database

constexpr const char* kTables = R"sql(
create table meta(name text primary key, value text not null) without rowid;
create table runs(
  id integer primary key, name text not null unique, host text not null, pid integer not null,
  pid_started integer not null, boot text not null, build text not null, started_at text not null, ended_at text,
  ended text);
create table events(
  id integer primary key, run integer not null, at text not null, what text not null, count integer not null,
  detail text not null);
create table cells(
  id integer primary key, key text not null unique, world text not null, block text not null, scenario text not null,
  case_name text not null, seed integer not null, estimator text not null);
create table parameters(
  cell integer not null, position integer not null, path text not null, value text not null,
  primary key(cell, position)) without rowid;
create index parameters_by_value on parameters(path, value, cell);
create table claims(cell integer primary key, run integer not null, at text not null);
create table outcomes(
  cell integer primary key, status text not null, message text not null, recording_hash text not null,
  wall_s real not null, cpu_s real not null, peak_memory_mb real not null, overhead_s real not null,
  folder text not null, command text not null, run integer not null, at text not null, metrics integer not null);
create index outcomes_by_status on outcomes(status);
create index outcomes_by_wall on outcomes(wall_s);
create index outcomes_without_metrics on outcomes(cell) where metrics = 0;
create table metric_names(
  id integer primary key, metric text not null, estimate text not null, unit text not null,
  deterministic integer not null, unique(metric, estimate, unit, deterministic));
create table metric_values(
  metric integer not null, cell integer not null, value real, ci_low real, ci_high real, status text not null,
  primary key(metric, cell)) without rowid;
)sql";

// A finished cell without any metric is a row with NULLs: it must not vanish from what is asked of its scenario.
constexpr const char* kViews = R"sql(
create view results as
select c.key as cell, c.scenario, c.case_name as "case", c.case_name, c.block, c.world, c.seed, c.estimator, o.status,
  o.message, o.wall_s, o.cpu_s, o.peak_memory_mb, n.metric, v.value, n.unit, v.ci_low, v.ci_high, n.estimate,
  v.status as metric_status
from metric_values v join metric_names n on n.id = v.metric join cells c on c.id = v.cell
  join outcomes o on o.cell = v.cell
union all
select c.key, c.scenario, c.case_name, c.case_name, c.block, c.world, c.seed, c.estimator, o.status, o.message,
  o.wall_s, o.cpu_s, o.peak_memory_mb, null, null, null, null, null, null, null
from outcomes o join cells c on c.id = o.cell where o.metrics = 0;
create view deterministic as
select c.key as cell, c.scenario, c.case_name as "case", c.case_name, c.block, c.world, c.seed, c.estimator, o.status,
  o.message, o.recording_hash, n.metric, v.value, n.unit, v.ci_low, v.ci_high, n.estimate, v.status as metric_status
from metric_values v join metric_names n on n.id = v.metric join cells c on c.id = v.cell
  join outcomes o on o.cell = v.cell where n.deterministic
union all
select c.key, c.scenario, c.case_name, c.case_name, c.block, c.world, c.seed, c.estimator, o.status, o.message,
  o.recording_hash, null, null, null, null, null, null, null
from outcomes o join cells c on c.id = o.cell where o.metrics = 0;
create view all_cells as
select c.key as cell, c.scenario, c.case_name as "case", c.case_name, c.block, c.world, c.seed, c.estimator,
  coalesce(o.status, case when l.cell is null then 'pending' else 'running' end) as status, o.message, o.wall_s,
  o.cpu_s, o.peak_memory_mb, o.overhead_s, o.folder, o.command, o.at as finished_at
from cells c left join outcomes o on o.cell = c.id left join claims l on l.cell = c.id;
)sql";

// What ANALYZE would find in a large sweep, written by hand: the planner's choices are then the same for every store,
// from its first cell on. Rows of the table, then rows per value of each prefix of the index.
constexpr const char* kStatistics = R"sql(
analyze sqlite_schema;
insert into sqlite_stat1(tbl, idx, stat) values
  ('cells', 'sqlite_autoindex_cells_1', '100000 1'),
  ('parameters', 'parameters', '200000 2 1'),
  ('parameters', 'parameters_by_value', '200000 20000 10000 1'),
  ('outcomes', 'outcomes_by_status', '100000 20000'),
  ('outcomes', 'outcomes_by_wall', '100000 1'),
  ('outcomes', 'outcomes_without_metrics', '1000 1'),
  ('metric_names', 'sqlite_autoindex_metric_names_1', '100 2 1 1 1'),
  ('metric_values', 'metric_values', '10000000 100000 1');
)sql";

constexpr std::array kNames = {"meta",     "runs",         "events",        "cells",   "parameters",    "claims",
                               "outcomes", "metric_names", "metric_values", "results", "deterministic", "all_cells"};

/// Steps to the current schema, in order: {from, "alter table …"}. A step is never changed once released.
constexpr std::span<const Migration> kMigrations = {};

void check_whole(Database& db) {
  for (const char* name : kNames) {
    if (db.integer("select count(*) from sqlite_schema where name = ?", {name}) != 0) continue;
    throw core::InputError(
        fmt::format("{}: the store has no table or view '{}': it is damaged or another program's; run the sweep again "
                    "into a new folder",
                    db.file().string(), name));
  }
}

void step(Database& db, const Migration& migration) {
  Transaction transaction(db);
  // Another process may have taken the step while this one waited.
  if (db.integer("pragma user_version") != migration.from) return;
  db.execute(migration.sql);
  db.execute(fmt::format("pragma user_version = {}", migration.from + 1));
  transaction.commit();
}

/// A copy of the store as it is, beside it; whole or absent.
void keep_copy(Database& db, const fs::path& copy) {
  if (fs::exists(copy)) return;
  const fs::path part = copy.string() + fmt::format(".part-{}", ::getpid());
  std::error_code ignored;
  fs::remove(part, ignored);
  db.run("vacuum into ?", {part.string()});
  fs::rename(part, copy);
}

void migrate(Database& db, int from, const fs::path& folder, const Schema& schema) {
  keep_copy(db, folder / fmt::format("store.sqlite.v{}", from));
  for (int version = from; version < schema.version; ++version) {
    const auto next = std::find_if(schema.migrations.begin(), schema.migrations.end(),
                                   [&](const Migration& migration) { return migration.from == version; });
    if (next == schema.migrations.end())
      throw std::logic_error(fmt::format("the store's schema has no step from version {}", version));
    step(db, *next);
  }
}

void check_version(Database& db, const fs::path& folder, Store::Access access, const Schema& schema) {
  if (db.integer("pragma application_id") != kApplicationId)
    throw core::InputError(
        fmt::format("{}: this is an SQLite file, but no store of a sweep; expected one that tarmac "
                    "sweep or merge wrote",
                    db.file().string()));
  const auto version = static_cast<int>(db.integer("pragma user_version"));
  if (version > schema.version)
    throw core::InputError(
        fmt::format("{}: the store has schema {}, this program knows {}; use the newer program that "
                    "wrote it, or run the sweep again into a new folder",
                    db.file().string(), version, schema.version));
  if (version == schema.version) return;
  if (access == Store::Access::read_only)
    throw core::InputError(
        fmt::format("{}: the store has the older schema {}, and this program reads {}; `tarmac sweep "
                    "-o {} --resume` brings it up to date (the file before is kept)",
                    db.file().string(), version, schema.version, folder.string()));
  migrate(db, version, folder, schema);
}

std::string meta(Database& db, const char* name) {
  Statement& statement = db.cached("select value from meta where name = ?").with({name});
  if (!statement.step())
    throw core::InputError(
        fmt::format("{}: the store does not say its {}: it is damaged; run the sweep again into a "
                    "new folder",
                    db.file().string(), name));
  std::string value = statement.text(0);
  statement.reset();
  return value;
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

Schema current_schema() {
  return {kStoreSchema, kMigrations};
}

fs::path store_file(const fs::path& folder) {
  return folder / "store.sqlite";
}

void no_store(const fs::path& folder) {
  throw core::InputError(
      fmt::format("{}: there is no store.sqlite; expected the folder of a sweep (tarmac sweep "
                  "SWEEP.yaml -o DIR makes one)",
                  folder.string()));
}

std::string now_text() {
  const auto now = std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto ms = now.time_since_epoch().count() % 1000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms);
}

void build_store(const fs::path& file, const StoreIdentity& identity, std::span<const Cell> cells) {
  Database db(file, Database::Mode::create);
  Transaction transaction(db);
  db.execute(kTables);
  db.execute(kViews);
  db.execute(kStatistics);
  const std::pair<const char*, std::string> meta[] = {{"sweep", identity.sweep},
                                                      {"plan_hash", identity.plan_hash},
                                                      {"build", identity.build},
                                                      {"created_at", now_text()}};
  for (const auto& [name, value] : meta) db.run("insert into meta values(?, ?)", {name, value});
  for (const Cell& cell : cells) insert_cell(db, cell);
  db.execute(fmt::format("pragma application_id = {}; pragma user_version = {}", kApplicationId, kStoreSchema));
  transaction.commit();
}

void place_store(const fs::path& built, const fs::path& folder) {
  const fs::path file = store_file(folder);
  int placed = ::renameat2(AT_FDCWD, built.c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE);
  // Some file systems do not know the flag.
  if (placed != 0 && errno == EINVAL && !fs::exists(file)) placed = std::rename(built.c_str(), file.c_str());
  if (placed != 0)
    throw core::InputError(fmt::format("{}: the new store cannot be put there ({}); is another process making it?",
                                       file.string(), std::strerror(errno)));
  sync_folder(folder);
}

std::unique_ptr<Database> open_database(const fs::path& folder, Store::Access access, const Schema& schema) {
  const fs::path file = store_file(folder);
  if (!fs::is_regular_file(file)) no_store(folder);
  auto db = std::make_unique<Database>(
      file, access == Store::Access::read_only ? Database::Mode::read_only : Database::Mode::read_write);
  check_version(*db, folder, access, schema);
  check_whole(*db);
  return db;
}

StoreIdentity read_identity(Database& db) {
  return {meta(db, "sweep"), meta(db, "plan_hash"), meta(db, "build")};
}

}  // namespace tarmac::scenarios
