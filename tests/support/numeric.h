/// Numeric twins for analytic derivatives, and matchers for poses.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/lie.h"

namespace tarmac::tests {

/// Central differences of f: R^N -> R^M at x.
template <int M, int N, class F>
Eigen::Matrix<double, M, N> numeric_jacobian(const F& f, const Eigen::Matrix<double, N, 1>& x, double step = 1e-6) {
  Eigen::Matrix<double, M, N> J;
  for (int k = 0; k < N; ++k) {
    Eigen::Matrix<double, N, 1> high = x, low = x;
    high[k] += step;
    low[k] -= step;
    J.col(k) = (f(high) - f(low)) / (2 * step);
  }
  return J;
}

/// Jacobian of a function SE(3) -> SE(3), right perturbations on both sides.
template <class F>
core::Matrix6 numeric_pose_jacobian(const F& f, const core::SE3& T, double step = 1e-6) {
  core::Matrix6 J;
  for (int k = 0; k < 6; ++k) {
    core::Vector6 d = core::Vector6::Zero();
    d[k] = step;
    J.col(k) = core::se3::log(f(T * core::se3::exp(-d)).inverse() * f(T * core::se3::exp(d))) / (2 * step);
  }
  return J;
}

/// |A - B| relative to the larger of |B| and 1.
template <class A, class B>
double relative_difference(const A& a, const B& b) {
  return (a - b).norm() / std::max(1.0, b.norm());
}

/// Distance of two poses: metres and radians added.
inline double pose_difference(const core::SE3& a, const core::SE3& b) {
  return (a.translation() - b.translation()).norm() + core::so3::angle_rad(a.linear().transpose() * b.linear());
}

}  // namespace tarmac::tests
