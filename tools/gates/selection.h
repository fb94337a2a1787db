/// Which cells a gate's row is about, and what of them can be used.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/gates/judge.h"

namespace tarmac::tools {

/// One row after its patterns are resolved.
struct GateTarget {
  const scenarios::GateRow* row = nullptr;
  std::string case_name, estimator, metric;
  std::string missing;  ///< not empty: an entry of the row's lists that selects nothing; then the names are patterns
};

/// Of a case and an estimator, by seed.
struct TargetCells {
  std::map<std::uint64_t, const scenarios::CellResult*> finished;
  std::map<std::uint64_t, const scenarios::Cell*> unfinished;
};

class CellIndex {
 public:
  explicit CellIndex(const GateInput& input);

  /// Case by case, estimator by estimator, metric by metric; also what is in the baseline and in the sweep no more.
  std::vector<GateTarget> targets_of(const scenarios::GateRow& row) const;
  const TargetCells& cells_of(const std::string& case_name, const std::string& estimator) const;

 private:
  struct Pair {
    std::string scenario;
    TargetCells cells;
  };
  const GateInput& input_;
  std::map<std::pair<std::string, std::string>, Pair> pairs_;  ///< by case and estimator
};

/// The estimate that a target's values are of, on both sides: the row's, or the headline of the runs and the baseline
/// together (a bound looks at the runs alone). So a causal estimate that is lost is n/a, and is not replaced by the
/// final one.
std::string estimate_of(const GateInput& input, const GateTarget& target, const TargetCells& cells);

/// Values by seed: empty = n/a.
using SeedValues = std::map<std::uint64_t, std::optional<double>>;

/// What the runs of a target say before any value is looked at.
struct TargetValues {
  SeedValues values;  ///< of runs that are ok
  std::string unit;
  std::vector<std::string> troubles;  ///< why the row fails whatever its values: "seed 3: crashed: ..."
  std::vector<std::string> evidence;  ///< logs and commands of those runs
  std::set<std::uint64_t> allowed;    ///< seeds left out because the row allows their outcome
};
TargetValues values_of(const GateInput& input, const GateTarget& target, const TargetCells& cells,
                       const std::string& estimate);

/// The baseline's values of a target; nullptr: it has none.
const SeedValues* baseline_of(const GateInput& input, const GateTarget& target, const std::string& estimate);

}  // namespace tarmac::tools
