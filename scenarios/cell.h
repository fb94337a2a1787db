/// The cells of a sweep and what became of them: plain data that the sweep file, the store, the gate and the comparison
/// share.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace tarmac::scenarios {

/// One estimator on one drive. All of it is decided before it runs.
struct Cell {
  std::string key;        ///< 16 hex digits over all that decides the result but build and limits
  std::string world;      ///< key of the drive: cells of one world share a recording
  std::string block;      ///< name of the sweep file's block
  std::string scenario;   ///< name
  std::string case_name;  ///< what is the same over seeds: the block's name and the parameters, "brake motion.peak=3"
  std::uint64_t seed = 0;
  std::string estimator;
  std::vector<Override> parameters;  ///< varied and drawn ones, in the file's order: dotted path and YAML text
};

/// Every way in which a cell ends; docs/store.md says the same.
inline constexpr std::array<const char*, 11> kOutcomeStatuses = {
    "ok",        "not_initialised", "failed",        "crashed",    "timed_out", "out_of_memory",
    "no_output", "bad_output",      "not_simulated", "not_scored", "killed"};

/// What became of a cell. The second group differs from run to run.
struct CellOutcome {
  /// One of kOutcomeStatuses. All but `killed` are an answer; that is somebody else's SIGKILL, and run again by
  /// --resume.
  std::string status = "ok";
  std::string message;
  std::string recording_hash;  ///< empty: there was no recording

  double wall_s = 0, cpu_s = 0, peak_memory_mb = 0;  ///< of the estimator's process
  double overhead_s = 0;  ///< wall time of the cell outside of simulating, estimating and scoring
  std::string folder;     ///< its files, relative to the store's folder
  std::string command;    ///< runs this cell alone
  /// A method that says that it cannot start is an answer, not a failure.
  bool failed() const { return status != "ok" && status != "not_initialised"; }
};

/// A row of an evaluation.
struct MetricValue {
  std::string estimate = "causal";  ///< causal or final
  std::string metric;               ///< carries its unit: ate_se3_rmse_m
  std::optional<double> value;      ///< empty = n/a
  std::string unit;
  std::optional<double> ci_low, ci_high;
  std::string status = "ok";  ///< ok | n/a: reason | ...
  bool deterministic = true;  ///< false: a cost, different from run to run
};

struct CellResult {
  Cell cell;
  CellOutcome outcome;
  std::vector<MetricValue> metrics;
};

/// Of the estimates that a cell has rows of for one metric, the headline is the one with the lowest rank: causal, be it
/// n/a, and final only where there is no causal row. Whoever shows or judges one value a cell goes by this.
int headline_rank(const std::string& estimate);

/// The headline row of a metric; with `estimate`, the row of that one. nullptr: no such row.
const MetricValue* find_value(const CellResult& result, const std::string& metric, const std::string& estimate = "");

}  // namespace tarmac::scenarios
