/// The blend that speeds and curvatures change by: 0 before 0, 1 after 1, infinitely differentiable everywhere.
///
///   h(u) = (1 + tanh(w(u) / 2)) / 2,   w(u) = 1/(1 - u) - 1/u,   0 < u < 1
///
/// All derivatives vanish at both ends, so rest is exactly rest and a straight is exactly straight. h is no polynomial
/// and not even analytic at its ends: no spline equals it. Steepest at the middle: h'(1/2) = 2. h(1 - u) = 1 - h(u).
#pragma once

#include "scenes/paths/jet.h"

namespace tarmac::scenes {

/// h with three derivatives by u.
Jet smooth_step(double u);

/// Integral of h from 0 to u: u - 1/2 for u >= 1. Absolute error below 1e-15.
double smooth_step_integral(double u);

/// Integral of smooth_step_integral from 0 to u. Absolute error below 1e-15 for u up to 1, and relative beyond.
double smooth_step_second_integral(double u);

/// h' at its steepest.
inline constexpr double smooth_step_peak_slope = 2.0;

}  // namespace tarmac::scenes
