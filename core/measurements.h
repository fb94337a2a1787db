/// What sensors deliver.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/time.h"

namespace tarmac::core {

/// One revolution of one LiDAR, as arrays of equal length, in firing order. Points are in the sensor's frame by its
/// nominal calibration. Every point carries its own firing time. No returns are left out.
struct LidarSweep {
  std::int64_t index = 0;    ///< counts the sensor's sweeps from 0; a lost sweep leaves a hole
  Time begin, end;           ///< firing times of the first and the last firing, whether or not they returned
  std::uint16_t sensor = 0;  ///< index into Rig::lidars
  std::vector<float> x_m, y_m, z_m;
  std::vector<std::int32_t> t_ns;  ///< from `begin`, as stamped by the sensor
  std::vector<std::uint16_t> ring;
  std::vector<float> intensity;
  /// Of merged sweeps (merged_sweeps.h): whose each point is, index into the recording's LiDARs. Empty: all `sensor`'s.
  std::vector<std::uint16_t> point_sensor = {};

  std::uint16_t sensor_of(std::size_t i) const { return point_sensor.empty() ? sensor : point_sensor[i]; }
  std::size_t size() const { return x_m.size(); }
  bool empty() const { return x_m.empty(); }
  Eigen::Vector3d point(std::size_t i) const { return {x_m[i], y_m[i], z_m[i]}; }
  Time time(std::size_t i) const { return begin + Duration(t_ns[i]); }
  void reserve(std::size_t n);
  void push_back(const Eigen::Vector3f& p_lidar, std::int32_t point_t_ns, std::uint16_t point_ring,
                 float point_intensity);
};

/// Angular rate [rad/s] and specific force [m/s^2] in the IMU's frame (static and level: f = (0, 0, +g)).
/// t is the stamp; what instant or interval it stands for is on the rig data sheet.
struct ImuSample {
  Time t;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace tarmac::core
