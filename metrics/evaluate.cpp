#include "metrics/evaluate.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "core/error.h"
#include "metrics/consistency.h"
#include "metrics/cost.h"
#include "metrics/degeneracy/degeneracy.h"
#include "metrics/drift.h"
#include "metrics/point_error.h"
#include "metrics/residuals.h"
#include "metrics/trajectory_error.h"

namespace tarmac::metrics {

using namespace core;
using sim::truth::PointLabels;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct PointErrors {
  std::vector<SweepErrors> sweeps;  // one a sweep of the recording
  PointHistograms histograms;
};

/// One of the estimate's two trajectories under evaluation.
struct Subject {
  const char* name;
  bool is_final;
  const PiecewiseTrajectory& trajectory;
  std::vector<PosePair> pairs;
};

std::uint64_t finite_points(const LidarSweep& sweep) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < sweep.size(); ++i) n += sweep.point(i).allFinite();
  return n;
}

void check(const EvaluationInput& input) {
  if (!input.truth) return;
  if (!input.labels || input.labels->size() != input.sweeps.count)
    throw InputError(
        fmt::format("the recording has {} sweeps and the truth labels of {}: they do not belong together; evaluate "
                    "each recording with the truth that was written beside it",
                    input.sweeps.count, input.labels ? input.labels->size() : 0));
  if (!input.truth->motion) throw InputError("the truth has no motion: nothing can be evaluated against it");
  if (input.sweeps.merged() && input.truth->rig.lidars.size() != input.sweeps.T_body_lidars.size())
    throw InputError(fmt::format("the recording has {} LiDARs and the truth {}: they do not belong together",
                                 input.sweeps.T_body_lidars.size(), input.truth->rig.lidars.size()));
  for (const Rig* rig : {&input.sweeps.rig, &input.truth->rig})
    if (rig->lidars.size() <= input.sweeps.lidar)
      throw InputError(
          fmt::format("the {} rig has no lidar {}", rig == &input.truth->rig ? "true" : "nominal", input.sweeps.lidar));
}

/// How many of `total` fall to the k-th of n: they add up, and differ by one at most.
std::size_t share(std::size_t total, std::size_t k, std::size_t n) {
  return (k + 1) * total / n - k * total / n;
}

PointErrors score_points(const EvaluationInput& input, const EvaluateSettings& settings, const Subject& subject,
                         std::size_t map_points) {
  const std::optional<Fit> se3 = align(subject.pairs, Alignment::se3, input.estimate.gravity_aligned);
  const PointScorer scorer{subject.trajectory,
                           *input.truth->motion,
                           input.sweeps.rig.lidars[input.sweeps.lidar].T_body_lidar,
                           input.truth->rig.lidars[input.sweeps.lidar].T_body_lidar,
                           first_pose_alignment(subject.pairs),
                           se3->A.T_world_map,
                           settings.phase_bins,
                           input.sweeps.true_mountings(input.truth->rig)};
  std::unordered_map<std::int64_t, std::size_t> pair_of_sweep;
  for (std::size_t k = 0; k < subject.pairs.size(); ++k) pair_of_sweep.emplace(subject.pairs[k].index, k);

  // A slot a sweep, summed up in order afterwards; the histograms count in integers, where order does not matter.
  PointErrors result{std::vector<SweepErrors>(input.sweeps.count), PointHistograms(settings.phase_bins)};
  tbb::enumerable_thread_specific<PointHistograms> histograms(settings.phase_bins);
  const auto score = [&](std::size_t i) {
    const LidarSweep sweep = input.sweeps.sweep(i);
    const auto found = pair_of_sweep.find(sweep.index);
    if (found == pair_of_sweep.end()) {
      result.sweeps[i].points = finite_points(sweep);
      return;
    }
    const PosePair& pair = subject.pairs[found->second];
    const std::size_t sample = share(map_points, found->second, subject.pairs.size());
    result.sweeps[i] =
        score_sweep(scorer, sweep, (*input.labels)[i], pair.t, pair.T_map_body, sample, histograms.local());
  };
  const int threads = std::max(1, settings.threads);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, input.sweeps.count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) score(i);
        },
        tbb::simple_partitioner());
  });
  for (const PointHistograms& part : histograms) result.histograms.add(part);
  return result;
}

