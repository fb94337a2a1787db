/// A stretch of continuous-time motion with everything that is known of it: the problem that all sliding-window and batch
/// methods of this folder's users solve.
///
/// Unknowns: the trajectory's parameters (a band), and a border of what acts on all of it: IMU biases at bias knots,
/// gravity's direction, the IMU's time offset. Residuals know their Jacobian by the state at their time
/// (core/parametric_trajectory.h); the window chains the two.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/parametric_trajectory.h"
#include "estimators/blocks/robust_loss.h"
#include "estimators/window/banded_system.h"
#include "estimators/window/lidar_factors.h"
#include "estimators/window/marginal_prior.h"

namespace tarmac::estimators {

/// Biases at one time, as added to what is measured: gyro [rad/s], accelerometer [m/s^2]; linear between knots, held
/// before the first and after the last.
struct BiasKnot {
  core::Time t;
  core::Vector6 gyro_accel = core::Vector6::Zero();
};

/// All unknowns of a window.
struct WindowState {
  std::unique_ptr<core::ParametricTrajectory> trajectory;
  std::vector<BiasKnot> biases;                           ///< ascending; empty: no IMU
  Eigen::Vector3d gravity_map = -Eigen::Vector3d::UnitZ();  ///< direction of gravity, unit length
  double imu_offset_s = 0;  ///< a sample stamped s holds at s - offset (beside what the data sheet says)

  WindowState() = default;
  WindowState(const WindowState& other);
  WindowState& operator=(const WindowState& other);
  WindowState(WindowState&&) = default;
  WindowState& operator=(WindowState&&) = default;
};

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
  double gyro_sigma_rad_s = 0;    ///< of one reading, an axis
  double accel_sigma_m_s2 = 0;    ///< of one reading, an axis; not for trajectories without acceleration
  bool omit_transport = false;    ///< for comparison only: the accelerometer as R^T(a - g) - omega x (R^T v), which
                                  ///< forgets the transport term of body-centric velocities (upstream STEAM's form)
  RobustLoss accel_loss;          ///< on the whitened norm of one reading (scale: standard deviations)
  double gyro_walk_rad_s2_rthz = 0;   ///< of the bias between knots
  double accel_walk_m_s3_rthz = 0;
  bool free_gravity = false, free_imu_offset = false;
  double gravity_sigma_rad = 0;       ///< prior of the direction about its start; 0: none
  double imu_offset_sigma_s = 0;      ///< prior of the offset about 0; 0: none
  /// Accelerometer as increments of velocity between the trajectory's knots instead of sample by sample (for models
  /// whose acceleration means nothing): v2 - v1 = sum (R (f - b) + g) dt, covariance sum sigma^2 dt^2.
  bool accel_as_increments = false;
  /// White noise on acceleration as a prior of models that have none of their own: the integral of |a|^2/q over time,
  /// sampled `smoothness_samples` times between knots; 0: none. [m^2/s^3], [rad^2/s^3]
  double smoothness_translation = 0, smoothness_rotation = 0;
  int smoothness_samples = 2;
  // LiDAR
  double lidar_sigma_m = 0.05;  ///< of a residual of weight 1
  RobustLoss lidar_loss;        ///< on residuals in sigmas
};

enum class Marginalisation : std::uint8_t {
  plain,       ///< Schur complement as it stands
  eigenvalue,  ///< directions with an eigenvalue below a threshold carry no information
  fix,         ///< what leaves the window is held where it is: no information goes on but the states' values
};

struct SolveSettings {
  bool levenberg_marquardt = false;  ///< else Gauss-Newton
  int max_iterations = 5;
  double initial_lambda = 1e-4;
  bool line_search = false;   ///< Gauss-Newton: halve a step up to three times where the cost does not fall
  double relative_decrease = 1e-4, absolute_decrease = 1e-4;  ///< of the cost, below which it ends
  bool lidar = true;          ///< false: IMU and priors alone, for a prediction
};

struct SolveReport {
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;
  bool ok = true;  ///< false: singular or not finite; the state is what it was
};

class Window {
 public:
  Window(WindowModel model, WindowState start);

  const WindowModel& model() const { return model_; }
  WindowModel& model() { return model_; }
  const WindowState& state() const { return state_; }
  WindowState& state() { return state_; }
  core::ParametricTrajectory& trajectory() { return *state_.trajectory; }
  const core::ParametricTrajectory& trajectory() const { return *state_.trajectory; }

  /// Readings in time order; those that the trajectory does not cover yet wait until it does.
  void add(const ImuReading& reading);
  /// A bias knot with the last one's value. At or after the last.
  void add_bias_knot(core::Time t);
  /// The LiDAR residuals of a sweep; given again they take the place of those before.
  void set_lidar(std::int64_t sweep, LidarFactors factors);
  const LidarFactors* lidar(std::int64_t sweep) const;

  /// A Gaussian prior on the whole state at one time: what a start is known to. `sigma`: rows of core::state_row; 0 or
  /// less: nothing known of that row.
  void add_anchor(core::Time t, const core::Kinematics& mean, const core::StateVector& sigma);
  /// A Gaussian prior on a bias knot (index), an axis of gyro and accelerometer.
  void add_bias_anchor(int knot, const core::Vector6& mean, const core::Vector6& sigma);

  SolveReport solve(const SolveSettings& settings);
  /// Half the sum of weighted squares of everything at the present state.
  double cost() const;

  /// Normal equations at the present state, data (LiDAR) and all the rest apart; either may be null.
  void assemble(BandedSystem* lidar, BandedSystem* rest, const SolveSettings& settings) const;
  /// Covariance of the state at t (rows of core::state_row up to `upto`), by the inverse of the normal equations. Empty
  /// where they are singular.
  Eigen::MatrixXd covariance(core::Time t, core::Derivative upto) const;
  /// Covariance of the border: biases, gravity (2), offset (1), as far as they are unknowns. Empty where singular.
  Eigen::MatrixXd border_covariance() const;
  int border_size() const;
  int gravity_column() const;  ///< within the border; -1: not an unknown
  int offset_column() const;   ///< within the border; -1: not an unknown

  /// Takes out everything before t that the states from t on do not depend on: parameters, bias knots but the last one
  /// before, residuals. What they say of the rest stays as a prior.
  void marginalise_before(core::Time t, Marginalisation rule, double eigenvalue_threshold = 1e-6);

 private:
  struct Impl;  // (layout left to window.cpp)
  WindowModel model_;
  WindowState state_;
};

}  // namespace tarmac::estimators
