#include "metrics/degeneracy/degeneracy.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_map>

#include "metrics/degeneracy/detector.h"
#include "metrics/registry.h"
#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

void in_parallel(std::size_t n, int threads, const std::function<void(std::size_t)>& use) {
  const int wanted = std::max(1, threads);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(wanted));
  tbb::task_arena arena(wanted);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) use(i);
        },
        tbb::simple_partitioner());
  });
}

double mean_range_of(const LidarSweep& sweep) {
  double sum_m = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const double range_m = sweep.point(i).norm();
    if (!std::isfinite(range_m) || !(range_m > 0)) continue;
    sum_m += range_m;
    ++n;
  }
  return n ? sum_m / static_cast<double>(n) : 0;
}

/// By sweep index: the oracle's figure where there is one, so that all scale alike.
std::unordered_map<std::int64_t, double> mean_ranges(const DegeneracyInput& input, int threads) {
  std::unordered_map<std::int64_t, double> ranges;
  if (input.oracle) {
    for (const OracleSweep& sweep : input.oracle->sweeps) ranges[sweep.index] = sweep.mean_range_m;
    return ranges;
  }
  std::vector<std::pair<std::int64_t, double>> found(input.sweeps.count);
  in_parallel(found.size(), threads, [&](std::size_t i) {
    const LidarSweep sweep = input.sweeps.sweep(i);
    found[i] = {sweep.index, mean_range_of(sweep)};
  });
  ranges.insert(found.begin(), found.end());
  return ranges;
}

std::vector<MethodSweep> method_sweeps(const DegeneracyInput& input, int threads, bool& solves_with_surface) {
  const std::unordered_map<std::int64_t, double> ranges = mean_ranges(input, threads);
  std::unordered_map<std::int64_t, const SweepResult*> results;
  for (const SweepResult& sweep : input.estimate.sweeps) results[sweep.index] = &sweep;
  const Eigen::Vector3d p_body_lidar_m = input.sweeps.rig.lidars.at(input.sweeps.lidar).T_body_lidar.translation();
  std::vector<std::optional<MethodSweep>> found(input.diagnostics->count);
  std::vector<std::uint8_t> is_surface(found.size(), 0);
  in_parallel(found.size(), threads, [&](std::size_t i) {
    const SweepDiagnostics record = input.diagnostics->sweep(i);
    const auto result = results.find(record.index);
    const auto range = ranges.find(record.index);
    if (result == results.end() || range == ranges.end()) return;
    found[i] = method_sweep(record, input.estimate.headline(), *result->second, p_body_lidar_m, range->second);
    is_surface[i] = record.rows_are_surface;
  });
  std::vector<MethodSweep> sweeps;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    sweeps.push_back(std::move(*found[i]));
    solves_with_surface |= is_surface[i] != 0;
  }
  return sweeps;
}

std::optional<double> lambda_pose(const SweepVerdict& verdict) {
  return verdict.blocks ? std::optional(verdict.blocks->pose.min()) : std::nullopt;
}

std::optional<double> lambda_difference(const SweepVerdict& verdict) {
  return verdict.blocks && verdict.blocks->difference ? std::optional(verdict.blocks->difference->min()) : std::nullopt;
}

void classify(std::vector<SweepVerdict>& verdicts, const DegeneracyRule& pose, const DegeneracyRule& difference) {
  Classifier pose_class(pose), difference_class(difference);
  for (SweepVerdict& verdict : verdicts) {
    verdict.pose = pose_class(lambda_pose(verdict));
    verdict.difference = difference_class(lambda_difference(verdict));
  }
}

using Lambda = std::optional<double> (*)(const SweepVerdict&);

std::vector<DetectorSample> samples_of(const std::vector<SweepVerdict>& oracle, const std::vector<SweepVerdict>& method,
                                       Lambda lambda, bool of_difference) {
  std::unordered_map<std::int64_t, const SweepVerdict*> by_index;
  for (const SweepVerdict& verdict : method) by_index[verdict.index] = &verdict;
  std::vector<DetectorSample> samples;
  for (const SweepVerdict& truth : oracle) {
    DetectorSample sample{truth.t_s, lambda(truth), {}, DegeneracyClass::unknown};
    if (const auto found = by_index.find(truth.index); found != by_index.end()) {
      sample.lambda = lambda(*found->second);
      sample.flag = of_difference ? found->second->difference : found->second->pose;
    }
    samples.push_back(sample);
  }
  return samples;
}

