// `tarmac sweep`: many cells into a store.
#include <fmt/format.h>

#include <charconv>
#include <set>

#include "core/error.h"
#include "tools/sweeps/cell_run.h"
#include "tools/sweeps/cost.h"
#include "tools/sweeps/execute.h"
#include "tools/tarmac/commands.h"
#include "tools/tarmac/interrupt.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

/// "2/4": the second of four.
void parse_shard(const std::string& text, PlanSettings& settings) {
  std::size_t i = 0, n = 0;
  const std::size_t slash = text.find('/');
  const char* end = text.data() + text.size();
  const bool read = slash != std::string::npos &&
                    std::from_chars(text.data(), text.data() + slash, i).ptr == text.data() + slash &&
                    std::from_chars(text.data() + slash + 1, end, n).ptr == end;
  if (!read || i < 1 || i > n) {
    throw core::InputError(fmt::format("--shard {}: expected I/N with I from 1 to N, such as 1/4", text));
  }
  settings.shard = i - 1;
  settings.shards = n;
}

void print_plan(const SweepPlan& plan, int jobs) {
  double simulate_s = 0, run_s = 0, recordings_mb = 0, files_mb = 0;
  fmt::print("{:<18}{:<40} {:>6}  {:<16}{:>8}{:>9}\n", "cell", "case", "seed", "estimator", "s", "MB");
  for (const PlannedWorld& world : plan.worlds) {
    for (const std::size_t c : world.cells) {
      const PlannedCell& cell = plan.cells[c];
      const CellCost cost = estimate_cost(plan, cell);
      if (c == world.cells.front()) {
        simulate_s += cost.simulate_s;
        recordings_mb += cost.recording_mb;
      }
      run_s += cost.run_s;
      files_mb += cost.files_mb;
      fmt::print("{:<18}{:<40} {:>6}  {:<16}{:>8.1f}{:>9.1f}\n", cell.cell.key, cell.cell.case_name, cell.cell.seed,
                 cell.cell.estimator, cost.run_s, cost.files_mb);
    }
  }
  fmt::print(
      "{} cells on {} recordings. Estimated: {:.0f} s of simulating and {:.0f} s of estimating and scoring on one "
      "core, "
      "about {:.0f} s with --jobs {}; {:.0f} MB of recordings, {:.0f} MB of results\n",
      plan.cells.size(), plan.worlds.size(), simulate_s, run_s, (simulate_s + run_s) / jobs, jobs, recordings_mb,
      files_mb);
}

std::vector<scenarios::Cell> cells_of(const SweepPlan& plan) {
  std::vector<scenarios::Cell> cells;
  for (const PlannedCell& cell : plan.cells) cells.push_back(cell.cell);
  return cells;
}

/// A store holds the cells of its shard: resumed as another one, or as the whole, it would never be complete.
void refuse_other_shard(const SweepPlan& plan, const scenarios::Store& store) {
  std::set<std::string> planned, stored;
  for (const PlannedCell& cell : plan.cells) planned.insert(cell.cell.key);
  for (const auto& row : store.query("select key from cells").rows) stored.insert(row.at(0).value());
  if (planned == stored) return;
  throw core::InputError(fmt::format(
      "{}: holds {} of the sweep's cells, and not the {} that were asked for: it is another shard's; give the "
      "same --shard as before, or another folder",
      store.folder().string(), stored.size(), planned.size()));
}

scenarios::Store open_store(const SweepPlan& plan, const fs::path& out, bool go_on) {
  const scenarios::StoreIdentity identity{plan.file.name, plan.hash, plan.build};
  if (!fs::exists(out / "store.sqlite")) {
    return scenarios::Store::create(out, identity, plan.file.text, cells_of(plan));
  }
  if (!go_on) {
    throw core::InputError(fmt::format(
        "{}: holds a sweep already; go on with --resume (or --rerun-failed), or give another folder", out.string()));
  }
  scenarios::Store store = scenarios::Store::open(out, scenarios::Store::Access::read_write);
  const scenarios::StoreIdentity& there = store.identity();
  const auto refuse = [&](const std::string& what, const std::string& was, const std::string& is) {
    throw core::InputError(
        fmt::format("{}: its {} was {}, now it is {}; results of both do not mix: give another folder", out.string(),
                    what, was, is));
  };
  if (there.sweep != identity.sweep) refuse("sweep", there.sweep, identity.sweep);
  if (there.plan_hash != identity.plan_hash) refuse("list of cells (hash)", there.plan_hash, identity.plan_hash);
  if (there.build != identity.build) refuse("build", there.build, identity.build);
  refuse_other_shard(plan, store);
  return store;
}

