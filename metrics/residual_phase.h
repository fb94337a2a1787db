/// Residuals over the place in the sweep, pooled over sweeps.
#pragma once

#include <vector>

#include "metrics/block_bootstrap.h"
#include "metrics/evaluation.h"
#include "metrics/residual_sweep.h"

namespace tarmac::metrics {

/// A trend of the implied displacement over the phase s, per body axis: slope is its change from s = 0 to 1, bend the
/// depth of a parabola from mid-sweep to the ends, both least squares over the bins.
struct PhaseTrend {
  Bootstrapped slope_m[3], bend_m[3];
};

/// Implied displacement of a bin: d = argmin sum w (n^T d - r)^2, in the body's axes; NaN where the bin's surfaces
/// leave one of its axes open (smallest eigenvalue of the mean n n^T below 0.003). Comparable across methods and
/// sensors.
Eigen::Vector3d implied_displacement(const PhaseBin& bin);

/// Series residual_mean_by_phase, residual_spread_by_phase and displacement_{forward,left,up}_by_phase, bands from
/// bootstrapping over sweeps, and the trends that the displacement has.
PhaseTrend add_phase_series(const std::vector<SweepResiduals>& sweeps, const BootstrapSettings& settings,
                            std::vector<Series>& series);

}  // namespace tarmac::metrics
