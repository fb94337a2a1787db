// What each bundled estimator costs a sweep, on one core, with and without recording diagnostics.
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <thread>

#include "core/diagnostics.h"
#include "core/error.h"
#include "scenarios/scenario.h"
#include "tools/bench/rows.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/estimator_run.h"
#include "tools/tarmac/layout.h"
#include "tools/tarmac/world.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kDuration_s = 12;
constexpr std::size_t kStartUpSweeps = 35;  // the 3 s at rest, and half a second of maps filling up
constexpr int kRounds = 3;                  // of all variants, one after the other; of each sweep the best counts

/// While it lives, this process and the children it starts run on one core.
class OneCore {
 public:
  OneCore() {
    if (sched_getaffinity(0, sizeof before_, &before_) != 0) throw core::InputError("bench: the cores cannot be asked");
    cpu_set_t one;
    CPU_ZERO(&one);
    int last = -1;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(cpu, &before_)) last = cpu;
    CPU_SET(last, &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0) throw core::InputError("bench: cannot keep to one core");
  }
  ~OneCore() { sched_setaffinity(0, sizeof before_, &before_); }
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;

 private:
  cpu_set_t before_;
};

using SweepCost = std::map<std::int64_t, double>;  // best CPU ms by sweep

/// With what the diagnostics took, which a run's own figures leave out.
double whole_cpu_ms(const core::SweepTiming& sweep) {
  double ms = sweep.cpu_ms;
  for (const auto& [stage, stage_ms] : sweep.stages_ms)
    if (stage == "record" || stage == "surfaces") ms += stage_ms;
  return ms;
}

void keep_best(const core::RunTiming& timing, SweepCost& best) {
  for (std::size_t k = kStartUpSweeps; k < timing.sweeps.size(); ++k) {
    const core::SweepTiming& sweep = timing.sweeps[k];
    const auto [entry, is_new] = best.emplace(sweep.index, whole_cpu_ms(sweep));
    if (!is_new) entry->second = std::min(entry->second, whole_cpu_ms(sweep));
  }
}

void add_rows(const std::string& variant, const SweepCost& best, BenchRows& rows) {
  std::vector<double> ms;
  for (const auto& [index, cost_ms] : best) ms.push_back(cost_ms);
  std::sort(ms.begin(), ms.end());
  const auto n = static_cast<double>(ms.size());
  rows.push_back({"estimators", variant, "cpu_ms_per_sweep", std::accumulate(ms.begin(), ms.end(), 0.0) / n, "ms"});
  rows.push_back({"estimators", variant, "cpu_ms_per_sweep_p50", ms[ms.size() / 2], "ms"});
  rows.push_back({"estimators", variant, "sweeps", n, "1"});
}

fs::path record(const PrivateFolder& folder, const Console& console) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(scenarios::find_scenario("stand-turn", scenario_folders()),
                               {scenarios::parse_override(fmt::format("duration_s={}", kDuration_s))});
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  const std::string resolved = resolve_scenario(scenario, seed, {});
  const RunFolder run{folder.path() / "run"};
  sim::simulate(build_world(scenario, seed, resolved),
                {.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), .fast = false},
                run.recording(), run.truth(), console.progress("record"));
  return run.recording();
}

}  // namespace

BenchRows bench_estimators(const Console& console) {
  const PrivateFolder folder;
  const fs::path recording = record(folder, console);
  const std::vector<EstimatorRequest> requests = request_estimators("all", {});
  const OneCore one_core;
  std::map<std::pair<std::string, std::string>, SweepCost> best;
  for (int round = 0; round < kRounds; ++round) {
    for (const std::string diagnostics : {"none", "full"}) {
      const fs::path results = folder.path() / "results";
      const auto outcomes =
          run_estimators(requests, recording, results, {.threads = 1, .diagnostics = diagnostics}, console);
      for (const Outcome& outcome : outcomes) {
        if (outcome.status != "ok")
          throw core::InputError(fmt::format("bench estimators: {}: {}", outcome.estimator, outcome.message));
        keep_best(core::load_timing(results / outcome.estimator / "timing.json"),
                  best[{outcome.estimator, diagnostics}]);
      }
    }
  }
  BenchRows rows;
  for (const EstimatorRequest& request : requests) {
    for (const std::string diagnostics : {"none", "full"})
      add_rows(request.name + "-diagnostics-" + diagnostics, best.at({request.name, diagnostics}), rows);
  }
  return rows;
}

}  // namespace tarmac::tools
