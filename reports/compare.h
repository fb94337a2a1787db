/// What `tarmac compare` shows, as plain data: page and Markdown are made from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "metrics/compare.h"
#include "metrics/compare_series.h"

namespace tarmac::reports {

/// A is what is compared with, B what is compared: ratios and differences are B's against A's.
struct CompareSide {
  std::string label;            ///< short, different from the other's: "main", "kiss-icp"
  std::string folder;           ///< as the user named it
  std::string estimator;        ///< empty: every one that both sides have
  std::string build;            ///< "0.1.0 697e83c234a6"; several are separated by commas
  std::size_t cells = 0;        ///< runs that are there
  std::string provenance_json;  ///< of the first run; empty when there is none
};

enum class CompareVerdict : std::uint8_t {
  better,  ///< B is, and it is more than chance
  worse,
  different,      ///< more than chance, of a metric of which neither way is better
  no_difference,  ///< none that is more than chance
  identical,      ///< the same numbers on every seed
  too_few,        ///< fewer than 3 seeds have both
  no_ratio,       ///< a value is 0 or of the other sign: nothing to take a ratio of
};
const char* name_of(CompareVerdict verdict);  ///< "better", "no_difference"
struct CompareRow;
/// For people: "not significant", "too few seeds (2)"; "not settled" is what would be significant by itself, but not
/// among all that were looked at.
std::string words_of(const CompareRow& row);

/// One metric of one method on one case, over seeds.
struct CompareRow {
  std::string case_name;
  std::string estimator_a, estimator_b;  ///< the same name where two builds are compared
  std::string metric, unit;
  std::string estimate;    ///< causal | final | "causal, final" where the two sides have different ones
  bool cost = false;       ///< depends on the machine and on what else it did
  bool magnitude = false;  ///< of a signed metric: absolute values are compared
  metrics::Better better = metrics::Better::neither;
  std::size_t seeds = 0;                     ///< that have a value on both sides
  std::size_t same = 0;                      ///< seeds on which it is the same to the last bit
  std::size_t b_better = 0;                  ///< seeds on which B's is the better (or, where neither is, the lower) one
  std::optional<double> a_median, b_median;  ///< over these seeds
  metrics::PairedComparison comparison;      ///< of B against A: ratio = B / A
  CompareVerdict verdict = CompareVerdict::too_few;

  bool significant() const {
    return verdict == CompareVerdict::better || verdict == CompareVerdict::worse ||
           verdict == CompareVerdict::different;
  }
  /// "stand-turn, kiss-icp"; "stand-turn, kiss-icp → ct-icp"
  std::string where() const;
};

/// Kinds of CompareMissing that the verdict speaks of: a run that the other side finished.
inline constexpr const char* kNoResultInA = "no result in A";
inline constexpr const char* kNoResultInB = "no result in B";

/// Something that could not be compared. One line for all that lack the same in the same way.
struct CompareMissing {
  std::string kind;       ///< "only in A", "no result in B", "value only in A", "unfinished in B", ...
  std::string what;       ///< "case stand-turn", "metric time_lag_ms"
  std::string detail;     ///< seeds, status and message
  std::size_t count = 1;  ///< runs or rows that it stands for
};

/// Where along the drive the two differ: of one method on one case.
struct CompareDrive {
  std::string case_name, estimator_a, estimator_b;
  std::size_t seeds = 0;
  /// Stretches are looked for only where some row of this method on this case is significant: the chance that a page
  /// without any difference shows a stretch is then that of a false row.
  bool located = false;
  std::vector<metrics::SeriesComparison> series;
  std::uint64_t path_seed = 0;                       ///< whose true path it is
  std::vector<double> path_t_s, path_x_m, path_y_m;  ///< world; empty without truth
};

struct CompareInput {
  CompareSide a, b;
  std::vector<CompareRow> rows;  ///< of the cases in order; costs too
  std::vector<CompareDrive> drives;
  std::size_t drives_left_out = 0;  ///< methods on cases whose series would make the page too large
  std::vector<CompareMissing> missing;
  std::size_t same_recordings = 0, different_recordings = 0, unknown_recordings = 0;  ///< drives (case and seed)
  std::vector<std::string> different;                                                 ///< "stand-turn seed 3"
  std::string command;                                                                ///< that made this
};

/// Counts and sentences that page, Markdown and program share.
struct CompareSummary {
  std::size_t tested = 0;  ///< rows that could differ: judged together by Holm's rule, without costs
  std::size_t better = 0, worse = 0, different = 0, no_difference = 0, identical = 0, too_few = 0, no_ratio = 0;
  std::string sentence;    ///< the verdict
  std::string note;        ///< how sure it is, and of what recordings
  std::string recordings;  ///< whether both sides ran on the same ones
};
CompareSummary summary_of(const CompareInput& input);

/// Significant rows, largest change first, without costs; and the rest of those that were tested, likewise.
std::vector<const CompareRow*> significant_rows(const CompareInput& input);
std::vector<const CompareRow*> other_rows(const CompareInput& input);

}  // namespace tarmac::reports