void put_proportion(const std::string& metric, const Proportion& p, const std::string& note, const char* none,
                    RowSet& rows) {
  if (!p.value()) return rows.missing(metric, none);
  rows.put(metric, *p.value(), fmt::format("{} of {}{}", p.k, p.n, note));
  rows.interval(metric, p.low(), p.high());
}

void put_scores(const std::string& prefix, const DetectorScores& scores, bool with_events, RowSet& rows) {
  const std::string note = fmt::format("; sweeps scored {}, near the threshold {}, unknown {}", scores.scored,
                                       scores.near_threshold, scores.unknown);
  const char* const no_positive = "the oracle calls no scored sweep degenerate";
  put_proportion(prefix + "precision", scores.precision, note, "the method flags no scored sweep", rows);
  put_proportion(prefix + "recall", scores.recall, note, no_positive, rows);
  rows.put_or_missing(prefix + "f1", scores.f1, "neither the oracle nor the method calls a sweep degenerate");
  rows.put_or_missing(prefix + "auc", scores.auc,
                      scores.positives ? "the oracle calls every scored sweep degenerate" : no_positive);
  if (!with_events) return;
  put_proportion(prefix + "event_precision", scores.event_precision, " events", "the method flags no event", rows);
  put_proportion(prefix + "event_recall", scores.event_recall, " events", "the oracle has no event", rows);
  if (scores.lead_s.empty())
    rows.missing(prefix + "lead_time_s", "no event that begins inside the recording is found");
  else
    rows.put(prefix + "lead_time_s", quantile(scores.lead_s, 0.5), fmt::format("median of {}", scores.lead_s.size()));
}

void put_oracle_rows(const std::vector<SweepVerdict>& oracle, RowSet& rows) {
  std::size_t known = 0, pose = 0, difference = 0;
  std::vector<double> smallest;
  for (const SweepVerdict& verdict : oracle) {
    known += verdict.blocks.has_value();
    if (verdict.blocks) smallest.push_back(verdict.blocks->pose.min());
    pose += verdict.pose == DegeneracyClass::degenerate;
    difference += verdict.difference == DegeneracyClass::degenerate;
  }
  if (!known) return;
  const std::string note = known < oracle.size() ? fmt::format("{} of {} sweeps are known", known, oracle.size()) : "";
  rows.put("oracle_degenerate_percent", 100.0 * static_cast<double>(pose) / static_cast<double>(known), note);
  rows.put("oracle_degenerate_12dof_percent", 100.0 * static_cast<double>(difference) / static_cast<double>(known),
           note);
  rows.put("oracle_lambda_min_6dof_median", quantile(smallest, 0.5), note);
}

/// Medians of the smallest eigenvalues and condition numbers.
void put_spectrum_rows(const std::string& source, const std::vector<SweepVerdict>& verdicts, RowSet& rows) {
  std::vector<double> pose, difference, condition_6, condition_12;
  for (const SweepVerdict& verdict : verdicts) {
    if (!verdict.blocks) continue;
    pose.push_back(verdict.blocks->pose.min());
    condition_6.push_back(verdict.blocks->pose.condition());
    if (!verdict.blocks->difference) continue;
    difference.push_back(verdict.blocks->difference->min());
    condition_12.push_back(verdict.blocks->two_pose->condition());
  }
  const std::string note =
      pose.size() < verdicts.size() ? fmt::format("{} of {} sweeps", pose.size(), verdicts.size()) : "";
  const auto put = [&](const char* name, const std::vector<double>& values) {
    const std::string metric = fmt::format("{}_{}", source, name);
    if (!values.empty()) rows.put(metric, quantile(values, 0.5), note);
  };
  put("lambda_min_6dof_median", pose);
  put("lambda_min_12dof_difference_median", difference);
  put("condition_6dof_median", condition_6);
  put("condition_12dof_median", condition_12);
}

const std::map<std::string, std::string> kLabels{
    {"lambda_min_6dof", "smallest eigenvalue, 6 DOF [1]"},
    {"lambda_min_12dof", "smallest eigenvalue, 12 DOF [1]"},
    {"lambda_min_12dof_difference", "smallest eigenvalue, motion in the sweep [1]"},
    {"condition_6dof", "condition number, 6 DOF [1]"},
    {"condition_12dof", "condition number, 12 DOF [1]"},
    {"degeneracy_class", "class, 6 DOF (0 ok, 1 weak, 2 degenerate)"},
    {"degeneracy_class_12dof", "class, motion in the sweep (0 ok, 1 weak, 2 degenerate)"}};

