/// SO(3) and SE(3) written alike, for the recursions of spline_jet.cpp; nobody else needs it.
///
/// The adjoint of SE(3) and all functions of it are 6x6 matrices [X Y; 0 X], that is X + eps Y with eps^2 = 0, and a
/// tangent (rho, phi) is phi + eps rho. So the formulas of SO(3) hold for SE(3) as they stand, over dual numbers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/lie.h"
#include "core/spline_interval.h"

namespace tarmac::core {

/// Below it, dividing by the angle could overflow; what is neglected is far below the smallest digit of any pose.
inline constexpr double kNoAngle_rad = 1e-100;

/// A_j = Exp(lambda d): its rotation, and (se3) its translation.
struct SplineFactor {
  double w;
  Eigen::Vector3d xyz;
  Eigen::Vector3d t_m;
};

/// Sine and cosine of an angle in [0, pi/2], to 2 units in the last place of 1: no step turns by more than pi, of which
/// this is at most half. Taylor's series at half the angle. Value: double, or an array of them, two of which fit a
/// register.
template <class Value>
inline void sine_cosine(const Value& angle_rad, Value& sine, Value& cosine) {
  const Value x = 0.5 * angle_rad, y = x * x;
  const Value s =
      x * (1 - y * (1. / 6 -
                    y * (1. / 120 -
                         y * (1. / 5040 -
                              y * (1. / 362880 - y * (1. / 39916800 - y * (1. / 6227020800. - y / 1307674368000.)))))));
  const Value c =
      1 - y * (1. / 2 -
               y * (1. / 24 -
                    y * (1. / 720 -
                         y * (1. / 40320 - y * (1. / 3628800 - y * (1. / 479001600. -
                                                                    y * (1. / 87178291200. - y / 20922789888000.)))))));
  sine = 2 * s * c;
  cosine = 1 - 2 * s * s;
}

template <bool kTranslates>
inline SplineFactor factor_of(const SplineStep& step, double lambda, double s, double c) {
  SplineFactor factor;
  factor.w = c;
  factor.xyz = s * step.axis;
  if constexpr (kTranslates) {
    // The integral of Exp(s d) rho over s: sin and 1 - cos of the whole angle.
    factor.t_m = lambda * step.along_m + (2 * s * c) * step.across_m + (2 * s * s) * step.turned_m;
  }
  return factor;
}

template <bool kTranslates>
inline SplineFactor factor_of(const SplineStep& step, double lambda) {
  double s, c;
  sine_cosine<double>(0.5 * lambda * step.angle_rad, s, c);
  return factor_of<kTranslates>(step, lambda, s, c);
}

inline Eigen::Quaterniond quaternion_of(const SplineFactor& f) {
  return {f.w, f.xyz.x(), f.xyz.y(), f.xyz.z()};
}

/// real + eps dual: a tangent (phi + eps rho) or a matrix.
template <class Part>
struct Dual {
  Part real, dual;
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.real + b.real, a.dual + b.dual}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.real - b.real, a.dual - b.dual}; }
  friend Dual operator*(double s, const Dual& a) { return {s * a.real, s * a.dual}; }
};
using DualVector = Dual<Eigen::Vector3d>;
using DualMatrix = Dual<Eigen::Matrix3d>;
template <class Part>
inline Dual<Part> operator*(const DualMatrix& a, const Dual<Part>& b) {
  return {a.real * b.real, a.real * b.dual + a.dual * b.real};
}

