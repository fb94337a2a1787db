#include "estimators/dead_reckoning/propagate.h"

#include <cmath>

namespace tarmac::estimators {

using core::SE3;
using Eigen::Matrix3d;
using Eigen::Vector3d;

SE3 InertialState::T_map_imu() const {
  SE3 T = SE3::Identity();
  T.linear() = R_map_imu;
  T.translation() = p_map_m;
  return T;
}

Matrix3d second_integral(const Vector3d& phi) {
  // 1/2 + (a - sin a) / a^3 K + (cos a - 1 + a^2 / 2) / a^4 K^2; below 0.2 rad the closed forms lose digits.
  const double a2 = phi.squaredNorm(), a = std::sqrt(a2);
  const Matrix3d K = core::so3::hat(phi);
  double b = 0, c = 0;
  if (a < 0.2) {
    b = 1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 * (1.0 / 362880 - a2 / 39916800)));
    c = 1.0 / 24 - a2 * (1.0 / 720 - a2 * (1.0 / 40320 - a2 * (1.0 / 3628800 - a2 / 479001600)));
  } else {
    b = (a - std::sin(a)) / (a2 * a);
    c = (std::cos(a) - 1 + a2 / 2) / (a2 * a2);
  }
  return 0.5 * Matrix3d::Identity() + b * K + c * K * K;
}

InertialState propagate(const InertialState& state, const Vector3d& omega_rad_s, const Vector3d& f_m_s2,
                        double gravity_m_s2, core::Time to) {
  const double dt = core::to_s(to - state.t);
  const Vector3d phi = omega_rad_s * dt, g_map(0, 0, -gravity_m_s2);
  InertialState next;
  next.t = to;
  SE3 R = SE3::Identity();
  R.linear() = state.R_map_imu * core::so3::exp(phi);
  next.R_map_imu = core::se3::normalized(R).linear();
  const Vector3d dv = state.R_map_imu * (core::so3::left_jacobian(phi) * f_m_s2) + g_map;
  const Vector3d dp = state.R_map_imu * (second_integral(phi) * f_m_s2) + 0.5 * g_map;
  next.v_map_m_s = state.v_map_m_s + dt * dv;
  next.p_map_m = state.p_map_m + dt * state.v_map_m_s + dt * dt * dp;
  return next;
}

}  // namespace tarmac::estimators
