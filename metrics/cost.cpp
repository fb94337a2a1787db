#include "metrics/cost.h"

#include <map>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

std::map<std::int64_t, double> end_times_s(const Estimate& estimate, Time t_zero) {
  std::map<std::int64_t, double> times;
  for (const SweepResult& sweep : estimate.sweeps) times[sweep.index] = to_s(sweep.end - t_zero);
  return times;
}

}  // namespace

void add_cost_rows(const RunTiming* timing, const Estimate& estimate, RowSet& rows) {
  const char* const kMetrics[] = {"sweep_time_p50_ms", "sweep_time_p95_ms", "sweep_time_p99_ms",
                                  "sweep_cpu_p50_ms",  "real_time_factor",  "peak_memory_mb"};
  for (const char* metric : kMetrics) rows.missing(metric, "the run recorded no times");
  if (!timing) return;
  std::vector<double> wall_ms, cpu_ms;
  for (const SweepTiming& sweep : timing->sweeps) {
    wall_ms.push_back(sweep.wall_ms);
    cpu_ms.push_back(sweep.cpu_ms);
  }
  if (!wall_ms.empty()) {
    rows.put("sweep_time_p50_ms", quantile(wall_ms, 0.50));
    rows.put("sweep_time_p95_ms", quantile(wall_ms, 0.95));
    rows.put("sweep_time_p99_ms", quantile(wall_ms, 0.99));
    rows.put("sweep_cpu_p50_ms", quantile(cpu_ms, 0.50));
  }
  if (!estimate.sweeps.empty() && timing->wall_s > 0)
    rows.put("real_time_factor", to_s(estimate.sweeps.back().end - estimate.sweeps.front().begin) / timing->wall_s);
  if (timing->peak_memory_mb > 0) rows.put("peak_memory_mb", timing->peak_memory_mb);
}

std::vector<SweepEffort> effort_of(const DiagnosticsSource& diagnostics) {
  std::vector<SweepEffort> effort;
  for (std::size_t i = 0; i < diagnostics.count; ++i) {
    const SweepDiagnostics sweep = diagnostics.sweep(i);
    effort.push_back({sweep.index, sweep.iterations});
  }
  return effort;
}

void add_effort_rows(const std::vector<SweepEffort>* effort, RowSet& rows) {
  std::vector<double> iterations;
  if (effort)
    for (const SweepEffort& sweep : *effort)
      if (sweep.iterations > 0) iterations.push_back(sweep.iterations);
  if (iterations.empty())
    rows.missing("iterations_mean", effort ? "the method does not iterate" : "the run recorded no diagnostics");
  else
    rows.put("iterations_mean", mean(iterations));
}

void add_cost_series(const RunTiming* timing, const std::vector<SweepEffort>* effort, const Estimate& estimate,
                     Time t_zero, std::vector<Series>& series) {
  const std::map<std::int64_t, double> times = end_times_s(estimate, t_zero);
  Series wall{"sweep_time_vs_time", "time [s]", "wall time a sweep [ms]", {}, {}, {}, {}};
  Series iterations{"iterations_vs_time", "time [s]", "iterations", {}, {}, {}, {}};
  const auto append = [&times](Series& s, std::int64_t index, double y) {
    if (const auto found = times.find(index); found != times.end()) {
      s.x.push_back(found->second);
      s.y.push_back(y);
    }
  };
  if (timing)
    for (const SweepTiming& sweep : timing->sweeps) append(wall, sweep.index, sweep.wall_ms);
  if (effort)
    for (const SweepEffort& sweep : *effort) append(iterations, sweep.index, sweep.iterations);
  if (!wall.x.empty()) series.push_back(std::move(wall));
  if (!iterations.x.empty()) series.push_back(std::move(iterations));
}

}  // namespace tarmac::metrics
