/// The accelerometer as increments of velocity between two times.
#pragma once

#include <vector>

#include "estimators/window/state_jacobian.h"
#include "estimators/window/window_model.h"

namespace tarmac::estimators {

/// One reading's share of a stretch [t1, t2]: it stands for the time nearer to it than to its neighbours.
struct IncrementSample {
  core::Time at;             ///< where the pose is asked: the reading's time, kept within the stretch
  bool kept_at_end = false;  ///< `at` was moved onto an end and does not follow the offset
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  double dt_s = 0;
  double dt_by_offset = 0;  ///< d(dt_s)/d(offset): -1 where only its end moves, +1 where only its begin does
};

/// The shares of readings (ascending; their times are stamp - offset) in [t1, t2]. Empty where some part of it is
/// further than `reach` from any reading.
std::vector<IncrementSample> increment_samples(const std::vector<ImuReading>& readings, double offset_s, core::Time t1,
                                               core::Time t2, core::Duration reach);

/// With the IMU at l in the body, v_imu = v + R (omega x l):
///   r = ( v_imu(t2) - v_imu(t1) - sum ( R_i R_body_imu (f_i - b_i) + g ) dt_i ) / sigma,   sigma^2 = sum s^2 dt_i^2
/// in the map's axes; s: the accelerometer's deviation. `omit_transport` (for comparison only, upstream STEAM's form):
///   r = ( nu(t2) - nu(t1) - sum ( R_body_imu (f_i - b_i) + R_i^T g ) dt_i ) / sigma,   nu = R^T v_imu
/// body-centric, without the term omega x nu by which nu changes when the body turns.
/// Source: Burnett, Schoellig, Barfoot, Continuous-Time Radar-Inertial and Lidar-Inertial Odometry (2024), velocity
/// preintegration; the lever arm is ours.
struct VelocityIncrement {
  core::SE3 T_body_imu = core::SE3::Identity();
  Eigen::Vector3d gravity_map_m_s2 = Eigen::Vector3d::Zero();  ///< downwards
  bool omit_transport = false;

  /// v_imu, or nu, and its Jacobian by the state.
  Eigen::Vector3d velocity(const core::Kinematics& state, StateJacobian<3>& J) const;
  /// What one sample adds per second, and its Jacobians by the pose's rotation, the bias and gravity.
  struct Rate {
    Eigen::Vector3d m_s2;
    Eigen::Matrix3d by_phi, by_bias, by_gravity;
  };
  Rate rate(const core::Kinematics& state, const Eigen::Vector3d& f, const Eigen::Vector3d& bias) const;
};

}  // namespace tarmac::estimators
