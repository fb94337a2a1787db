// Stores of shards as one.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/store_rows.h"
#include "scenarios/store_schema.h"
#include "scenarios/writer_lock.h"

namespace tarmac::scenarios {
namespace {
namespace fs = std::filesystem;

/// Cells whose results are in memory at once.
constexpr std::size_t kChunk = 500;

struct Source {
  fs::path folder;
  std::unique_ptr<Database> db;
};

std::vector<Source> open_sources(std::span<const fs::path> folders) {
  std::vector<Source> sources;
  for (const fs::path& folder : folders) sources.push_back({folder, open_database(folder, Store::Access::read_only)});
  return sources;
}

/// The identity that all have.
StoreIdentity common_identity(const std::vector<Source>& sources) {
  const StoreIdentity first = read_identity(*sources[0].db);
  for (const Source& source : sources) {
    const StoreIdentity other = read_identity(*source.db);
    const std::tuple<const char*, const std::string&, const std::string&> parts[] = {
        {"sweep", first.sweep, other.sweep},
        {"plan", first.plan_hash, other.plan_hash},
        {"build", first.build, other.build}};
    for (const auto& [what, a, b] : parts) {
      if (a == b) continue;
      throw core::InputError(fmt::format(
          "merge: {} and {} are not of the same {} ('{}' and '{}'); expected shards of one sweep, run by one "
          "build: to set two builds side by side, use tarmac compare",
          sources[0].folder.string(), source.folder.string(), what, a, b));
    }
  }
  return first;
}

[[noreturn]] void conflict(const CellResult& first, const Source& source, const std::string& column,
                           const std::string& a, const std::string& b) {
  throw core::InputError(
      fmt::format("merge: cell {} ({}, {}, seed {}): {} is '{}' in {} and '{}' in a store before it; a cell gives the "
                  "same wherever "
                  "it runs: look for other builds, libraries or processors",
                  first.cell.key, first.cell.case_name, first.cell.estimator, first.cell.seed, column, b,
                  source.folder.string(), a));
}

std::string text(const std::optional<double>& value) {
  return value ? fmt::format("{:.17g}", *value) : "n/a";
}

/// Deterministic metrics by name and estimate, as "column" -> "value".
std::map<std::string, std::string> columns_of(const CellResult& result) {
  std::map<std::string, std::string> columns = {{"status", result.outcome.status},
                                                {"message", result.outcome.message},
                                                {"recording_hash", result.outcome.recording_hash}};
  for (const MetricValue& m : result.metrics) {
    if (!m.deterministic) continue;
    const std::string name = fmt::format("{} ({})", m.metric, m.estimate);
    columns[name + ", value"] = text(m.value);
    columns[name + ", unit"] = m.unit;
    columns[name + ", ci_low"] = text(m.ci_low);
    columns[name + ", ci_high"] = text(m.ci_high);
    columns[name + ", status"] = m.status;
  }
  return columns;
}

void check_same_result(const CellResult& first, const CellResult& second, const Source& source) {
  const auto a = columns_of(first), b = columns_of(second);
  for (const auto& [column, value] : a) {
    const auto other = b.find(column);
    if (other == b.end()) conflict(first, source, column, value, "absent");
    if (other->second != value) conflict(first, source, column, value, other->second);
  }
  for (const auto& [column, value] : b) {
    if (!a.contains(column)) conflict(first, source, column, "absent", value);
  }
}

void check_same_plan(const Cell& a, const Cell& b, const Source& source) {
  if (std::tie(a.world, a.block, a.scenario, a.case_name, a.seed, a.estimator, a.parameters) ==
      std::tie(b.world, b.block, b.scenario, b.case_name, b.seed, b.estimator, b.parameters))
    return;
  throw core::InputError(
      fmt::format("merge: cell {} is '{}, {}, seed {}' in {} and '{}, {}, seed {}' in a store before "
                  "it; expected shards of one sweep",
                  a.key, b.case_name, b.estimator, b.seed, source.folder.string(), a.case_name, a.estimator, a.seed));
}

class Merge {
 public:
  explicit Merge(Database& to) : to_(to) {}

  void add_cells(const Source& source) {
    for (const Cell& cell : read_cells(*source.db)) {
      const auto [entry, added] = cells_.try_emplace(cell.key, cell);
      if (added) {
        insert_cell(to_, cell);
      } else {
        check_same_plan(entry->second, cell, source);
      }
    }
  }

  void add_results(const Source& source) {
    const std::map<std::int64_t, std::int64_t> runs = add_runs(*source.db);
    std::vector<std::string> keys;
    Statement rows = source.db->prepare(
        "select key from cells join outcomes on cell = id where status <> 'killed' "
        "order by id");
    bool more = true;
    while (more) {
      more = rows.step();
      if (more) keys.push_back(rows.text(0));
      if (more && keys.size() < kChunk) continue;
      add_chunk(source, keys, runs);
      keys.clear();
    }
  }

  /// The folders of finished cells, and whose they are.
  const std::vector<std::pair<const Source*, std::string>>& folders() const { return folders_; }
  std::size_t finished() const { return finished_.size(); }