void add_series(const std::string& prefix, const std::string& name, const std::vector<SweepVerdict>& verdicts,
                const std::function<std::optional<double>(const SweepVerdict&)>& value, const std::string& y_label,
                std::vector<Series>& series) {
  Series s{prefix + name + "_vs_time", "time [s]", y_label, {}, {}, {}, {}};
  bool any = false;
  for (const SweepVerdict& verdict : verdicts) {
    const std::optional<double> y = value(verdict);
    any |= y.has_value();
    s.x.push_back(verdict.t_s);
    s.y.push_back(y.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  if (any) series.push_back(std::move(s));
}

std::optional<double> number(DegeneracyClass c) {
  return c == DegeneracyClass::unknown ? std::nullopt : std::optional(static_cast<double>(c));
}

void add_verdict_series(const std::string& prefix, const std::vector<SweepVerdict>& verdicts,
                        std::vector<Series>& series) {
  const auto add = [&](const char* name, const std::function<std::optional<double>(const SweepVerdict&)>& value) {
    add_series(prefix, name, verdicts, value, kLabels.at(name), series);
  };
  using Optional = std::optional<double>;
  add("lambda_min_6dof", lambda_pose);
  add("lambda_min_12dof_difference", lambda_difference);
  add("degeneracy_class", [](const SweepVerdict& v) { return number(v.pose); });
  add("degeneracy_class_12dof", [](const SweepVerdict& v) { return number(v.difference); });
  if (prefix == "surface_") return;
  add("lambda_min_12dof", [](const SweepVerdict& v) {
    return v.blocks && v.blocks->two_pose ? Optional(v.blocks->two_pose->min()) : Optional();
  });
  add("condition_6dof",
      [](const SweepVerdict& v) { return v.blocks ? Optional(v.blocks->pose.condition()) : Optional(); });
  add("condition_12dof", [](const SweepVerdict& v) {
    return v.blocks && v.blocks->two_pose ? Optional(v.blocks->two_pose->condition()) : Optional();
  });
}

void add_weak_series(const std::string& prefix, const std::vector<SweepVerdict>& verdicts, double limit,
                     std::vector<Series>& series) {
  for (std::size_t k = 0; k < kDirectionNames.size(); ++k) {
    std::string name = kDirectionNames[k];
    for (char& c : name)
      if (c == '-') c = '_';
    add_series(
        prefix, "weak_" + name, verdicts,
        [&](const SweepVerdict& v) -> std::optional<double> {
          if (!v.blocks) return std::nullopt;
          return weak_shares(v.blocks->pose, limit)[static_cast<Eigen::Index>(k)];
        },
        fmt::format("{} in the weak subspace [1]", kDirectionNames[k]), series);
  }
}

void add_path_degenerate(const Oracle& oracle, const std::vector<SweepVerdict>& verdicts, std::vector<Series>& series) {
  Series path{"path_degenerate", "x [m]", "y [m]", {}, {}, {}, {}};
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  bool inside = false;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const bool degenerate = verdicts[i].pose == DegeneracyClass::degenerate;
    if (degenerate && !inside && !path.x.empty()) {
      path.x.push_back(kGap);
      path.y.push_back(kGap);
    }
    inside = degenerate;
    if (!degenerate) continue;
    path.x.push_back(oracle.sweeps[i].p_world_body.x());
    path.y.push_back(oracle.sweeps[i].p_world_body.y());
  }
  if (!path.x.empty()) series.push_back(std::move(path));
}

void put_detectors(const std::string& source, const std::vector<SweepVerdict>& oracle,
                   const std::vector<SweepVerdict>& method, RowSet& rows) {
  put_scores("degeneracy_" + source + "_6dof_",
             score_detector(samples_of(oracle, method, lambda_pose, false), kOracleDegenerateBelow), true, rows);
  put_scores("degeneracy_" + source + "_12dof_",
             score_detector(samples_of(oracle, method, lambda_difference, true), kOracleShearDegenerateBelow), false,
             rows);
}

bool any_block(const std::vector<SweepVerdict>& verdicts) {
  for (const SweepVerdict& verdict : verdicts)
    if (verdict.blocks) return true;
  return false;
}

/// Every row of the family has a reason before it has a value.
void put_reasons(const DegeneracyInput& input, RowSet& rows) {
  for (const MetricEntry& metric : metrics()) {
    const std::string name = metric.name;
    if (std::string(metric.family) != "degeneracy") continue;
    if (name.starts_with("oracle_"))
      rows.missing(name, input.oracle ? "the truth covers no sweep" : "there is no truth to ask");
    else if (!input.diagnostics)
      rows.missing(name, "the run recorded no diagnostics");
    else if (name.starts_with("degeneracy_") && !input.oracle)
      rows.missing(name, "there is no truth to compare with");
    else
      rows.missing(name, name.find("surface") != std::string::npos ? "the method recorded no point-to-surface residuals"
                                                                   : "the method recorded no residuals");
  }
}

void put_rows(const DegeneracyInput& input, const DegeneracyReport& report, RowSet& rows) {
  put_reasons(input, rows);
  put_oracle_rows(report.oracle, rows);
  for (const auto& [source, verdicts] : {std::pair{"solve", &report.solve}, std::pair{"surface", &report.surface}}) {
    put_spectrum_rows(source, *verdicts, rows);
    if (!report.oracle.empty() && any_block(*verdicts)) put_detectors(source, report.oracle, *verdicts, rows);
  }
}

}  // namespace