void say_start(const scenarios::StoreStart& start, const Console& console) {
  if (start.released > 0)
    console.say(fmt::format("{} cells were running in processes that are gone: they are run again", start.released));
  if (start.killed > 0)
    console.say(fmt::format("{} cells had been killed from outside: they are run again", start.killed));
  if (start.rerun > 0) console.say(fmt::format("{} cells had failed: they are run again", start.rerun));
  if (start.running_elsewhere > 0)
    console.say(
        fmt::format("{} cells are running in other processes: they are left to these", start.running_elsewhere));
  if (start.done > 0)
    console.say(
        fmt::format("{} cells are done ({} of them failed), {} to go", start.done, start.failed, start.pending));
}

/// 3 where some cells failed or were lost, whichever run of the store it was.
int exit_code_of(const scenarios::Store& store) {
  scenarios::ResultFilter outcomes_only;
  outcomes_only.metrics = {"-"};
  for (const scenarios::CellResult& result : store.results(outcomes_only))
    if (result.outcome.failed()) return 3;
  return 0;
}

int run_plan(const SweepPlan& plan, const fs::path& out, const SweepArguments& arguments, const CommonArguments& common,
             const Console& console) {
  scenarios::Store store = open_store(plan, out, arguments.resume || arguments.rerun_failed);
  say_start(store.start(arguments.rerun_failed), console);
  const ExecuteSettings settings{common.threads(),
                                 arguments.cache.empty() ? out / "recordings" : fs::path(arguments.cache),
                                 arguments.cache_limit_gb, arguments.estimator_program, arguments.fast};
  const ExecuteSummary summary = execute(plan, store, settings, console);
  link_latest(out);
  console.say(
      fmt::format("{} cells ok, {} failed, {} killed in {:.1f} s with {} at once; {} recordings made, {} found; "
                  "overhead {:.0f} ms a cell (largest {:.0f}), {:.0f} ms a recording",
                  summary.ok, summary.failed, summary.killed, summary.wall_s, common.threads(), summary.recordings_made,
                  summary.recordings_found, 1000 * summary.overhead_mean_s, 1000 * summary.overhead_max_s,
                  1000 * summary.overhead_recording_mean_s));
  return exit_code_of(store);
}

/// The nearest folder above that exists.
fs::path existing(fs::path folder) {
  while (!fs::exists(folder) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

int sweep_command(const SweepArguments& arguments, const CommonArguments& common) {
  const Console console(common.quiet);
  const fs::path file = scenarios::find_beside_scenarios(arguments.sweep, "sweeps", scenario_folders());
  PlanSettings settings{arguments.sets, arguments.config, arguments.estimator_program, arguments.fast};
  if (!arguments.shard.empty()) parse_shard(arguments.shard, settings);
  const SweepPlan plan = make_plan(file, settings);
  if (arguments.dry_run) {
    print_plan(plan, common.threads());
    return 0;
  }
  if (arguments.out.empty()) throw core::InputError("sweep: -o is missing; expected a folder for the results");
  const fs::path out = fs::absolute(arguments.out).lexically_normal();
  try {
    return run_plan(plan, out, arguments, common, console);
  } catch (const Interrupted&) {
    console.warn("\ninterrupted: finished cells are kept; go on with --resume");
    return kInterruptedExit;
  } catch (const std::exception& error) {
    const bool full = dynamic_cast<const NoRoom*>(&error) || dynamic_cast<const scenarios::StoreFull*>(&error) ||
                      lacks_room(existing(out), error.what());
    if (!full) throw;
    console.warn(
        fmt::format("error: {}\nno room left on the disk: the sweep stops; finished cells are kept. Make room, then go "
                    "on with --resume",
                    error.what()));
    return 3;
  }
}

}  // namespace tarmac::tools