 private:
  void add_chunk(const Source& source, const std::vector<std::string>& keys,
                 const std::map<std::int64_t, std::int64_t>& runs) {
    if (keys.empty()) return;
    ResultFilter filter;
    filter.keys = keys;
    for (const CellResult& result : read_results(*source.db, filter)) {
      if (!finished_.insert(result.cell.key).second) {
        ResultFilter one;
        one.keys = {result.cell.key};
        check_same_result(read_results(to_, one).at(0), result, source);
        continue;
      }
      const std::int64_t run = source.db->integer(
          "select run from outcomes where cell = (select id from cells where key = ?)", {result.cell.key});
      insert_outcome(to_, names_, runs.at(run), to_.integer("select id from cells where key = ?", {result.cell.key}),
                     result.outcome, result.metrics);
      if (!result.outcome.folder.empty()) folders_.emplace_back(&source, result.outcome.folder);
    }
  }

  /// The source's writers; their numbers there and here.
  std::map<std::int64_t, std::int64_t> add_runs(Database& from) {
    std::map<std::int64_t, std::int64_t> numbers;
    Statement runs = from.prepare(
        "select id, name, host, pid, pid_started, boot, build, started_at, ended_at, ended from runs order by id");
    while (runs.step()) {
      const std::string name = runs.text(1), host = runs.text(2), boot = runs.text(5), build = runs.text(6);
      const std::string started = runs.text(7), ended_at = runs.null(8) ? now_text() : runs.text(8);
      const std::string ended = runs.null(9) ? "elsewhere" : runs.text(9);
      to_.run(
          "insert or ignore into runs(name, host, pid, pid_started, boot, build, started_at, ended_at, ended) "
          "values(?, ?, ?, ?, ?, ?, ?, ?, ?)",
          {name, host, runs.integer(3), runs.integer(4), boot, build, started, ended_at, ended});
      const bool added = to_.changes() == 1;
      numbers[runs.integer(0)] = to_.integer("select id from runs where name = ?", {name});
      if (added) add_events(from, runs.integer(0), numbers[runs.integer(0)]);
    }
    return numbers;
  }

  void add_events(Database& from, std::int64_t run_there, std::int64_t run_here) {
    Statement& events =
        from.cached("select at, what, count, detail from events where run = ? order by id").with({run_there});
    while (events.step())
      to_.run("insert into events(run, at, what, count, detail) values(?, ?, ?, ?, ?)",
              {run_here, events.text(0), events.text(1), events.integer(2), events.text(3)});
  }

  Database& to_;
  MetricNames names_;
  std::unordered_map<std::string, Cell> cells_;
  std::unordered_set<std::string> finished_;
  std::vector<std::pair<const Source*, std::string>> folders_;
};

/// The same files under another folder: hard links where both are on one file system, copies elsewhere.
void link_tree(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
    const fs::path target = to / fs::relative(entry.path(), from);
    if (entry.is_symlink()) {
      fs::copy_symlink(entry.path(), target);
    } else if (entry.is_directory()) {
      fs::create_directories(target);
    } else {
      std::error_code error;
      fs::create_hard_link(entry.path(), target, error);
      if (error) fs::copy_file(entry.path(), target);
    }
  }
}

/// Puts a cell's folder in place whole.
void place_files(const Source& source, const std::string& folder, const fs::path& work, const fs::path& to) {
  const fs::path relative = fs::path(folder).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..")
    throw core::InputError(fmt::format("merge: {} names the cell folder '{}', which is not inside it: it is damaged",
                                       store_file(source.folder).string(), folder));
  if (!fs::is_directory(source.folder / relative))
    throw core::InputError(
        fmt::format("merge: {}: the files of a finished cell are missing; put them back, or run the "
                    "shard again",
                    (source.folder / relative).string()));
  const fs::path part = work / "cell";
  fs::remove_all(part);
  link_tree(source.folder / relative, part);
  fs::remove_all(to / relative);  // of a merge that was ended
  fs::create_directories((to / relative).parent_path());
  fs::rename(part, to / relative);
}

}  // namespace

std::size_t merge_stores(std::span<const fs::path> from, const fs::path& to) {
  if (from.empty()) throw core::InputError("merge: no store was named; expected the folders of a sweep's shards");
  if (fs::exists(store_file(to)))
    throw core::InputError(fmt::format("{}: there is a store already; merge into a new folder", to.string()));
  const std::vector<Source> sources = open_sources(from);
  const StoreIdentity identity = common_identity(sources);
  std::vector<std::unique_ptr<Snapshot>> snapshots;  // shards may still be running
  for (const Source& source : sources) snapshots.push_back(std::make_unique<Snapshot>(*source.db));

  const WriterLock lock(to / "work");
  const fs::path built = lock.folder() / "store.sqlite";
  build_store(built, identity, {});
  std::size_t finished = 0;
  try {
    Database db(built, Database::Mode::read_write);
    Transaction transaction(db);
    Merge merge(db);
    for (const Source& source : sources) merge.add_cells(source);
    for (const Source& source : sources) merge.add_results(source);
    transaction.commit();
    // Only now that nothing contradicts: files, and the store last, so that a merge that is ended has made none.
    for (const auto& [source, folder] : merge.folders()) place_files(*source, folder, lock.folder(), to);
    finished = merge.finished();
  } catch (const fs::filesystem_error& error) {
    throw core::InputError(
        fmt::format("merge: {}; check that {} may be written to and has room", error.what(), to.string()));
  }
  core::write_file(to / "sweep.yaml", core::read_file(from[0] / "sweep.yaml"));
  place_store(built, to);
  return finished;
}

}  // namespace tarmac::scenarios
