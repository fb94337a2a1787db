/// An angular rate against a gyro's reading.
#pragma once

#include "estimators/window/state_jacobian.h"

namespace tarmac::estimators {

/// r = R_imu_body omega_body + b - m [rad/s], in the IMU's frame. By the bias: the identity.
/// Source: Furgale, Rehder, Siegwart, IROS 2013, eq. 10.
struct GyroResidual {
  Eigen::Vector3d measured_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_body_imu = Eigen::Matrix3d::Identity();

  Eigen::Vector3d operator()(const core::Kinematics& state, const Eigen::Vector3d& bias) const {
    return R_body_imu.transpose() * state.omega_body + bias - measured_rad_s;
  }
  Eigen::Vector3d operator()(const core::Kinematics& state, const Eigen::Vector3d& bias, StateJacobian<3>& J) const {
    J.setZero();
    J.middleCols<3>(core::state_row::omega) = R_body_imu.transpose();
    return (*this)(state, bias);
  }
};

}  // namespace tarmac::estimators
