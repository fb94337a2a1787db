#include "estimators/window/accelerometer_residual.h"

namespace tarmac::estimators {

using core::so3::hat;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d AccelerometerResidual::operator()(const core::Kinematics& state, const Vector3d& gravity_map_m_s2,
                                           const Vector3d& bias) const {
  const Matrix3d R_body_map = state.T_world_body.linear().transpose();
  const Vector3d &w = state.omega_body, &lever = T_body_imu.translation();
  Vector3d f_body =
      R_body_map * (state.a_world - gravity_map_m_s2) + state.alpha_body.cross(lever) + w.cross(w.cross(lever));
  if (omit_transport) f_body -= w.cross(R_body_map * state.v_world);
  return T_body_imu.linear().transpose() * f_body + bias - measured_m_s2;
}

/// Of y = R^T x under R <- R Exp(phi): dy = y x phi-hat, that is hat(y) phi.
Vector3d AccelerometerResidual::operator()(const core::Kinematics& state, const Vector3d& gravity_map_m_s2,
                                           const Vector3d& bias, StateJacobian<3>& by_state,
                                           Matrix3d& by_gravity) const {
  namespace row = core::state_row;
  const Matrix3d R_body_map = state.T_world_body.linear().transpose(), R_imu_body = T_body_imu.linear().transpose();
  const Vector3d &w = state.omega_body, &lever = T_body_imu.translation();
  const Matrix3d hat_w = hat(w), hat_lever = hat(lever);
  Matrix3d by_phi = hat(R_body_map * (state.a_world - gravity_map_m_s2));
  Matrix3d by_omega = -hat(w.cross(lever)) - hat_w * hat_lever;
  by_state.setZero();
  if (omit_transport) {
    const Vector3d v_body = R_body_map * state.v_world;
    by_phi -= hat_w * hat(v_body);
    by_omega += hat(v_body);
    by_state.middleCols<3>(row::velocity) = -R_imu_body * hat_w * R_body_map;
  }
  by_state.middleCols<3>(row::pose + 3) = R_imu_body * by_phi;
  by_state.middleCols<3>(row::omega) = R_imu_body * by_omega;
  by_state.middleCols<3>(row::acceleration) = R_imu_body * R_body_map;
  by_state.middleCols<3>(row::alpha) = -R_imu_body * hat_lever;
  by_gravity = -R_imu_body * R_body_map;
  return (*this)(state, gravity_map_m_s2, bias);
}

}  // namespace tarmac::estimators
