/// A gate: what must hold of a sweep's results, in one file.
///
///   name: regression
///   why: ...
///   sweep: regression                        # optional: the gate is for results of this sweep alone
///   baseline: ../baselines/regression.yaml   # from the gate file's folder; needed by the last two kinds of rows
///   alpha: 0.01                              # chance of a false red, one-sided; with holm over all rows together
///   holm: true
///   report_only_until: 2026-12-31            # optional; a row may have its own. Up to and with that day a red is
///   shown rows:                                    # and does not fail
///     - {case: stand-turn, estimator: kiss-icp, metric: end_error_percent, max: 0.5, of: median}    # or min:, or both
///     - {case: '*', estimator: [kiss-icp, ct-icp], metric: ..., relative: {max_increase_percent: 10}}
///     - {scenario: quick-brake, estimator: kiss-icp, metric: ..., non_inferior: {margin_percent: 0, min_pairs: 10}}
///     - {..., allow: [not_initialised]}      # a method that says that it cannot start does not fail this row
///
/// `case` is the sweep's case (the block's name and the parameters), `scenario` all cases of a scenario. Names are
/// patterns, in which `*` stands for any text; a list selects what any of its entries does.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace tarmac::scenarios {

/// Of the values over seeds. `every`: each of them is held to the bounds.
enum class GateStatistic { median, mean, every };

struct AbsoluteRule {
  std::optional<double> max, min;
  GateStatistic of = GateStatistic::median;
};
/// Of the median over seeds against the baseline's.
struct RelativeRule {
  std::optional<double> max_increase_percent, max_decrease_percent;
};
struct NonInferiorRule {
  double margin_percent = 0;
  std::size_t min_pairs = 3;
};

/// One entry of `rows`; stands for a row a case, estimator and metric that its patterns select.
struct GateRow {
  bool by_scenario = false;  ///< `places` are patterns of scenarios' names, not of cases'
  std::vector<std::string> places;
  std::vector<std::string> estimators;
  std::vector<std::string> metrics;  ///< names, no patterns
  std::string estimate;              ///< causal | final; empty: causal where it has a value, else final
  /// Exactly one of the three.
  std::optional<AbsoluteRule> absolute;
  std::optional<RelativeRule> relative;
  std::optional<NonInferiorRule> non_inferior;
  bool allow_not_initialised = false;
  std::string report_only_until;  ///< "2026-12-31"; empty: never. The file's where the row has none
  core::ConfigNode node;          ///< for messages about it
};

struct GateFile {
  std::string name, why;
  std::string sweep;               ///< empty: any
  std::filesystem::path baseline;  ///< resolved; empty: none
  double alpha = 0.01;
  bool holm = true;
  std::string report_only_until;
  std::vector<GateRow> rows;
  std::string file;
};

/// Throws InputError (file, line, field, what was expected) for anything wrong. Names of metrics are not checked here.
GateFile load_gate(const std::filesystem::path& file);

/// Whether `text` is `pattern`, in which `*` stands for any text.
bool matches_pattern(const std::string& pattern, const std::string& text);

}  // namespace tarmac::scenarios
