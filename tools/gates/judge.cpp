#include "tools/gates/judge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "metrics/registry.h"
#include "tools/gates/rules.h"
#include "tools/gates/selection.h"

namespace tarmac::tools {
namespace {

using reports::GateReport;
using reports::GateReportRow;
using reports::GateVerdict;

constexpr std::size_t kTroublesShown = 3;

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const metrics::MetricEntry& entry : metrics::metrics()) names.emplace_back(entry.name);
  return names;
}

/// A row of the report with the paired test that waits for the others' p.
struct Judged {
  GateReportRow row;
  const scenarios::GateRow* gate_row = nullptr;
  PairedRow paired;
  bool lower_is_better = true;
};

void fail_for_troubles(const TargetValues& values, GateReportRow& row) {
  const std::size_t shown = std::min(values.troubles.size(), kTroublesShown);
  row.verdict = GateVerdict::fail;
  row.reason = fmt::format(
      "{}{}", fmt::join(values.troubles.begin(), values.troubles.begin() + static_cast<std::ptrdiff_t>(shown), "; "),
      values.troubles.size() > shown ? fmt::format(" and {} more", values.troubles.size() - shown) : "");
}

Judged judge_target(const GateInput& input, const CellIndex& index, const GateTarget& target) {
  Judged judged;
  judged.gate_row = target.row;
  const metrics::MetricEntry& metric = *metrics::find_metric(target.metric);
  judged.lower_is_better = metric.lower_is_better;
  GateReportRow& row = judged.row;
  row.case_name = target.case_name;
  row.estimator = target.estimator;
  row.metric = target.metric;
  row.unit = metric.unit;
  row.rule = words_of(*target.row);
  if (!target.missing.empty()) {
    row.verdict = GateVerdict::fail;
    row.reason = target.missing;
    return judged;
  }
  const TargetCells& cells = index.cells_of(target.case_name, target.estimator);
  const std::string estimate = estimate_of(input, target, cells);
  const TargetValues values = values_of(input, target, cells, estimate);
  row.evidence = values.evidence;
  const SeedValues* baseline = baseline_of(input, target, estimate);
  const metrics::Better better = metrics::better_of(metric);
  if (!values.troubles.empty())
    fail_for_troubles(values, row);
  else if (target.row->absolute)
    judge_absolute(*target.row->absolute, values, row);
  else if (target.row->relative)
    judge_relative(*target.row->relative, values, baseline, better, row);
  else
    judged.paired = test_paired(*target.row->non_inferior, values, baseline, input.gate->alpha, better, row);
  return judged;
}

/// Holm's rule is over all rows that were tested, those that are only reported too.
void judge_tested(const scenarios::GateFile& gate, std::vector<Judged>& rows) {
  std::vector<Judged*> tested;
  std::vector<double> p;
  for (Judged& judged : rows)
    if (judged.paired.tested) {
      tested.push_back(&judged);
      p.push_back(judged.paired.result.p);
    }
  if (tested.empty()) return;
  const std::vector<double> adjusted = gate.holm ? metrics::holm_adjusted(p) : p;
  const double strictest = gate.holm ? gate.alpha / static_cast<double>(tested.size()) : gate.alpha;
  for (std::size_t k = 0; k < tested.size(); ++k)
    judge_paired(*tested[k]->gate_row->non_inferior, tested[k]->paired, gate.alpha, strictest, adjusted[k],
                 tested[k]->lower_is_better, tested[k]->row);
}

/// ISO days compare as texts.
void report_only(const std::string& until, const std::string& today, GateReportRow& row) {
  if (row.verdict != GateVerdict::fail || until.empty() || today > until) return;
  row.verdict = GateVerdict::report_only;
  row.report_only_until = until;
}

/// How many drives' recordings are other ones than the baseline's.
std::string recordings_note(const GateInput& input) {
  std::set<std::pair<std::string, std::uint64_t>> shared, differing;
  for (const scenarios::CellResult& result : input.results) {
    const auto of_case = input.baseline->recordings.find(result.cell.case_name);
    if (of_case == input.baseline->recordings.end() || result.outcome.recording_hash.empty()) continue;
    const auto hash = of_case->second.find(result.cell.seed);
    if (hash == of_case->second.end()) continue;
    shared.emplace(result.cell.case_name, result.cell.seed);
    if (hash->second != result.outcome.recording_hash) differing.emplace(result.cell.case_name, result.cell.seed);
  }
  if (differing.empty()) return "";
  return fmt::format("recordings of {} of {} drives differ from the baseline's: what changed may be the simulator",
                     differing.size(), shared.size());
}

/// Of a shard nothing is judged: what it lacks is not lost, and what it has says nothing of the rest.
GateReportRow shard_row(const GateInput& input) {
  GateReportRow row;
  const std::size_t cells = input.results.size() + input.unfinished.size();
  row.case_name = "the whole sweep";
  row.estimator = "all";
  row.metric = "cells";
  row.rule = "the store holds every cell of the sweep";
  row.verdict = GateVerdict::fail;
  row.value = static_cast<double>(cells);
  row.reason = fmt::format("the store holds only {} cells of the sweep: a shard; merge all shards first", cells);
  return row;
}

}  // namespace

void check_metrics(const scenarios::GateFile& gate) {
  for (const scenarios::GateRow& row : gate.rows)
    for (const std::string& metric : row.metrics) {
      if (metrics::find_metric(metric)) continue;
      const std::string meant = core::did_you_mean(metric, metric_names());
      row.node.fail_at("metric", fmt::format("there is no metric '{}'{}; `tarmac list metrics` shows all", metric,
                                             meant.empty() ? "" : fmt::format(" (did you mean '{}'?)", meant)));
    }
}

std::vector<std::string> metrics_held_to_baseline(const scenarios::GateFile& gate) {
  std::set<std::string> names;
  for (const scenarios::GateRow& row : gate.rows)
    if (!row.absolute) names.insert(row.metrics.begin(), row.metrics.end());
  return {names.begin(), names.end()};
}

reports::GateReport judge_gate(const GateInput& input) {
  check_metrics(*input.gate);
  GateReport report;
  report.gate = input.gate->name;
  report.why = input.gate->why;
  report.build = input.build;
  if (input.baseline) report.baseline_build = input.baseline->build;
  if (!input.whole) {
    report.rows.push_back(shard_row(input));
    return report;
  }
  const CellIndex index(input);
  std::vector<Judged> rows;
  for (const scenarios::GateRow& row : input.gate->rows)
    for (const GateTarget& target : index.targets_of(row)) rows.push_back(judge_target(input, index, target));
  judge_tested(*input.gate, rows);

  if (input.baseline)
    if (std::string note = recordings_note(input); !note.empty()) report.notes.push_back(std::move(note));
  for (Judged& judged : rows) {
    report_only(judged.gate_row->report_only_until, input.today, judged.row);
    report.rows.push_back(std::move(judged.row));
  }
  return report;
}

}  // namespace tarmac::tools
