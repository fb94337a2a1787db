/// The store of a sweep: an SQLite index (store.sqlite, WAL) beside the cells' files. Several processes of one machine
/// may write at once; ending any of them at any moment loses at most the cells that it was running. SQLite stays behind
/// this header.
///
///   DIR/store.sqlite    meta, runs, cells, parameters, metrics; views `results` and `deterministic`
///   DIR/sweep.yaml      the sweep file as it was given
///   DIR/cells/<key>/    the files of a finished cell, put in place whole
///   DIR/work/           of cells that are running; what a killed run left there is removed by the next
///   DIR/recordings/     the cache, unless it lies elsewhere
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenarios/cell.h"

namespace tarmac::scenarios {

inline constexpr int kStoreSchema = 1;

/// The disk is full, or fails: nothing of what was being written is in the store, all that was there before is, and the
/// store can be used on once there is room.
class StoreFull : public core::InputError {
 public:
  using InputError::InputError;
};

/// What a store was made of and by; two stores can be merged when all of it is the same.
struct StoreIdentity {
  std::string sweep;      ///< name
  std::string plan_hash;  ///< over the keys of all cells of the whole sweep, whatever the shard
  std::string build;      ///< of the programs: cells of two builds do not mix
};

/// What StoreIdentity::plan_hash is: over the keys of all cells, in any order.
std::string plan_hash_of(std::vector<std::string> keys);

/// What a start found and did: said to the user.
struct StoreStart {
  std::size_t done = 0, failed = 0, pending = 0;
  std::size_t running_elsewhere = 0;  ///< claimed by a process that is alive
  std::size_t released = 0;           ///< claimed by processes that are gone: to be run again
  std::size_t killed = 0;             ///< ended by somebody's SIGKILL: to be run again
  std::size_t rerun = 0;              ///< failed, and to be run again because --rerun-failed said so
};

/// Selects cells; empty fields select all.
struct ResultFilter {
  std::vector<std::string> scenarios, cases, estimators, statuses, keys;
  std::vector<std::uint64_t> seeds;
  std::vector<Override> parameters;  ///< path and value, all of them must match
  std::vector<std::string> metrics;  ///< those to load; empty: all. Cells without them are there all the same
};

/// Cells that have the same values in some columns.
struct CellGroup {
  std::vector<std::string> by;                  ///< those values
  std::map<std::string, std::size_t> statuses;  ///< cells by status; `pending` and `running` are among them
  struct Metric {
    std::vector<double> values;  ///< of the cells that have one, in order of insertion
    std::string unit;
    std::string missing;  ///< why one has none: "n/a: …"
  };
  std::vector<Metric> metrics;  ///< in the order asked for
};

class Store {
 public:
  /// Makes the folder and an empty store with all cells pending. Throws InputError when there is one already.
  static Store create(const std::filesystem::path& folder, const StoreIdentity& identity, const std::string& sweep_text,
                      std::span<const Cell> cells);
  enum class Access { read_only, read_write };
  /// Throws InputError: no store, a newer schema, a damaged file. An older schema is migrated when written to (the file
  /// before is kept as store.sqlite.v<N>), and refused when read only, with the command that migrates it.
  static Store open(const std::filesystem::path& folder, Access access);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  const StoreIdentity& identity() const;
  /// False: a shard's store. Its cells are not all that the sweep has, so nothing can be said about the sweep by it.
  bool holds_whole_plan() const;
  const std::filesystem::path& folder() const;

  /// Registers this process as a writer, takes back what dead ones had claimed and what was killed, and (with
  /// rerun_failed) what failed; removes what dead ones left below work/.
  StoreStart start(bool rerun_failed);
  /// This process's folder below work/, for files that are not whole yet; after start().
  std::filesystem::path work_folder() const;

  /// True: the cell was pending and is this process's now. May be called from several threads, like the three below.
  bool claim(const std::string& key);
  /// Gives a claimed cell back, unfinished.
  void release(const std::string& key);
  /// Records a claimed cell's outcome and metrics, in one transaction.
  void finish(const std::string& key, const CellOutcome& outcome, std::span<const MetricValue> metrics);
  /// The same of many, in one transaction: for results that come in bulk. Cells that are pending are claimed by it.
  void finish(std::span<const CellResult> results);
  /// Cells that are pending, in order of insertion.
  std::vector<std::string> pending() const;

  /// Finished cells, in order of case, estimator, seed; with the metrics that the filter names.
  std::vector<CellResult> results(const ResultFilter& filter) const;
  /// Cells that are not finished, in order of insertion.
  std::vector<Cell> unfinished() const;
  /// Those that match, with the status `pending` or `running`.
  std::vector<CellResult> unfinished(const ResultFilter& filter) const;

  /// All cells that match, finished or not, by columns (case, estimator, scenario, block, seed, world, status), sorted
  /// by them; with the values of the metrics that the filter names, of the causal estimate where there is one. Throws
  /// InputError for another column.
  std::vector<CellGroup> groups(const ResultFilter& filter, const std::vector<std::string>& by) const;
  /// The values that stand in one of those columns; or, of `metric` and `parameter`, the names that there are.
  std::vector<std::string> distinct(const std::string& column) const;

  struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::optional<std::string>>> rows;  ///< empty = NULL
    std::vector<std::vector<bool>> numbers;                     ///< whether a value is a number
  };
  /// A statement that only reads (SQLite's authoriser holds it to that); throws InputError with SQLite's message.
  /// `check` is called now and then meanwhile: what it throws ends the statement.
  Table query(const std::string& sql, const std::function<void()>& check = {}) const;
  /// The deterministic columns of all cells and metrics, sorted: equal stores give equal bytes (numbers with 17
  /// digits).
  void dump(std::ostream& out) const;

 private:
  Store();
  struct State;
  std::unique_ptr<State> state_;
};

/// Stores of shards, of the same sweep and build, as one in a new folder: the cells' files are linked or copied. A cell
/// finished in several must have the same deterministic columns in all (else InputError). Cells finished nowhere are
/// pending. A shard that was forgotten is no error: holds_whole_plan() of the result is false then. Returns the number
/// of finished cells.
std::size_t merge_stores(std::span<const std::filesystem::path> from, const std::filesystem::path& to);

}  // namespace tarmac::scenarios