DegeneracyReport degeneracy_report(const DegeneracyInput& input, const DegeneracySettings& settings) {
  DegeneracyReport report;
  if (input.oracle) {
    for (const OracleSweep& sweep : input.oracle->sweeps)
      report.oracle.push_back({sweep.index, to_s(sweep.end - input.t_zero), sweep.points, sweep.blocks,
                               DegeneracyClass::unknown, DegeneracyClass::unknown});
    classify(report.oracle, {kOracleDegenerateBelow, 1e-2, 1}, {kOracleShearDegenerateBelow, 5e-4, 1});
  }
  if (!input.diagnostics) return report;
  for (MethodSweep& sweep : method_sweeps(input, settings.threads, report.solves_with_surface)) {
    const double t_s = to_s(sweep.end - input.t_zero);
    report.prior_share.push_back(sweep.prior_share);
    report.solve.push_back({sweep.index, t_s, sweep.solve_rows, std::move(sweep.solve), DegeneracyClass::unknown,
                            DegeneracyClass::unknown});
    report.surface.push_back({sweep.index, t_s, sweep.surface_rows, std::move(sweep.surface), DegeneracyClass::unknown,
                              DegeneracyClass::unknown});
  }
  const double noise_rad = settings.normal_noise_deg * std::numbers::pi / 180;
  report.method_threshold = DegeneracyRule::pose(noise_rad).degenerate_below;
  for (std::vector<SweepVerdict>* verdicts : {&report.solve, &report.surface})
    classify(*verdicts, DegeneracyRule::pose(noise_rad), DegeneracyRule::difference(noise_rad));
  return report;
}

void add_degeneracy(const DegeneracyInput& input, const DegeneracySettings& settings, RowSet& rows,
                    Evaluation& evaluation) {
  std::vector<Series>& series = evaluation.series;
  const DegeneracyReport report = degeneracy_report(input, settings);
  put_rows(input, report, rows);
  add_verdict_series("oracle_", report.oracle, series);
  add_weak_series("oracle_", report.oracle, kOracleDegenerateBelow, series);
  if (input.oracle) add_path_degenerate(*input.oracle, report.oracle, series);
  add_verdict_series("", report.solve, series);
  if (!report.solves_with_surface) add_verdict_series("surface_", report.surface, series);
  add_weak_series("", any_block(report.surface) ? report.surface : report.solve, report.method_threshold, series);
  Series prior{"prior_share_vs_time", "time [s]", "share of priors along the weakest direction [1]", {}, {}, {}, {}};
  for (std::size_t i = 0; i < report.prior_share.size(); ++i) {
    if (!report.prior_share[i]) continue;
    prior.x.push_back(report.solve[i].t_s);
    prior.y.push_back(*report.prior_share[i]);
  }
  if (!prior.x.empty()) series.push_back(std::move(prior));
  if (report.oracle.empty() && report.solve.empty()) return;  // neither truth nor record: nothing was looked for
  evaluation.degeneracy_csv = to_csv(report);
  const std::vector<Finding> findings = findings_of(report);
  evaluation.findings.insert(evaluation.findings.end(), findings.begin(), findings.end());
}

}  // namespace tarmac::metrics
