/// Splines drawn through sampled poses: a start for problems over a whole run.
#pragma once

#include <span>
#include <vector>

#include "core/spline_trajectory.h"

namespace tarmac::core {

struct SplineFitSettings {
  /// Weight of the integral over time of |a_world|^2 + |alpha_body|^2 (SI), against the sum of squared differences of
  /// poses (metres and radians alike). Above 0 it also settles control points that no pose bears on.
  double smoothness = 1e-6;
  int max_iterations = 20;
  double tolerance = 1e-10;  ///< ends when no parameter moves by more [m, rad]
};

/// The spline on these knots that comes closest to poses at ascending times (least squares by Gauss-Newton; the
/// positions of a split spline are linear, so that the first step is the last for them). Throws InputError where times
/// do not ascend, lie outside the knots' span or number other than the poses, and where control points are left
/// undetermined.
SplineTrajectory fit_spline(SplineKind kind, int order, std::vector<Time> knots, std::span<const Time> times,
                            std::span<const SE3> T_world_body, const SplineFitSettings& settings = {});

}  // namespace tarmac::core
