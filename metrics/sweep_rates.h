/// How fast the estimate moves in each sweep, and how much that changes from the sweep's begin to its end.
#pragma once

#include <cstdint>
#include <map>

#include "core/estimate.h"

namespace tarmac::metrics {

struct SweepRates {
  core::Time begin, end;
  core::Vector6 twist = core::Vector6::Zero();   ///< mean over the sweep, body axes [m/s, rad/s]
  core::Vector6 change = core::Vector6::Zero();  ///< of the twist over the sweep, by its linear trend [m/s, rad/s]
  /// Read off the estimate's motion inside the sweep; otherwise off the reference poses of the neighbours.
  bool inside = false;
};

/// By sweep index; sweeps that are not `ok`, or whose neighbours do not tell, are absent. Everything comes from the
/// estimate itself, so that it means the same with truth and without: for a method that places points by an IMU it is
/// the IMU's motion. Segments with one pose or two have no change of their own; there the mean twists from one
/// reference instant to the next are differenced.
std::map<std::int64_t, SweepRates> sweep_rates(const core::Estimate& estimate);

}  // namespace tarmac::metrics
