#include "metrics/lag.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/statistics.h"
#include "metrics/trajectory_error.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr std::size_t kFewestMotions = 20;
constexpr double kHuber = 1.345;
constexpr double kStep = 1e-3;  // [s] of the central difference

/// One motion from a reference instant to the next.
struct Motion {
  const PosePair *from, *to;
  Vector6 estimated;
};

std::vector<Motion> motions_of(const std::vector<PosePair>& pairs) {
  std::vector<Motion> motions;
  for (std::size_t k = 1; k < pairs.size(); ++k)
    if (pairs[k].index == pairs[k - 1].index + 1)
      motions.push_back({&pairs[k - 1], &pairs[k], se3::log(pairs[k - 1].T_map_body.inverse() * pairs[k].T_map_body)});
  return motions;
}

std::optional<Vector6> true_motion(const Motion& m, const Trajectory& truth, double lag_s) {
  const Duration lag = duration_from_s(lag_s);
  if (!truth.covers(m.from->t - lag) || !truth.covers(m.to->t - lag)) return std::nullopt;
  return se3::log(truth.pose(m.from->t - lag).inverse() * truth.pose(m.to->t - lag));
}

/// A motion's error at some lag, and how the error changes with it.
struct Term {
  Vector6 error, derivative;
};

std::vector<Term> terms_at(const std::vector<Motion>& motions, const Trajectory& truth, double lag_s) {
  std::vector<Term> terms;
  for (const Motion& m : motions) {
    const auto here = true_motion(m, truth, lag_s), before = true_motion(m, truth, lag_s - kStep),
               after = true_motion(m, truth, lag_s + kStep);
    if (here && before && after) terms.push_back({m.estimated - *here, -(*after - *before) / (2 * kStep)});
  }
  return terms;
}

/// 1 / spread^2 of each component's errors.
Vector6 component_weights(const std::vector<Term>& terms) {
  Vector6 w;
  for (int c = 0; c < 6; ++c) {
    std::vector<double> off;
    for (const Term& term : terms) off.push_back(std::abs(term.error[c]));
    const double sigma = std::max(1e-9, 1.4826 * quantile(std::move(off), 0.5));
    w[c] = 1 / (sigma * sigma);
  }
  return w;
}

struct Sums {
  double H = 0, g = 0;
};

std::vector<Sums> sums_of(const std::vector<Term>& terms) {
  const Vector6 w = component_weights(terms);
  std::vector<Sums> sums;
  for (const Term& term : terms) {
    const double distance = std::sqrt((w.array() * term.error.array().square()).mean());
    const double huber = distance > kHuber ? kHuber / distance : 1;
    sums.push_back({huber * (w.array() * term.derivative.array().square()).sum(),
                    -huber * (w.array() * term.derivative.array() * term.error.array()).sum()});
  }
  return sums;
}

double step_of(const std::vector<Sums>& sums, const std::vector<int>* times) {
  Sums all;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double n = times ? (*times)[k] : 1;
    all.H += n * sums[k].H;
    all.g += n * sums[k].g;
  }
  return all.H > 0 ? all.g / all.H : 0;
}

double ate_m(const std::vector<PosePair>& pairs, Alignment alignment) {
  const std::optional<Fit> fit = align(pairs, alignment, false);
  return fit ? rms(position_errors_m(pairs, fit->A)) : std::nan("");
}

double ate_at(const std::vector<PosePair>& pairs, const Trajectory& truth, double lag_s) {
  return ate_m(shifted(pairs, truth, lag_s), Alignment::se3);
}

Series curve(const std::vector<PosePair>& pairs, const Trajectory& truth, double lag_s) {
  Series s{"error_vs_lag", "lag of the estimate [ms]", "ATE after SE(3) alignment [m]", {}, {}, {}, {}};
  const double reach_s = std::max(0.02, 2 * std::abs(lag_s));
  for (int k = -20; k <= 20; ++k) {
    const double at_s = reach_s * k / 20;
    s.x.push_back(1e3 * at_s);
    s.y.push_back(ate_at(pairs, truth, at_s));
  }
  return s;
}

}  // namespace

std::vector<PosePair> shifted(const std::vector<PosePair>& pairs, const Trajectory& truth, double lag_s) {
  const Duration lag = duration_from_s(lag_s);
  std::vector<PosePair> moved;
  for (PosePair pair : pairs) {
    if (!truth.covers(pair.t - lag)) continue;
    pair.T_world_body = truth.pose(pair.t - lag);
    moved.push_back(pair);
  }
  return moved;
}

std::optional<LagFit> fit_lag(const std::vector<PosePair>& pairs, const Trajectory& truth,
                              const BootstrapSettings& settings) {
  const std::vector<Motion> motions = motions_of(pairs);
  LagFit fit;
  double lag_s = 0;
  std::vector<Sums> sums;
  for (int round = 0; round < 10; ++round) {
    const std::vector<Term> terms = terms_at(motions, truth, lag_s);
    fit.motions = terms.size();
    if (terms.size() < kFewestMotions) return std::nullopt;
    sums = sums_of(terms);
    const double step = std::clamp(step_of(sums, nullptr), -0.05, 0.05);
    lag_s += step;
    if (std::abs(step) < 1e-7) break;
  }
  double H = 0;
  for (const Sums& s : sums) H += s.H;
  // In units of one motion's error: what 0.1 s of lag would do to all of them.
  if (0.01 * H < 1) return std::nullopt;
  std::vector<double> replicates;
  for (const std::vector<int>& times : block_bootstrap(sums.size(), settings, "metrics/lag"))
    replicates.push_back(lag_s + step_of(sums, &times));
  fit.lag_s = bootstrapped(lag_s, replicates);
  fit.ate_slope_m_s = (ate_at(pairs, truth, kStep) - ate_at(pairs, truth, -kStep)) / (2 * kStep);
  return fit;
}

std::optional<LagFit> add_lag(const std::vector<PosePair>& pairs, const Trajectory& truth, bool faults, RowSet& rows,
                              std::vector<Series>& series) {
  const std::optional<LagFit> fit = fit_lag(pairs, truth, {});
  const char* const kCorrected[] = {"ate_first_pose_lag_corrected_rmse_m", "ate_se3_lag_corrected_rmse_m"};
  if (!fit) {
    const std::string why =
        "fewer than 20 motions between neighbouring sweeps, or speed and rate of turn hardly change";
    for (const char* metric : {"time_lag_ms", "ate_per_lag_m_per_s", kCorrected[0], kCorrected[1]})
      rows.missing(metric, why);
    return fit;
  }
  rows.put("time_lag_ms", 1e3 * fit->lag_s.value);
  rows.interval("time_lag_ms", 1e3 * fit->lag_s.low, 1e3 * fit->lag_s.high);
  rows.put("ate_per_lag_m_per_s", fit->ate_slope_m_s);
  const std::vector<PosePair> corrected = shifted(pairs, truth, fit->lag_s.value);
  const std::string note = fmt::format("truth taken {:.3f} ms earlier", 1e3 * fit->lag_s.value);
  for (const char* metric : kCorrected) {
    if (!faults) {
      rows.missing(metric, "no fault was injected");
      continue;
    }
    rows.put(metric, ate_m(corrected, metric == kCorrected[0] ? Alignment::first_pose : Alignment::se3), note);
  }
  series.push_back(curve(pairs, truth, fit->lag_s.value));
  return fit;
}

}  // namespace tarmac::metrics
