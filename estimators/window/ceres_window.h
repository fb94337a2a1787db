/// The same problem solved by Ceres.
#pragma once

#include "estimators/window/window.h"

namespace tarmac::estimators {

/// What Ceres's damping multiplies: the diagonal of its scaled normal equations, or the identity (for comparison with
/// BandedSystem::solve_with_identity).
enum class CeresDamping : std::uint8_t { diagonal, identity };

/// Levenberg-Marquardt on all unknowns of the window, one thread, no time limit; robust losses as Ceres corrects for
/// them (to second order). Unknowns are increments of the present state, value (+) d, with exact Jacobians by d. Of the
/// settings, max_iterations, initial_lambda (one over the trust region's radius), relative_decrease and `lidar` count.
///
/// What a residual depends on is settled at the start: where a free time offset moves a reading by more than one block
/// of the trajectory, its Jacobian loses the columns beyond, its value stays exact. ok = false leaves the state as it
/// was.
SolveReport solve_with_ceres(Window& window, const SolveSettings& settings,
                             CeresDamping damping = CeresDamping::diagonal);

}  // namespace tarmac::estimators
