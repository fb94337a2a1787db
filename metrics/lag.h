/// The constant lag in time that brings estimate and truth closest.
#pragma once

#include <optional>
#include <vector>

#include "metrics/block_bootstrap.h"
#include "metrics/evaluation.h"
#include "metrics/pose_pairs.h"
#include "metrics/row_set.h"

namespace tarmac::metrics {

/// lag > 0: the estimate is late, T^(t) = T(t - lag).
struct LagFit {
  Bootstrapped lag_s;
  std::size_t motions = 0;   ///< from one sweep's reference instant to the next
  double ate_slope_m_s = 0;  ///< d ATE / d lag at lag 0, SE(3)-aligned
};

/// The lag from the motions between neighbouring reference instants, E_k = Log(T^_k^-1 T^_k+1) against
/// P_k(lag) = Log(T(t_k - lag)^-1 T(t_k+1 - lag)): they carry no drift. Each of the six components is weighted by the
/// robust spread of its own errors, Huber's weight a motion; Gauss-Newton. Empty below 20 motions, or where speed and
/// rate of turn hardly change (an error of 0.1 s in the lag would not exceed what one motion errs by).
std::optional<LagFit> fit_lag(const std::vector<PosePair>& pairs, const core::Trajectory& truth,
                              const BootstrapSettings& settings);

/// The same pairs with the truth `lag_s` earlier. Pairs that the truth then does not cover are left out.
std::vector<PosePair> shifted(const std::vector<PosePair>& pairs, const core::Trajectory& truth, double lag_s);

/// Rows time_lag_ms, ate_per_lag_m_per_s, and ate_*_lag_corrected_rmse_m where a fault was injected; series
/// error_vs_lag.
std::optional<LagFit> add_lag(const std::vector<PosePair>& pairs, const core::Trajectory& truth, bool faults,
                              RowSet& rows, std::vector<Series>& series);

}  // namespace tarmac::metrics
