/// Runs of two folders in pairs: rows, what could not be paired, and whether the recordings are the same. No files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reports/compare.h"
#include "tools/compare/folder.h"

namespace tarmac::tools {

/// Which runs belong together.
struct PairingRule {
  std::string estimator_a, estimator_b;  ///< both empty: each estimator with the one of its name
  std::vector<std::string> metrics;      ///< empty: all
};

/// One method on one case, with the seeds on which both sides have a result.
struct PairedRuns {
  std::string case_name, estimator_a, estimator_b;
  std::vector<std::uint64_t> seeds;
  std::vector<const ComparedRun*> a, b;  ///< one a seed
};

struct Pairing {
  std::vector<PairedRuns> pairs;  ///< in order of case and estimator
  std::vector<reports::CompareRow> rows;
  std::vector<reports::CompareMissing> missing;
  std::size_t same_recordings = 0, different_recordings = 0, unknown_recordings = 0;
  std::vector<std::string> different;  ///< "stand-turn seed 3"
};

/// Pairs by (case, estimator, metric) over seeds; every row is judged together with all others by Holm's rule, costs
/// apart. Throws InputError when the two have nothing in common, saying what there is.
Pairing pair_runs(const ComparedFolder& a, const ComparedFolder& b, const PairingRule& rule);

/// "1..5", "1, 3, 7..9".
std::string seed_list(std::vector<std::uint64_t> seeds);

}  // namespace tarmac::tools
