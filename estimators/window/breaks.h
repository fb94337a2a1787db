/// Where the pieces of a trajectory meet.
#pragma once

#include <vector>

#include "core/parametric_trajectory.h"

namespace tarmac::estimators {

/// The times at which the run of blocks changes that the motion depends on (a model's knots within its span),
/// ascending, begin() first and end() last. Found by bisection to the nanosecond, whatever the model.
std::vector<core::Time> breaks(const core::ParametricTrajectory& trajectory);

}  // namespace tarmac::estimators
