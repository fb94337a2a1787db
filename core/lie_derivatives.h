/// Derivatives of the Jacobians of SE(3), exact; lie.h has the Jacobians and the conventions.
#pragma once

#include "core/lie.h"

namespace tarmac::core::se3 {

/// The bracket: curly_hat(a) b = -curly_hat(b) a, and Ad(Exp(xi)) is the matrix exponential of curly_hat(xi).
Matrix6 curly_hat(const Vector6& xi);
/// d(Jr(xi) w)/dxi and d(Jr^-1(xi) w)/dxi: Jr and its inverse are polynomials of degree 4 in curly_hat(xi) whose
/// coefficients depend on the angle alone.
Matrix6 right_jacobian_derivative(const Vector6& xi, const Vector6& w);
Matrix6 right_jacobian_inverse_derivative(const Vector6& xi, const Vector6& w);
/// d/ds of Jr(xi + s w) w at s = 0: what the body-centric velocity Jr(xi) w changes by while xi moves on at w. `by_xi`
/// and `by_w`, where given, are its Jacobians.
Vector6 right_jacobian_rate(const Vector6& xi, const Vector6& w, Matrix6* by_xi = nullptr, Matrix6* by_w = nullptr);

}  // namespace tarmac::core::se3
