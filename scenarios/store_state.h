/// What stands behind Store. Private to scenarios/.
#pragma once

#include <mutex>

#include "scenarios/sqlite.h"
#include "scenarios/store.h"
#include "scenarios/store_rows.h"
#include "scenarios/writer_lock.h"

namespace tarmac::scenarios {

struct Store::State {
  std::filesystem::path folder;
  StoreIdentity identity;
  std::int64_t opened_by = 0;  ///< process; SQLite's connections do not survive a fork
  mutable std::mutex mutex;    ///< around the connection
  std::unique_ptr<Database> db;

  // After start():
  std::unique_ptr<WriterLock> lock;
  std::int64_t run = 0;
  MetricNames metric_names;

  std::filesystem::path work() const { return folder / "work"; }
  /// Throws std::logic_error before start().
  void require_started() const;
  /// Inside a transaction.
  bool claim(const std::string& key);
  void finish(const std::string& key, const CellOutcome& outcome, std::span<const MetricValue> metrics);
  void end_run();
};

}  // namespace tarmac::scenarios
