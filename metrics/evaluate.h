/// Estimate x ground truth -> Evaluation.
///
/// Series, of the headline estimate (causal, or final for a batch method); x and y of paths are world coordinates:
///
///   path_true, path_estimate: [m] at the sweeps' ends, the estimate after first-pose alignment (NaN: not scored);
///     without truth path_estimate is in the map's own frame, and there is no path_true
///
///   error_vs_time, error_vs_distance: position error after first-pose alignment
///
///   error_{along,cross,height,yaw,tilt}_vs_time: the same, signed and split in the level axes of the true heading
///
///   drift_vs_distance: error of the motion along stretches of a length, with its band
///
///   drift_{along,cross,height,yaw,tilt}_vs_{distance,duration}: the same, split
///
///   reference_error_by_phase: where in the sweep the estimate bends, seen from the sweep's reference instant: the one
///     to show; without deskewing it rises to v x T at the far end
///
///   deskew_error_by_phase, point_error_by_phase: the same after the sweep's best fit; and with drift
///
///   deskew_error_vs_time, sweep_time_vs_time, iterations_vs_time: a value a sweep
///
///   speed_vs_time, yaw_rate_vs_time: the true motion
///
///   residual_mean_by_phase, residual_spread_by_phase: point-to-surface residuals over the point's time in the sweep,
///     signed mean (positive: in front of the surface) and spread, with 95 % bands from bootstrapping over sweeps
///
///   displacement_{forward,left,up}_by_phase: what displacement of the points in body axes those residuals imply
///
///   residual_slope_vs_domega, residual_slope_vs_dv and ..._fit: each sweep's slope over the change of motion in it
///     (residual_slope.h), and the fitted line with +- 1 sigma
///
///   nees_vs_time: squared pose error in terms of the stated covariance, per degree of freedom (consistency.h)
///
///   error_vs_lag: ATE with the truth taken earlier by a lag
///
///   and those of degeneracy/degeneracy.h
///
/// Findings: timing's topics (diagnosis.h).
#pragma once

#include "core/diagnostics.h"
#include "core/estimate.h"
#include "core/recording.h"
#include "metrics/evaluation.h"
#include "metrics/sweep_source.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

struct Oracle;  // degeneracy/oracle.h

struct EvaluateSettings {
  int threads = 1;
  std::size_t map_points = 150000;  ///< size of the map sample for pictures
  int phase_bins = 32;
};

/// The series of error by sweep phase that a report shows.
inline constexpr const char* kHeadlinePhaseSeries = "reference_error_by_phase";

struct EvaluationInput {
  const core::Estimate& estimate;
  SweepSource sweeps;
  /// nullptr for a recording from outside: what needs the truth is n/a then.
  const sim::truth::GroundTruth* truth = nullptr;
  const std::vector<sim::truth::PointLabels>* labels = nullptr;  ///< one a sweep of the recording; goes with the truth
  const core::RunTiming* timing = nullptr;                       ///< nullptr: cost is n/a
  const DiagnosticsSource* diagnostics = nullptr;                ///< nullptr: what is read from them is n/a
  const Oracle* oracle = nullptr;                                ///< nullptr: what is compared with it is n/a
};

/// All metrics: every one of the registry has a row, with a value or the reason why not. A function of the input alone:
/// the same bytes at any number of threads. Throws InputError when truth and recording do not belong together.
Evaluation evaluate(const EvaluationInput& input, const EvaluateSettings& settings);

/// The same with labels from the truth's folder. `truth`, `timing`, `diagnostics` and `oracle` may be nullptr; the
/// oracle is the recording's (make_oracle), for all its estimates.
Evaluation evaluate(const core::Estimate& estimate, const core::Recording& recording,
                    const sim::truth::GroundTruth* truth, const core::RunTiming* timing,
                    const EvaluateSettings& settings, const DiagnosticsSource* diagnostics = nullptr,
                    const Oracle* oracle = nullptr);

}  // namespace tarmac::metrics