void add_paths(const EvaluationInput& input, const std::vector<PosePair>& pairs, std::vector<Series>& series) {
  Series truth{"path_true", "x [m]", "y [m]", {}, {}, {}, {}};
  for (const PointLabels& sweep : *input.labels) {
    if (!input.truth->motion->covers(sweep.end)) continue;
    const Eigen::Vector3d p = input.truth->motion->pose(sweep.end).translation();
    truth.x.push_back(p.x());
    truth.y.push_back(p.y());
  }
  Series estimate{"path_estimate", "x [m]", "y [m]", {}, {}, {}, {}};
  const SE3 A = first_pose_alignment(pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (k > 0 && pairs[k].index != pairs[k - 1].index + 1) {  // a gap in the line
      estimate.x.push_back(kNaN);
      estimate.y.push_back(kNaN);
    }
    const Eigen::Vector3d p = A * pairs[k].T_map_body.translation();
    estimate.x.push_back(p.x());
    estimate.y.push_back(p.y());
  }
  series.push_back(std::move(truth));
  series.push_back(std::move(estimate));
}

void add_motion(const EvaluationInput& input, Time t_zero, std::vector<Series>& series) {
  Series speed{"speed_vs_time", "time [s]", "true speed [m/s]", {}, {}, {}, {}};
  Series yaw_rate{"yaw_rate_vs_time", "time [s]", "true yaw rate [deg/s]", {}, {}, {}, {}};
  for (const PointLabels& sweep : *input.labels) {
    if (!input.truth->motion->covers(sweep.end)) continue;
    const Kinematics k = input.truth->motion->at(sweep.end);
    speed.x.push_back(to_s(sweep.end - t_zero));
    speed.y.push_back(k.v_world.norm());
    yaw_rate.x.push_back(to_s(sweep.end - t_zero));
    yaw_rate.y.push_back((k.T_world_body.linear() * k.omega_body).z() * 180 / std::numbers::pi);
  }
  series.push_back(std::move(speed));
  series.push_back(std::move(yaw_rate));
}

/// Deskew error where it is hardest: in the sweeps in whose middle the vehicle brakes.
void add_braking_row(const EvaluationInput& input, const std::vector<SweepErrors>& sweeps, RowSet& rows) {
  constexpr double kHardM_s2 = 2.5;
  SquaredSum braking;
  std::size_t count = 0;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const PointLabels& labels = (*input.labels)[i];
    const Time middle = labels.begin + (labels.end - labels.begin) / 2;
    if (!sweeps[i].scored || !input.truth->motion->covers(middle)) continue;
    const Kinematics k = input.truth->motion->at(middle);
    if (k.a_world.dot(k.T_world_body.linear().col(0)) >= -kHardM_s2) continue;
    braking.add(sweeps[i].of[static_cast<std::size_t>(PointFamily::deskew)]);
    ++count;
  }
  if (braking.n == 0)
    rows.missing("deskew_error_braking_rms_m", fmt::format("no sweep brakes harder than {} m/s2", kHardM_s2));
  else
    rows.put("deskew_error_braking_rms_m", braking.rms(), fmt::format("{} sweeps", count));
}

void gather_map(std::vector<SweepErrors>& sweeps, MapSample& map) {
  for (const SweepErrors& sweep : sweeps) {
    map.p_world_m.insert(map.p_world_m.end(), sweep.map.p_world_m.begin(), sweep.map.p_world_m.end());
    map.error_m.insert(map.error_m.end(), sweep.map.error_m.begin(), sweep.map.error_m.end());
    map.moving.insert(map.moving.end(), sweep.map.moving.begin(), sweep.map.moving.end());
  }
}

/// When the drive begins: by the truth's clock, or the recording's.
Time time_zero(const EvaluationInput& input) {
  if (input.truth) return input.labels->empty() ? Time{} : input.labels->front().begin;
  return input.estimate.sweeps.empty() ? Time{} : input.estimate.sweeps.front().begin;
}

/// What the run itself says, truth or no truth.
void add_run_figures(const EvaluationInput& input, const EvaluateSettings& settings, Time t_zero, RowSet& rows,
                     Evaluation& evaluation) {
  std::vector<Series>& series = evaluation.series;
  std::vector<SweepEffort> effort;
  if (input.diagnostics) effort = effort_of(*input.diagnostics);
  const std::vector<SweepEffort>* known = input.diagnostics ? &effort : nullptr;
  add_cost_rows(input.timing, input.estimate, rows);
  add_effort_rows(known, rows);
  add_cost_series(input.timing, known, input.estimate, t_zero, series);
  add_degeneracy({input.estimate, input.diagnostics, input.sweeps, input.oracle, t_zero}, {.threads = settings.threads},
                 rows, evaluation);
}

void keep_rows(const RowSet& rows, Evaluation& evaluation) {
  const std::vector<Row> made = rows.rows();
  evaluation.rows.insert(evaluation.rows.end(), made.begin(), made.end());
}

