/// A specific force against an accelerometer's reading.
#pragma once

#include "estimators/window/state_jacobian.h"

namespace tarmac::estimators {

/// With the IMU at l in the body:
///   r = R_imu_body ( R^T (a - g) + alpha x l + omega x (omega x l) ) + b - m   [m/s^2], in the IMU's frame
/// g points down; static and level, b = 0: m = (0, 0, +|g|). By the bias: the identity.
///
/// omit_transport takes R^T (a - g) - omega x (R^T v) instead of R^T (a - g): the derivative of the body-centric
/// velocity in the place of the acceleration, as upstream STEAM has it. For comparison only: it is off by |omega| |v|.
/// Source: Furgale, Rehder, Siegwart, IROS 2013, eq. 11; the lever arm by differentiating p + R l twice.
struct AccelerometerResidual {
  Eigen::Vector3d measured_m_s2 = Eigen::Vector3d::Zero();
  core::SE3 T_body_imu = core::SE3::Identity();
  bool omit_transport = false;

  Eigen::Vector3d operator()(const core::Kinematics& state, const Eigen::Vector3d& gravity_map_m_s2,
                             const Eigen::Vector3d& bias) const;
  /// And its Jacobians by the state and by the vector of gravity.
  Eigen::Vector3d operator()(const core::Kinematics& state, const Eigen::Vector3d& gravity_map_m_s2,
                             const Eigen::Vector3d& bias, StateJacobian<3>& by_state,
                             Eigen::Matrix3d& by_gravity) const;
};

}  // namespace tarmac::estimators
