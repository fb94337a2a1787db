/// What the error inside the sweeps goes with: the motion itself, or its change.
#pragma once

#include <vector>

#include "metrics/block_bootstrap.h"
#include "metrics/evaluation.h"
#include "metrics/residual_sweep.h"

namespace tarmac::metrics {

/// A sweep's slope and bend, regressed on its mean twist (v, w) and the change of it over the sweep (dv, dw), both over
/// the span D that phase 0 to 1 stands for:
///   slope = k D twist - d dtwist + noise,     bend = -1/2 g D dtwist + noise
/// with k, d and g apart for translation and rotation.
///   k: share by which the motion is overdone. Stamps that run k_t times as fast as time give 1 - 1 / k_t: a reversal
///   2,
///      a unit too small by 1000 -999. A motion that is not undone at all gives -1.
///   d: how late the motion inside the sweep is [s]. A clock offset of an IMU's; or one sweep, where the motion of the
///      sweep before stands in.
///   g: share of the acceleration inside the sweep that is left out: 1 for a constant twist.
///
/// Sweeps are weighted by the information of their fit, broadened by the excess spread that they show about the
/// regression, and by Huber's weight. Intervals: moving-block bootstrap over sweeps (heteroscedastic, and neighbours
/// share a map).
struct SlopeFit {
  std::size_t sweeps = 0;  ///< used
  bool inside = false;     ///< dtwist was read off the estimate's motion inside the sweeps
  double span_s = 0;       ///< median D
  double rate_change_rms_rad_s = 0, speed_change_rms_m_s = 0;  ///< rms of |dw| and |dv|: what there was to see it by
  Bootstrapped scale_translation, scale_rotation;              ///< k
  Bootstrapped lag_translation_s, lag_rotation_s;              ///< d
  Bootstrapped omitted_translation, omitted_rotation;          ///< g
  Bootstrapped quantum_s;  ///< motion unseen within one stamp; sigma 0 where it was not asked for
};

SlopeFit fit_slopes(const std::vector<SweepResiduals>& sweeps, const BootstrapSettings& settings);

/// Series residual_slope_vs_domega, residual_slope_vs_dv: the slope's rotation [deg] over dw [deg/s] and its
/// translation [m] over dv [m/s], three points a sweep (forward, left, up); and the fitted lines, ..._fit.
void add_slope_series(const std::vector<SweepResiduals>& sweeps, const SlopeFit& fit, std::vector<Series>& series);

}  // namespace tarmac::metrics