void put_coverage(std::size_t scored, std::size_t sweeps, RowSet& rows, double& coverage) {
  coverage = sweeps ? static_cast<double>(scored) / static_cast<double>(sweeps) : 0;
  rows.put("coverage_percent", 100 * coverage);
}

/// What residuals and lag say of timing. Once for the headline estimate.
void add_timing(const EvaluationInput& input, const EvaluateSettings& settings, const std::vector<PosePair>* pairs,
                RowSet& rows, Evaluation& evaluation) {
  Evidence evidence = examine_residuals(input, settings, rows, evaluation.series);
  evidence.has_truth = input.truth != nullptr;
  if (pairs)
    evidence.lag = add_lag(*pairs, *input.truth->motion, !input.truth->faults.empty(), rows, evaluation.series);
  const std::vector<Finding> findings = diagnose(evidence);
  evaluation.findings.insert(evaluation.findings.end(), findings.begin(), findings.end());
}

void evaluate_subject(const EvaluationInput& input, const EvaluateSettings& settings, const Subject& subject,
                      bool headline, Evaluation& evaluation) {
  const Time t_zero = time_zero(input);
  RowSet rows(subject.name);
  double coverage = 0;
  put_coverage(subject.pairs.size(), input.sweeps.count, rows, coverage);
  if (headline) {
    evaluation.coverage = coverage;
    if (!input.labels->empty()) add_motion(input, t_zero, evaluation.series);
    add_run_figures(input, settings, t_zero, rows, evaluation);
  }
  if (!subject.pairs.empty()) {
    add_trajectory_rows(subject.pairs, {.gravity_aligned = input.estimate.gravity_aligned}, rows);
    PointErrors points = score_points(input, settings, subject, headline ? settings.map_points : 0);
    add_point_rows(points.sweeps, points.histograms, rows);
    add_drift_rows(subject.pairs, rows);
    add_braking_row(input, points.sweeps, rows);
    if (headline) {
      add_paths(input, subject.pairs, evaluation.series);
      add_trajectory_series(subject.pairs, t_zero, evaluation.series);
      add_drift_series(subject.pairs, t_zero, evaluation.series);
      add_consistency(subject.pairs, input.diagnostics, t_zero, rows, evaluation.series);
      add_point_series(points.sweeps, points.histograms, t_zero, evaluation.series);
      gather_map(points.sweeps, evaluation.map);
      add_timing(input, settings, &subject.pairs, rows, evaluation);
    }
  }
  rows.all_missing(subject.pairs.empty() ? "no sweep is scored"
                   : headline            ? "no value"
                                         : "stated of the headline estimate");
  keep_rows(rows, evaluation);
}

/// A recording from outside: what the run says of itself, and the path as estimated.
void evaluate_alone(const EvaluationInput& input, const EvaluateSettings& settings, Evaluation& evaluation) {
  const Time t_zero = time_zero(input);
  RowSet rows(input.estimate.has_causal ? "causal" : "final");
  Series path{"path_estimate", "x [m]", "y [m]", {}, {}, {}, {}};
  for (const SweepResult& sweep : input.estimate.sweeps) {
    if (sweep.status != SweepStatus::ok) continue;
    path.x.push_back(sweep.T_map_body.translation().x());
    path.y.push_back(sweep.T_map_body.translation().y());
  }
  put_coverage(path.x.size(), input.sweeps.count, rows, evaluation.coverage);
  add_run_figures(input, settings, t_zero, rows, evaluation);
  evaluation.series.push_back(std::move(path));
  add_timing(input, settings, nullptr, rows, evaluation);
  rows.all_missing("the recording has no truth");
  keep_rows(rows, evaluation);
}

}  // namespace

Evaluation evaluate(const EvaluationInput& input, const EvaluateSettings& settings) {
  check(input);
  Evaluation evaluation;
  if (input.truth) evaluation.scenario = input.truth->scenario;
  if (input.truth) evaluation.seed = input.truth->seed;
  evaluation.estimator = input.estimate.estimator;
  if (input.estimate.status != RunStatus::ok) evaluation.status = name_of(input.estimate.status);
  evaluation.message = input.estimate.message;
  if (!input.truth) {
    evaluate_alone(input, settings, evaluation);
    return evaluation;
  }
  if (input.estimate.has_causal || !input.estimate.has_final)
    evaluate_subject(input, settings,
                     {"causal", false, input.estimate.causal, pair_poses(input.estimate, false, *input.truth->motion)},
                     true, evaluation);
  if (input.estimate.has_final)
    evaluate_subject(input, settings,
                     {"final", true, input.estimate.final, pair_poses(input.estimate, true, *input.truth->motion)},
                     !input.estimate.has_causal, evaluation);
  return evaluation;
}

}  // namespace tarmac::metrics
