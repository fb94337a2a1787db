/// A baseline: the values that a sweep's results are held to, in a text file whose diff can be reviewed: sorted, a line
/// a case, estimator and metric, with the values by seed.
///
///   format: 1
///   sweeps: [regression]
///   build: 0.1.0 (697e83c234a6)
///   recordings:
///     - {case: "brake", hashes: {1: e41a71348db3ed27, 2: 3d4a84bbd08a209c}}
///   values:
///     - {case: "brake", scenario: quick-brake, estimator: kiss-icp, estimate: causal, metric: rpe_1sweep_trans_rmse_m,
///     values: {1: 0.052539984170891018, 2: n/a}}
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "scenarios/cell.h"

namespace tarmac::scenarios {

struct BaselineKey {
  std::string case_name, estimator, metric;
  std::string estimate;  ///< causal | final
  auto operator<=>(const BaselineKey&) const = default;
};

struct Baseline {
  std::vector<std::string> sweeps;  ///< names, sorted
  std::string build;                ///< of the programs that the values come from
  std::map<std::string, std::map<std::uint64_t, std::string>> recordings;  ///< hash by case and seed
  std::map<std::string, std::string> scenario_of;                          ///< by case
  /// Values by seed; empty = n/a. A seed whose method said that it cannot start is not there.
  std::map<BaselineKey, std::map<std::uint64_t, std::optional<double>>> values;
  std::string file;  ///< where it was read from
};

/// Throws InputError (file, line, what was expected): not there, another format, a value that is no number.
Baseline load_baseline(const std::filesystem::path& file);
/// Sorted; doubles with 17 digits, so that they come back exactly.
std::string baseline_text(const Baseline& baseline);
/// Whole or not at all.
void save_baseline(const std::filesystem::path& file, const Baseline& baseline);

/// The values of those metrics. Throws InputError when a case, estimator and seed comes twice (two folders of one
/// sweep).
Baseline make_baseline(std::span<const CellResult> results, const std::vector<std::string>& metrics);

/// How two baselines differ, a line each, as `tarmac baseline update` prints it.
struct BaselineChange {
  enum class Kind { changed, added, gone };
  Kind kind = Kind::changed;
  BaselineKey key;
  std::optional<double> before, after;   ///< medians over seeds; empty: n/a on all of them
  std::optional<double> change_percent;  ///< of the median; where before is above 0
  std::size_t seeds_before = 0, seeds_after = 0;
};
struct BaselineDifference {
  std::vector<BaselineChange> changes;  ///< sorted by key
  std::size_t unchanged = 0;
  std::size_t recordings_changed = 0, recordings_shared = 0;
};
BaselineDifference difference_of(const Baseline& before, const Baseline& after);

/// Median of finite values, the mean of the middle two of an even number; empty when there are none.
std::optional<double> median_of(std::vector<double> values);
std::vector<double> numbers_of(const std::map<std::uint64_t, std::optional<double>>& values);

}  // namespace tarmac::scenarios
