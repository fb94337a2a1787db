/// Whether a method's own covariance tells how far off its poses are.
///
/// With T the true pose carried into the method's map by the first scored pose, and T^ the estimate, the error is
/// xi = Log(T^-1 T) in the body's frame, translation first, and NEES = xi^T P^-1 xi with the covariance P that the
/// method states. If P tells the truth, NEES is chi-squared with 6 degrees of freedom: its mean over sweeps (ANEES) is
/// 6, and 95 % of the sweeps lie below 12.59. A method that builds its own map knows nothing of that map's drift,
/// and no bound is set. Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation,
/// 2001, 5.4.
#pragma once

#include <vector>

#include "core/diagnostics.h"
#include "metrics/evaluation.h"
#include "metrics/pose_pairs.h"
#include "metrics/row_set.h"
#include "metrics/sweep_source.h"

namespace tarmac::metrics {

/// A sweep's stated covariance.
struct StatedCovariance {
  std::int64_t index = 0;
  core::Matrix6 covariance = core::Matrix6::Zero();
};
/// Those of the sweeps that state one.
std::vector<StatedCovariance> stated_covariances(const DiagnosticsSource& diagnostics);

/// NEES of each scored sweep that has a positive definite covariance; the first pair, which fixes the frame, has none.
struct Nees {
  core::Time t;
  double nees = 0;
};
/// @param left_out is added to for every covariance that is not positive definite
std::vector<Nees> nees_of(const std::vector<PosePair>& pairs, const std::vector<StatedCovariance>& stated,
                          std::size_t& left_out);

/// The registry's rows of family `consistency`, and the series nees_vs_time (NEES/6). `diagnostics` may be nullptr:
/// n/a.
void add_consistency(const std::vector<PosePair>& pairs, const DiagnosticsSource* diagnostics, core::Time t_zero,
                     RowSet& rows, std::vector<Series>& series);

}  // namespace tarmac::metrics
