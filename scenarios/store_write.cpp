// What writers do: register, claim, finish.
#include <fmt/format.h>

#include <stdexcept>

#include "core/error.h"
#include "scenarios/store_schema.h"
#include "scenarios/store_state.h"

namespace tarmac::scenarios {
namespace {
namespace fs = std::filesystem;

std::vector<std::string> texts(Statement& statement) {
  std::vector<std::string> all;
  while (statement.step()) all.push_back(statement.text(0));
  return all;
}

bool is_failure(const std::string& status) {
  CellOutcome outcome;
  outcome.status = status;
  return outcome.failed();
}

/// Cells as start() takes them back: they belong to this run until their files are gone, so that nobody runs them
/// meanwhile.
struct TakenBack {
  std::vector<std::string> released, killed, rerun;
};

std::vector<std::string> take_claims_of_the_dead(Database& db, std::int64_t run, const fs::path& work) {
  std::vector<std::pair<std::int64_t, std::string>> open;
  Statement& runs = db.cached("select id, name from runs where ended_at is null and id <> ?").with({run});
  while (runs.step()) open.emplace_back(runs.integer(0), runs.text(1));
  std::vector<std::string> keys;
  for (const auto& [id, name] : open) {
    if (WriterLock::alive(work, name)) continue;
    for (std::string& key :
         texts(db.cached("select key from cells join claims on cell = id where run = ? order by id").with({id})))
      keys.push_back(std::move(key));
    db.run("update claims set run = ? where run = ?", {run, id});
    db.run("update runs set ended_at = ?, ended = 'gone' where id = ?", {now_text(), id});
  }
  return keys;
}

/// The outcomes of that status are forgotten.
std::vector<std::string> take_finished(Database& db, std::int64_t run, const std::string& status) {
  std::vector<std::string> keys =
      texts(db.cached("select key from cells join outcomes on cell = id where status = ? order by id").with({status}));
  const std::string now = now_text();
  db.run("insert into claims(cell, run, at) select cell, ?, ? from outcomes where status = ?", {run, now, status});
  db.run(
      "delete from metric_values where metric in (select id from metric_names) and cell in "
      "(select cell from outcomes where status = ? and metrics > 0)",
      {status});
  db.run("delete from outcomes where status = ?", {status});
  return keys;
}

TakenBack take_back(Database& db, std::int64_t run, const fs::path& work, bool rerun_failed) {
  TakenBack taken;
  taken.released = take_claims_of_the_dead(db, run, work);
  taken.killed = take_finished(db, run, "killed");
  if (!rerun_failed) return taken;
  for (const std::string& status : texts(db.cached("select distinct status from outcomes"))) {
    if (!is_failure(status)) continue;
    for (std::string& key : take_finished(db, run, status)) taken.rerun.push_back(std::move(key));
  }
  return taken;
}

void record(Database& db, std::int64_t run, const char* what, const std::vector<std::string>& keys) {
  constexpr std::size_t kNamed = 20;
  if (keys.empty()) return;
  std::string detail;
  for (std::size_t i = 0; i < std::min(keys.size(), kNamed); ++i) detail += (i == 0 ? "" : " ") + keys[i];
  if (keys.size() > kNamed) detail += fmt::format(" and {} more", keys.size() - kNamed);
  db.run("insert into events(run, at, what, count, detail) values(?, ?, ?, ?, ?)",
         {run, now_text(), what, keys.size(), detail});
}

/// What their runs had put in place, whole or not, belongs to no finished cell any more.
void remove_files(const fs::path& folder, const TakenBack& taken) {
  for (const auto* keys : {&taken.released, &taken.killed, &taken.rerun}) {
    for (const std::string& key : *keys) {
      std::error_code error;
      fs::remove_all(folder / "cells" / key, error);
      if (error)
        throw core::InputError(
            fmt::format("{}: files of a cell that is to be run again cannot be removed ({}); remove "
                        "them by hand",
                        (folder / "cells" / key).string(), error.message()));
    }
  }
}

StoreStart counts(Database& db, std::int64_t run) {
  StoreStart start;
  Statement& statuses = db.cached("select status, count(*) from outcomes group by status");
  while (statuses.step()) {
    auto& count = is_failure(statuses.text(0)) ? start.failed : start.done;
    count += static_cast<std::size_t>(statuses.integer(1));
  }
  start.running_elsewhere = static_cast<std::size_t>(db.integer("select count(*) from claims where run <> ?", {run}));
  start.pending = static_cast<std::size_t>(db.integer("select count(*) from cells")) - start.done - start.failed -
                  start.running_elsewhere;
  return start;
}

}  // namespace

void Store::State::require_started() const {
  if (run == 0) throw std::logic_error("Store: start() comes before claiming and finishing cells");
}

StoreStart Store::start(bool rerun_failed) {
  State& s = *state_;
  const std::lock_guard guard(s.mutex);
  if (s.run != 0) throw std::logic_error("Store::start: this store was started already");
  auto lock = std::make_unique<WriterLock>(s.work());
  const ProcessIdentity process = this_process();
  TakenBack taken;
  std::int64_t run = 0;
  {
    Transaction transaction(*s.db);
    s.db->run(
        "insert into runs(name, host, pid, pid_started, boot, build, started_at) values(?, ?, ?, ?, ?, ?, ?)",
        {lock->name(), process.host, process.pid, process.started_ticks, process.boot, s.identity.build, now_text()});
    run = s.db->last_id();
    taken = take_back(*s.db, run, s.work(), rerun_failed);
    record(*s.db, run, "released", taken.released);
    record(*s.db, run, "killed", taken.killed);
    record(*s.db, run, "rerun", taken.rerun);
    transaction.commit();
  }
  s.lock = std::move(lock);
  s.run = run;
  remove_files(s.folder, taken);
  WriterLock::remove_dead(s.work());
  Transaction transaction(*s.db);
  s.db->run("delete from claims where run = ?", {run});
  StoreStart start = counts(*s.db, run);
  transaction.commit();
  start.released = taken.released.size();
  start.killed = taken.killed.size();
  start.rerun = taken.rerun.size();
  return start;
}

void Store::State::end_run() {
  if (run == 0) return;
  try {
    Transaction transaction(*db);
    db->run("delete from claims where run = ?", {run});
    db->run("update runs set ended_at = ?, ended = 'finished' where id = ?", {now_text(), run});
    transaction.commit();
  } catch (const std::exception&) {
    // The next start finds the lock lifted and does it.
  }
}

fs::path Store::work_folder() const {
  state_->require_started();
  return state_->lock->folder();
}

bool Store::State::claim(const std::string& key) {
  const std::string now = now_text();
  db->run(
      "insert or ignore into claims(cell, run, at) select id, ?, ? from cells c where key = ? and not exists "
      "(select 1 from outcomes o where o.cell = c.id)",
      {run, now, key});
  return db->changes() == 1;
}

bool Store::claim(const std::string& key) {
  State& s = *state_;
  const std::lock_guard guard(s.mutex);
  s.require_started();
  if (s.claim(key)) return true;
  if (s.db->integer("select count(*) from cells where key = ?", {key}) == 0)
    throw std::logic_error(fmt::format("Store::claim: there is no cell {}", key));
  return false;
}

void Store::release(const std::string& key) {
  State& s = *state_;
  const std::lock_guard guard(s.mutex);
  s.require_started();
  s.db->run("delete from claims where run = ? and cell = (select id from cells where key = ?)", {s.run, key});
  if (s.db->changes() != 1)
    throw std::logic_error(fmt::format("Store::release: cell {} is not claimed by this process", key));
}

void Store::State::finish(const std::string& key, const CellOutcome& outcome, std::span<const MetricValue> metrics) {
  const std::int64_t cell =
      db->integer("select id from cells join claims on cell = id where key = ? and run = ?", {key, run});
  if (cell == 0) throw std::logic_error(fmt::format("Store::finish: cell {} is not claimed by this process", key));
  insert_outcome(*db, metric_names, run, cell, outcome, metrics);
  db->run("delete from claims where cell = ?", {cell});
}

void Store::finish(const std::string& key, const CellOutcome& outcome, std::span<const MetricValue> metrics) {
  State& s = *state_;
  const std::lock_guard guard(s.mutex);
  s.require_started();
  try {
    Transaction transaction(*s.db);
    s.finish(key, outcome, metrics);
    transaction.commit();
  } catch (...) {
    s.metric_names.clear();  // some may have been rolled back
    throw;
  }
}

void Store::finish(std::span<const CellResult> results) {
  State& s = *state_;
  const std::lock_guard guard(s.mutex);
  s.require_started();
  try {
    Transaction transaction(*s.db);
    for (const CellResult& result : results) {
      s.claim(result.cell.key);
      s.finish(result.cell.key, result.outcome, result.metrics);
    }
    transaction.commit();
  } catch (...) {
    s.metric_names.clear();
    throw;
  }
}

}  // namespace tarmac::scenarios
