// `tarmac baseline update`: what gates hold results to, written anew from sweeps' stores.
#include "scenarios/baseline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/error.h"
#include "scenarios/store.h"
#include "scenarios/sweep_file.h"
#include "tools/gates/judge.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/results_table.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using scenarios::Baseline;
using scenarios::BaselineChange;

/// What is kept when no gate says what it needs.
const std::vector<std::string> kHeadlineMetrics = {"ate_se3_rmse_m",    "coverage_percent",  "deskew_error_rms_m",
                                                   "end_error_percent", "point_error_rms_m", "rpe_1sweep_trans_rmse_m"};

std::vector<std::string> metrics_kept(const BaselineArguments& arguments) {
  if (arguments.gate.empty()) return kHeadlineMetrics;
  const scenarios::GateFile gate =
      scenarios::load_gate(scenarios::find_beside_scenarios(arguments.gate, "gates", scenario_folders()));
  check_metrics(gate);
  const std::vector<std::string> named = metrics_held_to_baseline(gate);
  if (named.empty())
    throw core::InputError(
        fmt::format("{}: no row is held to a baseline (relative or non_inferior): there is nothing "
                    "to keep",
                    gate.file));
  return named;
}

/// What a baseline may not hold, in words; empty: nothing. `shards`: folders without the whole sweep.
std::string unfit(const std::vector<scenarios::CellResult>& results, std::size_t unfinished,
                  const std::vector<std::string>& shards) {
  std::string shard_words;
  if (!shards.empty())
    shard_words = fmt::format("{} hold{} only a shard of the sweep (merge all shards first)", fmt::join(shards, ", "),
                              shards.size() == 1 ? "s" : "");
  std::string first;
  std::size_t failed = 0;
  for (const scenarios::CellResult& result : results) {
    if (!result.outcome.failed()) continue;
    if (++failed == 1)
      first = fmt::format(" (the first: {}, {}, seed {}: {})", result.cell.case_name, result.cell.estimator,
                          result.cell.seed, result.outcome.status);
  }
  if (failed == 0 && unfinished == 0) return shard_words;
  return fmt::format("{}{}{} cells are not finished and {} failed{}", shard_words, shards.empty() ? "" : "; ",
                     unfinished, failed, first);
}

std::string median_text(const std::optional<double>& median, std::size_t seeds) {
  return median ? fmt::format("{:.6g}", *median) : seeds ? "n/a" : "";
}

void print_difference(const scenarios::BaselineDifference& difference) {
  std::vector<std::vector<std::string>> lines = {{"case", "estimator", "metric", "old", "new", "change", "seeds", ""}};
  std::size_t added = 0, gone = 0;
  for (const BaselineChange& change : difference.changes) {
    added += change.kind == BaselineChange::Kind::added;
    gone += change.kind == BaselineChange::Kind::gone;
    const char* kind = change.kind == BaselineChange::Kind::added  ? "new"
                       : change.kind == BaselineChange::Kind::gone ? "gone"
                                                                   : "";
    lines.push_back({change.key.case_name, change.key.estimator, change.key.metric,
                     median_text(change.before, change.seeds_before), median_text(change.after, change.seeds_after),
                     change.change_percent ? fmt::format("{:+.2f} %", *change.change_percent) : "",
                     fmt::format("{} -> {}", change.seeds_before, change.seeds_after), kind});
  }
  if (!difference.changes.empty()) print_table(lines);
  fmt::print("{} rows changed, {} new, {} gone, {} the same", difference.changes.size() - added - gone, added, gone,
             difference.unchanged);
  if (difference.recordings_shared)
    fmt::print("; recordings of {} of {} drives changed", difference.recordings_changed, difference.recordings_shared);
  fmt::print("\n");
}

}  // namespace

int baseline_update_command(const BaselineArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const std::vector<std::string> metrics = metrics_kept(arguments);
  std::vector<scenarios::CellResult> results;
  std::set<std::string> sweeps, builds;
  std::vector<std::string> shards;
  std::size_t unfinished = 0;
  for (const std::string& folder : arguments.folders) {
    const scenarios::Store store = scenarios::Store::open(folder, scenarios::Store::Access::read_only);
    sweeps.insert(store.identity().sweep);
    builds.insert(store.identity().build);
    unfinished += store.unfinished().size();
    if (!store.holds_whole_plan()) shards.push_back(folder);
    scenarios::ResultFilter filter;
    filter.metrics = metrics;
    for (scenarios::CellResult& result : store.results(filter)) results.push_back(std::move(result));
  }
  if (builds.size() > 1)
    throw core::InputError("baseline update: the folders hold results of different builds; a baseline is of one");
  if (const std::string why = unfit(results, unfinished, shards); !why.empty()) {
    if (!arguments.allow_incomplete)
      throw core::InputError(
          fmt::format("baseline update: {}; finish the sweep (`tarmac sweep ... --resume` or --rerun-failed, "
                      "`tarmac merge`), or give --allow-incomplete to write the baseline without what is missing",
                      why));
    console.warn(fmt::format("baseline update: {}; the baseline is written without what is missing", why));
  }
  Baseline baseline = scenarios::make_baseline(results, metrics);
  baseline.sweeps.assign(sweeps.begin(), sweeps.end());
  if (!builds.empty()) baseline.build = *builds.begin();
  Baseline before;
  if (fs::exists(arguments.out)) before = scenarios::load_baseline(arguments.out);
  print_difference(scenarios::difference_of(before, baseline));
  if (fs::path(arguments.out).has_parent_path()) fs::create_directories(fs::path(arguments.out).parent_path());
  scenarios::save_baseline(arguments.out, baseline);
  return 0;
}

}  // namespace tarmac::tools
