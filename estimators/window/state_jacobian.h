/// Jacobians by the state at one time (core::state_row), and small shifts of it.
#pragma once

#include "core/parametric_trajectory.h"

namespace tarmac::estimators {

/// Rows of a residual by the 18 rows of a state's tangent.
template <int Rows>
using StateJacobian = Eigen::Matrix<double, Rows, core::state_row::count>;

/// state (+) d: the pose on the right, the others by adding.
inline core::Kinematics moved(const core::Kinematics& state, const core::StateVector& d) {
  namespace row = core::state_row;
  core::Kinematics result = state;
  result.T_world_body = state.T_world_body * core::se3::exp(d.segment<6>(row::pose));
  result.v_world += d.segment<3>(row::velocity);
  result.omega_body += d.segment<3>(row::omega);
  result.a_world += d.segment<3>(row::acceleration);
  result.alpha_body += d.segment<3>(row::alpha);
  return result;
}

/// d with state = base (+) d.
inline core::StateVector difference(const core::Kinematics& base, const core::Kinematics& state) {
  core::StateVector d;
  d << core::se3::log(base.T_world_body.inverse(Eigen::Isometry) * state.T_world_body), state.v_world - base.v_world,
      state.omega_body - base.omega_body, state.a_world - base.a_world, state.alpha_body - base.alpha_body;
  return d;
}

}  // namespace tarmac::estimators
