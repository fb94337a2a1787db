#include "metrics/residuals.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <unordered_map>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

/// What belongs to a sweep index: its result, and where the recording has it.
struct Place {
  const SweepResult* result;
  std::size_t in_recording;
};

std::unordered_map<std::int64_t, Place> places_of(const Estimate& estimate) {
  std::unordered_map<std::int64_t, Place> places;
  for (std::size_t i = 0; i < estimate.sweeps.size(); ++i)
    places.emplace(estimate.sweeps[i].index, Place{&estimate.sweeps[i], i});
  return places;
}

/// Of the recording's sweep i, if it is the one of that index.
std::vector<float> place_of(const SweepSource& sweeps, std::size_t i, std::int64_t index) {
  if (i >= sweeps.count) return {};
  const LidarSweep sweep = sweeps.sweep(i);
  return sweep.index == index ? place_within_stamp(sweep) : std::vector<float>{};
}

std::vector<SweepResiduals> reduce_all(const EvaluationInput& input, const EvaluateSettings& settings, bool quantised) {
  const auto rates = sweep_rates(input.estimate);
  const auto places = places_of(input.estimate);
  std::vector<SweepResiduals> all(input.diagnostics->count);
  const auto reduce = [&](std::size_t i) {
    const SweepDiagnostics sweep = input.diagnostics->sweep(i);
    const auto place = places.find(sweep.index);
    if (place == places.end() || place->second.result->status != SweepStatus::ok) return;
    const auto rate = rates.find(sweep.index);
    const std::vector<float> within =
        quantised ? place_of(input.sweeps, place->second.in_recording, sweep.index) : std::vector<float>{};
    const SweepResult& result = *place->second.result;
    all[i] = reduce_sweep(sweep, result.end - result.begin, rate == rates.end() ? nullptr : &rate->second, within,
                          {.phase_bins = settings.phase_bins});
  };
  const int threads = std::max(1, settings.threads);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, all.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) reduce(i);
        },
        tbb::simple_partitioner());
  });
  std::erase_if(all, [](const SweepResiduals& sweep) { return sweep.rows == 0; });
  return all;
}

double median_period_s(const Estimate& estimate) {
  std::vector<double> periods;
  for (std::size_t k = 1; k < estimate.sweeps.size(); ++k)
    periods.push_back(to_s(estimate.sweeps[k].begin - estimate.sweeps[k - 1].begin));
  return periods.empty() ? 0.1 : quantile(std::move(periods), 0.5);
}

bool holds_one_pose(const Estimate& estimate) {
  const std::vector<Segment>& segments = estimate.headline().segments();
  return !segments.empty() && std::all_of(segments.begin(), segments.end(),
                                          [](const Segment& segment) { return segment.model == SegmentModel::held; });
}

void put(RowSet& rows, const char* metric, const Bootstrapped& value, double unit) {
  rows.put(metric, unit * value.value);
  rows.interval(metric, unit * value.low, unit * value.high);
}

void put_slopes(const SlopeFit& fit, bool quantised, RowSet& rows) {
  put(rows, "residual_lag_rotation_ms", fit.lag_rotation_s, 1e3);
  put(rows, "residual_lag_translation_ms", fit.lag_translation_s, 1e3);
  put(rows, "residual_scale_rotation_percent", fit.scale_rotation, 100);
  put(rows, "residual_scale_translation_percent", fit.scale_translation, 100);
  put(rows, "residual_omitted_acceleration_percent", fit.omitted_translation, 100);
  if (quantised)
    put(rows, "stamp_quantum_ms", fit.quantum_s, 1e3);
  else
    rows.missing("stamp_quantum_ms", "stamps do not stand still while the sensor goes on");
}

}  // namespace

Evidence examine_residuals(const EvaluationInput& input, const EvaluateSettings& settings, RowSet& rows,
                           std::vector<Series>& series) {
  Evidence evidence;
  evidence.stamps = stamp_facts(input.sweeps);
  evidence.held = holds_one_pose(input.estimate);
  evidence.period_s = median_period_s(input.estimate);
  const char* const kMetrics[] = {"residual_spread_m",
                                  "residual_lag_rotation_ms",
                                  "residual_lag_translation_ms",
                                  "residual_scale_rotation_percent",
                                  "residual_scale_translation_percent",
                                  "residual_omitted_acceleration_percent",
                                  "stamp_quantum_ms"};
  std::vector<SweepResiduals> sweeps;
  if (input.diagnostics) sweeps = reduce_all(input, settings, evidence.stamps.quantised());
  if (sweeps.empty()) {
    for (const char* metric : kMetrics)
      rows.missing(metric, input.diagnostics ? "the method recorded no point-to-surface residual"
                                             : "the run recorded no diagnostics");
    return evidence;
  }
  std::vector<double> spreads;
  for (const SweepResiduals& sweep : sweeps)
    if (sweep.fitted) spreads.push_back(sweep.sigma_m);
  evidence.spread_m = spreads.empty() ? 0 : quantile(spreads, 0.5);
  // Few sweeps give a picture, but no spread from sweep to sweep to judge it by.
  constexpr std::size_t kLeastSweeps = 20;
  const PhaseTrend trend = add_phase_series(sweeps, {}, series);
  if (sweeps.size() >= kLeastSweeps) evidence.trend = trend;
  const SlopeFit fit = fit_slopes(sweeps, {});
  if (fit.span_s > 0) {
    rows.put("residual_spread_m", evidence.spread_m);
    put_slopes(fit, evidence.stamps.quantised(), rows);
    add_slope_series(sweeps, fit, series);
    evidence.slopes = fit;
  } else {
    for (const char* metric : kMetrics) rows.missing(metric, "fewer than 20 sweeps with residuals and known motion");
  }
  return evidence;
}

}  // namespace tarmac::metrics
