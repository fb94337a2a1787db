/// Attitude and biases from a rest.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "core/measurements.h"
#include "estimators/dead_reckoning/options.h"

namespace tarmac::estimators {

/// Looks for the first window in which the rig is at rest. There the specific force is gravity's reaction: its mean
/// direction gives roll and pitch (yaw is free: the body's x axis is taken as the map's), what its magnitude exceeds
/// |g| by is accelerometer bias, and the mean rate is gyroscope bias. A rig that moves evenly looks the same.
class StaticStart {
 public:
  struct Result {
    Eigen::Matrix3d R_map_imu = Eigen::Matrix3d::Identity();
    Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  };

  StaticStart(const RestOptions& options, const Eigen::Matrix3d& R_body_imu, double gravity_m_s2, double rate_hz);

  /// Takes samples in time order. @returns the start once the last window_s of samples were at rest
  std::optional<Result> add(const core::ImuSample& sample);
  /// No rest came in time.
  bool gave_up() const { return gave_up_; }
  /// The calmest full window so far; infinite where there was none.
  double least_accel_spread_m_s2() const { return least_spread_m_s2_; }
  /// Why there was none, for the run's message.
  std::string why_not() const;

 private:
  std::optional<Result> evaluate();

  RestOptions options_;
  Eigen::Matrix3d R_body_imu_;
  double gravity_m_s2_;
  double period_s_;
  std::optional<core::Time> first_;
  std::deque<core::ImuSample> window_;
  bool gave_up_ = false;
  double least_spread_m_s2_;
};

}  // namespace tarmac::estimators
