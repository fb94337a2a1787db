/// Recordings and folders made up for the tests of file formats.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/recording.h"

namespace tarmac::tests {

inline void put(const std::filesystem::path& file, const std::string& content) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

inline std::string floats(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// A calibrated rig of one LiDAR and one IMU in which no number is a default or zero.
inline core::Rig calibrated_rig() {
  core::Rig rig;
  rig.gravity_m_s2 = 9.8123;
  rig.lidars.resize(1);
  core::LidarSheet& lidar = rig.lidars[0];
  lidar.model = "ouster-os1-64-gen2";
  lidar.T_body_lidar = core::se3::exp((core::Vector6() << 1.2, -0.3, 1.9, 0.01, -0.02, 3.1).finished());
  lidar.sweep_rate_hz = 20;
  lidar.min_range_m = 0.3;
  lidar.max_range_m = 120;
  lidar.clock_offset = core::Duration(-1'500'000);
  lidar.stamp_convention = "mid";
  rig.imus.resize(1);
  core::ImuSheet& imu = rig.imus[0];
  imu.model = "tactical";
  imu.T_body_imu = core::se3::exp((core::Vector6() << 0.1, 0.2, 0.4, 0.5, 0, -1).finished());
  imu.rate_hz = 400;
  imu.delay = core::Duration(2'500'001);
  imu.gyro_noise_density_rad_s_rthz = 1.1e-4;
  imu.gyro_random_walk_rad_s2_rthz = 2.2e-6;
  imu.gyro_range_rad_s = 35;
  imu.accel_noise_density_m_s2_rthz = 3.3e-3;
  imu.accel_random_walk_m_s3_rthz = 4.4e-5;
  imu.accel_range_m_s2 = 160;
  return rig;
}

inline core::LidarSweep sweep_of(std::int64_t index, std::size_t points) {
  const core::RandomStream stream(static_cast<std::uint64_t>(index), "test/sweep");
  core::LidarSweep sweep;
  sweep.index = index;
  sweep.begin = core::time_from_ns(1'700'000'000'000'000'000 + 50'000'001 * index);
  sweep.end = sweep.begin + core::Duration(49'900'003);
  for (std::size_t i = 0; i < points; ++i) {
    const auto f = [&](std::uint32_t j) { return static_cast<float>(10 * stream.normal(i, j)); };
    const auto t_ns = static_cast<std::int32_t>(49'900'003.0 * static_cast<double>(i) / static_cast<double>(points));
    sweep.push_back({f(0), f(1), f(2)}, t_ns, static_cast<std::uint16_t>(i % 64), f(3));
  }
  return sweep;
}

inline std::vector<core::ImuSample> imu_of(std::size_t n) {
  const core::RandomStream stream(1, "test/imu");
  std::vector<core::ImuSample> samples(n);
  for (std::size_t i = 0; i < n; ++i) {
    samples[i].t = core::time_from_ns(1'700'000'000'000'000'000 + 2'500'000 * static_cast<std::int64_t>(i));
    samples[i].gyro_rad_s = Eigen::Vector3d(stream.normal(i, 0), stream.normal(i, 1), stream.normal(i, 2));
    samples[i].accel_m_s2 = Eigen::Vector3d(stream.normal(i, 3), stream.normal(i, 4), 9.81 + stream.normal(i, 5));
  }
  return samples;
}

inline std::string record(const std::filesystem::path& folder, const core::Rig& rig,
                          const std::vector<core::LidarSweep>& sweeps, const std::vector<core::ImuSample>& imu) {
  core::RecordingWriter writer(folder, rig);
  for (const core::LidarSweep& sweep : sweeps) writer.write(sweep);
  if (!rig.imus.empty()) writer.write(0, imu);
  return writer.finish();
}

}  // namespace tarmac::tests
