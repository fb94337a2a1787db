/// What a window takes for granted, and what it is told: noise, switches, IMU readings.
#pragma once

#include "core/parametric_trajectory.h"
#include "estimators/blocks/robust_loss.h"

namespace tarmac::estimators {

/// One IMU sample as a residual: the middle of what it averages, by the recording's clock, in the IMU's frame.
struct ImuReading {
  core::Time t;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
};

/// Standard deviations and switches of the residuals; a term with a deviation of 0 is left out.
struct WindowModel {
  // IMU
  core::SE3 T_body_imu = core::SE3::Identity();
  double gravity_m_s2 = 9.80665;
  double gyro_sigma_rad_s = 0;  ///< of one reading, an axis
  double accel_sigma_m_s2 = 0;  ///< of one reading, an axis; not for trajectories without acceleration
  /// For comparison only: the accelerometer as R^T(a - g) - omega x (R^T v), which forgets the transport term of
  /// body-centric velocities; as increments: velocity_increment.h (upstream STEAM's form).
  bool omit_transport = false;
  RobustLoss accel_loss;             ///< on the whitened norm of one reading (scale: standard deviations)
  double gyro_walk_rad_s2_rthz = 0;  ///< of the bias between knots
  double accel_walk_m_s3_rthz = 0;
  bool free_gravity = false, free_imu_offset = false;
  double gravity_sigma_rad = 0;   ///< prior of the direction about its start; 0: none
  double imu_offset_sigma_s = 0;  ///< prior of the offset about 0; 0: none
  /// Accelerometer as increments of velocity between the trajectory's knots instead of sample by sample (for models
  /// whose acceleration means nothing): v2 - v1 = sum (R (f - b) + g) dt, covariance sum sigma^2 dt^2.
  bool accel_as_increments = false;
  /// White noise on acceleration as a prior of models that have none of their own: the integral of |a|^2/q over time,
  /// sampled `smoothness_samples` (1, 2 or 3) times between knots; 0: none. [m^2/s^3], [rad^2/s^3]
  double smoothness_translation = 0, smoothness_rotation = 0;
  int smoothness_samples = 2;
  // LiDAR
  double lidar_sigma_m = 0.05;  ///< of a residual of weight 1
  RobustLoss lidar_loss;        ///< on residuals in sigmas
  /// For comparison only: a step is that of point-to-plane residuals of one stamp summed before they are squared, where
  /// opposite ones cancel, while the cost that is watched squares each (upstream STEAM's form). No loss; not by Ceres.
  bool sum_stamp_residuals = false;
};

/// Throws std::invalid_argument where the model asks for derivatives that the trajectory does not have.
void check(const WindowModel& model, const core::ParametricTrajectory& trajectory);

}  // namespace tarmac::estimators
