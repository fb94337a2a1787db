/// The same problem solved by Ceres.
#pragma once

#include "estimators/window/window.h"

namespace tarmac::estimators {

struct CeresSettings {
  int max_iterations = 50;
  /// Relative fall of the cost, and relative size of a step, below which it ends.
  double function_tolerance = 1e-10, parameter_tolerance = 1e-10;
  double initial_radius = 1e4;  ///< of the trust region: the first lambda is 1 over it
  /// Damping by lambda I instead of lambda diag(H) scaled: for comparison with BandedSystem::solve_with_identity.
  bool identity_damping = false;
};

/// Levenberg-Marquardt on all unknowns of the window, one thread, no time limit; robust losses as Ceres corrects for
/// them (to second order). Unknowns are increments of the present state, value (+) d, with exact Jacobians by d.
///
/// What a residual depends on is settled at the start: where a free time offset moves a reading by more than one block
/// of the trajectory, its Jacobian loses the columns beyond, its value stays exact. ok = false leaves the state as it
/// was.
SolveReport solve_with_ceres(Window& window, const CeresSettings& settings);

}  // namespace tarmac::estimators
