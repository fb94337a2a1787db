/// The unknowns of a window.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/parametric_trajectory.h"

namespace tarmac::estimators {

/// Biases at one time, as added to what is measured: gyro [rad/s], accelerometer [m/s^2]; linear between knots, held
/// before the first and after the last. Their time is the recording's clock, whatever the IMU's offset.
struct BiasKnot {
  core::Time t;
  core::Vector6 gyro_accel = core::Vector6::Zero();
};

/// All unknowns of a window.
struct WindowState {
  std::unique_ptr<core::ParametricTrajectory> trajectory;
  std::vector<BiasKnot> biases;                             ///< ascending; empty: no IMU
  Eigen::Vector3d gravity_map = -Eigen::Vector3d::UnitZ();  ///< direction of gravity, unit length
  double imu_offset_s = 0;  ///< a sample stamped s holds at s - offset (beside what the data sheet says)

  WindowState() = default;
  WindowState(const WindowState& other);
  WindowState& operator=(const WindowState& other);
  WindowState(WindowState&&) = default;
  WindowState& operator=(WindowState&&) = default;
};

/// Where the unknowns that act on the whole trajectory stand in the border: 6 a bias knot, gravity's 2, the offset's 1.
struct BorderLayout {
  int biases = 0;
  int gravity = -1, offset = -1;  ///< columns; -1: not an unknown

  BorderLayout(const WindowState& state, bool free_gravity, bool free_offset);
  int size() const { return 6 * biases + (gravity >= 0 ? 2 : 0) + (offset >= 0 ? 1 : 0); }
};

/// state <- state (+) step; band, then border.
void retract(WindowState& state, const BorderLayout& layout, const Eigen::Ref<const Eigen::VectorXd>& step);

/// Between which knots the bias at t lies: bias = (1 - share) knot + share (knot + 1).
struct BiasPlace {
  int knot = 0;
  double share = 0;
};
BiasPlace bias_place(const std::vector<BiasKnot>& biases, core::Time t);
core::Vector6 bias_at(const std::vector<BiasKnot>& biases, core::Time t);

}  // namespace tarmac::estimators
