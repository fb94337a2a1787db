/// The rig data sheet: what an engineer would know of the sensors on the vehicle. It travels with the recording, so it
/// holds nominal values only; realised errors are truth.
#pragma once

#include <string>
#include <vector>

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::core {

struct LidarSheet {
  std::string model;
  SE3 T_body_lidar = SE3::Identity();
  double sweep_rate_hz = 10;
  double min_range_m = 0;
  double max_range_m = 0;
  Duration clock_offset{0};                ///< nominal: sensor stamp minus recording clock
  std::string stamp_convention = "begin";  ///< what a sweep's stamp stands for: begin | mid | end
};

struct ImuSheet {
  std::string model;
  SE3 T_body_imu = SE3::Identity();
  double rate_hz = 0;
  Duration delay{0};  ///< stamp minus the middle of what the sample averages (group delay and half the interval)
  double gyro_noise_density_rad_s_rthz = 0;
  double gyro_random_walk_rad_s2_rthz = 0;
  double gyro_range_rad_s = 0;
  double accel_noise_density_m_s2_rthz = 0;
  double accel_random_walk_m_s3_rthz = 0;
  double accel_range_m_s2 = 0;
};

struct Rig {
  std::vector<LidarSheet> lidars;
  std::vector<ImuSheet> imus;
  /// False when a foreign recording came without calibration: body = LiDAR frame then, and a method that needs the
  /// IMU's extrinsic reports not_initialised.
  bool calibrated = true;
  double gravity_m_s2 = 9.80665;
};

/// JSON text with stable key order; from_json throws InputError naming `where` and the field.
std::string rig_to_json(const Rig& rig);
Rig rig_from_json(const std::string& text, const std::string& where);

}  // namespace tarmac::core
