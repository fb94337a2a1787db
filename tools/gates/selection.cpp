#include "tools/gates/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace tarmac::tools {
namespace {

using scenarios::matches_pattern;

bool matches_any(const std::vector<std::string>& patterns, const std::string& text) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return matches_pattern(pattern, text); });
}

void add_trouble(const GateInput& input, const scenarios::CellResult& result, TargetValues& values) {
  const auto& outcome = result.outcome;
  values.troubles.push_back(fmt::format("seed {}: {}{}{}", result.cell.seed, outcome.status,
                                        outcome.message.empty() ? "" : ": ", outcome.message));
  if (!outcome.folder.empty())
    values.evidence.push_back(
        fmt::format("seed {}: log: {}", result.cell.seed,
                    (input.folder / outcome.folder / result.cell.estimator / "log.txt").string()));
  if (!outcome.command.empty())
    values.evidence.push_back(fmt::format("seed {}: again: {}", result.cell.seed, outcome.command));
}

void add_value(const GateTarget& target, const scenarios::CellResult& result, const std::string& estimate,
               TargetValues& values) {
  const std::uint64_t seed = result.cell.seed;
  const scenarios::MetricValue* value = scenarios::find_value(result, target.metric, estimate);
  if (!value) {
    values.values[seed] = std::nullopt;
    values.evidence.push_back(fmt::format("seed {}: the evaluation has no {} ({})", seed, target.metric, estimate));
    return;
  }
  values.unit = value->unit;
  const bool number = value->value && std::isfinite(*value->value);
  values.values[seed] = number ? value->value : std::nullopt;
  if (!number) values.evidence.push_back(fmt::format("seed {}: {}", seed, value->value ? "not finite" : value->status));
}

}  // namespace

CellIndex::CellIndex(const GateInput& input) : input_(input) {
  for (const scenarios::CellResult& result : input.results) {
    Pair& pair = pairs_[{result.cell.case_name, result.cell.estimator}];
    pair.scenario = result.cell.scenario;
    pair.cells.finished[result.cell.seed] = &result;
  }
  for (const scenarios::Cell& cell : input.unfinished) {
    Pair& pair = pairs_[{cell.case_name, cell.estimator}];
    pair.scenario = cell.scenario;
    pair.cells.unfinished[cell.seed] = &cell;
  }
  // Rows without cells: of what the baseline knows and the sweep has lost.
  if (!input.baseline) return;
  for (const auto& [key, values] : input.baseline->values) {
    const auto scenario = input.baseline->scenario_of.find(key.case_name);
    Pair& pair = pairs_[{key.case_name, key.estimator}];
    if (pair.scenario.empty() && scenario != input.baseline->scenario_of.end()) pair.scenario = scenario->second;
  }
}

std::vector<GateTarget> CellIndex::targets_of(const scenarios::GateRow& row) const {
  std::vector<GateTarget> targets;
  std::set<std::string> places_met, estimators_met;
  for (const auto& [names, pair] : pairs_) {
    const auto& [case_name, estimator] = names;
    const std::string& place = row.by_scenario ? pair.scenario : case_name;
    if (!matches_any(row.places, place) || !matches_any(row.estimators, estimator)) continue;
    const bool has_cells = !pair.cells.finished.empty() || !pair.cells.unfinished.empty();
    for (const std::string& metric : row.metrics) {
      const GateTarget target{&row, case_name, estimator, metric, ""};
      if (!has_cells && (row.absolute || !baseline_of(input_, target, estimate_of(input_, target, pair.cells))))
        continue;
      targets.push_back(target);
      places_met.insert(place);
      estimators_met.insert(estimator);
    }
  }
  const auto report_unmet = [&](const std::vector<std::string>& patterns, const std::set<std::string>& met,
                                bool is_place) {
    for (const std::string& pattern : patterns) {
      if (std::any_of(met.begin(), met.end(), [&](const auto& name) { return matches_pattern(pattern, name); }))
        continue;
      const char* kind = !is_place ? "estimator" : row.by_scenario ? "scenario" : "case";
      targets.push_back({&row, is_place ? pattern : row.places.front(), is_place ? row.estimators.front() : pattern,
                         row.metrics.front(),
                         fmt::format("{} '{}' selects no cell of this sweep: nothing was tested", kind, pattern)});
    }
  };
  report_unmet(row.places, places_met, true);
  if (!estimators_met.empty()) report_unmet(row.estimators, estimators_met, false);
  return targets;
}

const TargetCells& CellIndex::cells_of(const std::string& case_name, const std::string& estimator) const {
  static const TargetCells kNone;
  const auto found = pairs_.find({case_name, estimator});
  return found == pairs_.end() ? kNone : found->second.cells;
}

std::string estimate_of(const GateInput& input, const GateTarget& target, const TargetCells& cells) {
  if (!target.row->estimate.empty()) return target.row->estimate;
  std::string best;
  const auto consider = [&](const std::string& estimate) {
    if (best.empty() || scenarios::headline_rank(estimate) < scenarios::headline_rank(best)) best = estimate;
  };
  for (const auto& [seed, result] : cells.finished)
    if (const scenarios::MetricValue* value = scenarios::find_value(*result, target.metric)) consider(value->estimate);
  if (input.baseline && !target.row->absolute) {
    const scenarios::BaselineKey first{target.case_name, target.estimator, target.metric, ""};
    for (auto at = input.baseline->values.lower_bound(first); at != input.baseline->values.end(); ++at) {
      const scenarios::BaselineKey& key = at->first;
      if (std::tie(key.case_name, key.estimator, key.metric) !=
          std::tie(first.case_name, first.estimator, first.metric))
        break;
      consider(key.estimate);
    }
  }
  return best.empty() ? "causal" : best;
}

TargetValues values_of(const GateInput& input, const GateTarget& target, const TargetCells& cells,
                       const std::string& estimate) {
  TargetValues values;
  for (const auto& [seed, cell] : cells.unfinished)
    values.troubles.push_back(fmt::format("seed {}: not finished; go on with `tarmac sweep ... --resume`", seed));
  for (const auto& [seed, result] : cells.finished) {
    const std::string& status = result->outcome.status;
    if (status == "ok")
      add_value(target, *result, estimate, values);
    else if (status == "not_initialised" && target.row->allow_not_initialised)
      values.allowed.insert(seed);
    else
      add_trouble(input, *result, values);
  }
  if (cells.finished.empty() && cells.unfinished.empty())
    values.troubles.push_back("is in the baseline, and this sweep has no such cell");
  return values;
}

const SeedValues* baseline_of(const GateInput& input, const GateTarget& target, const std::string& estimate) {
  if (!input.baseline) return nullptr;
  const auto at = input.baseline->values.find({target.case_name, target.estimator, target.metric, estimate});
  return at == input.baseline->values.end() ? nullptr : &at->second;
}

}  // namespace tarmac::tools