struct RotationGroup {
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  static Vector zero() { return Vector::Zero(); }
  static Matrix scaled_identity(double s) { return s * Eigen::Matrix3d::Identity(); }
  static Matrix hat(const Vector& v) { return so3::hat(v); }
  static Vector d(const SplineStepJacobians& step) { return step.phi; }
  static Matrix right_inverse(const SplineStepJacobians& step) { return step.right_inverse_real; }
  static Matrix left_inverse(const SplineStepJacobians& step) { return step.left_inverse_real; }
  /// Ad(Exp(lambda d))^-1
  static Matrix adjoint_inverse(const SplineStep& step, double lambda) {
    return quaternion_of(factor_of<false>(step, lambda)).toRotationMatrix().transpose();
  }
  /// lambda Jr(lambda d)
  static Matrix scaled_jacobian(const SplineStep& step, const SplineStepJacobians&, double lambda) {
    if (step.angle_rad < kNoAngle_rad) return lambda * Eigen::Matrix3d::Identity();
    double s, c;
    sine_cosine<double>(0.5 * lambda * step.angle_rad, s, c);
    const double sine = 2 * s * c / step.angle_rad, rest = 2 * s * s / step.angle_rad;
    return sine * Eigen::Matrix3d::Identity() + (lambda - sine) * step.axis * step.axis.transpose() -
           rest * so3::hat(step.axis);
  }
};

/// B = (1 - cos x)/x^2, C = (x - sin x)/x^3 and their derivatives over x; series below x = 0.2, where the closed forms
/// lose digits.
struct JacobianCoefficients {
  double B, C, B1, C1;
};
inline JacobianCoefficients jacobian_coefficients(double x) {
  const double y = x * x;
  if (x < 0.2) {
    return {1. / 2 - y * (1. / 24 - y * (1. / 720 - y * (1. / 40320 - y * (1. / 3628800 - y / 479001600)))),
            1. / 6 - y * (1. / 120 - y * (1. / 5040 - y * (1. / 362880 - y * (1. / 39916800 - y / 6227020800.)))),
            -2. / 24 + y * (4. / 720 - y * (6. / 40320 - y * (8. / 3628800 - y * (10. / 479001600)))),
            -2. / 120 + y * (4. / 5040 - y * (6. / 362880 - y * (8. / 39916800 - y * (10. / 6227020800.))))};
  }
  const double s = std::sin(x), half_s = std::sin(0.5 * x);
  const double A = s / x, B = 2 * half_s * half_s / y, C = (x - s) / (y * x);
  return {B, C, (A - 2 * B) / y, (B - 3 * C) / y};
}

struct PoseGroup {
  using Vector = DualVector;
  using Matrix = DualMatrix;
  static Vector zero() { return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }
  static Matrix scaled_identity(double s) { return {s * Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero()}; }
  static Matrix hat(const Vector& v) { return {so3::hat(v.real), so3::hat(v.dual)}; }
  static Vector d(const SplineStepJacobians& step) { return {step.phi, step.rho}; }
  static Matrix right_inverse(const SplineStepJacobians& s) { return {s.right_inverse_real, s.right_inverse_dual}; }
  static Matrix left_inverse(const SplineStepJacobians& s) { return {s.left_inverse_real, s.left_inverse_dual}; }
  static Matrix adjoint_inverse(const SplineStep& step, double lambda) {
    const SplineFactor factor = factor_of<true>(step, lambda);
    const Eigen::Matrix3d R_inverse = quaternion_of(factor).toRotationMatrix().transpose();
    return {R_inverse, -R_inverse * so3::hat(factor.t_m)};
  }
  /// lambda Jr(lambda phi) = lambda I - lambda^2 B phi^ + lambda^3 C phi^ phi^ with B, C at x = lambda |phi|, and its
  /// derivative along rho.
  static Matrix scaled_jacobian(const SplineStep& step, const SplineStepJacobians& jacobians, double lambda) {
    const JacobianCoefficients c = jacobian_coefficients(lambda * step.angle_rad);
    const Eigen::Matrix3d P = so3::hat(jacobians.phi), R = so3::hat(jacobians.rho), PP = P * P, PR = P * R;
    const double l2 = lambda * lambda, l3 = l2 * lambda, turn = l2 * jacobians.phi.dot(jacobians.rho);
    // R P is the transpose of P R: both are products of two skew matrices.
    return {lambda * Eigen::Matrix3d::Identity() - l2 * c.B * P + l3 * c.C * PP,
            -l2 * (c.B * R + turn * c.B1 * P) + l3 * (c.C * (PR + PR.transpose()) + turn * c.C1 * PP)};
  }
};

}  // namespace tarmac::core
