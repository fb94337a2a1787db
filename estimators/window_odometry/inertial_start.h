/// The IMU's part in an odometry: where it begins, and its samples as readings.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/rig.h"
#include "estimators/dead_reckoning/static_start.h"
#include "estimators/window/window.h"
#include "estimators/window_odometry/settings.h"

namespace tarmac::estimators {

/// The IMU's part of a window's model; the accelerometer's deviation only where `use` says so.
void set_imu(const ImuSettings& settings, const core::Rig& rig, WindowModel& model);

/// What the window found of the IMU's time offset, with its standard deviation, beside the data sheet's delay;
/// "unobservable" where the data did not halve the prior's deviation, as at a constant rate of turn; empty where it is
/// no unknown.
std::string offset_message(const Window& window);

/// Attitude and biases from a rest, and a queue of readings for the window. Without an IMU it has started from the
/// first.
class InertialStart {
 public:
  InertialStart(const ImuSettings& settings, const core::Rig& rig);

  void add(const core::ImuSample& sample);
  /// Whether a sweep that begins at t may be the first.
  bool ready(core::Time t) const;
  /// Why there is no start, for the run's message.
  std::string why_not() const;

  core::SE3 T_map_body() const;  ///< at rest: gravity-aligned, the position is the map's origin
  core::Vector6 biases() const;  ///< gyro, accelerometer
  /// Readings taken since the last call, those before `from` dropped.
  std::vector<ImuReading> take_readings(core::Time from);

 private:
  bool in_use_;
  core::ImuSheet sheet_;
  std::string cannot_start_;
  std::optional<StaticStart> static_start_;
  std::optional<StaticStart::Result> start_;
  core::Time started_at_;
  std::deque<ImuReading> readings_;
};

}  // namespace tarmac::estimators
