/// Small recordings of a landmark world, with an ideal IMU.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/recording.h"
#include "tests/estimators/landmark_world.h"

namespace tarmac::tests {

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("tarmac-") + info->name() + "-" + std::to_string(::getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline core::Rig rig_with_imu() {
  core::Rig rig;
  rig.lidars.resize(1);
  rig.lidars[0].model = "test";
  rig.lidars[0].T_body_lidar = some_pose();
  rig.imus.resize(1);
  rig.imus[0].model = "test";
  rig.imus[0].rate_hz = 100;
  rig.imus[0].delay = core::duration_from_s(0.005);
  rig.imus[0].T_body_imu = some_pose(-0.4, 0.8);
  return rig;
}

/// Samples of a rig that rests on `T_world_body` for `seconds`.
inline std::vector<core::ImuSample> imu_at_rest(const core::Rig& rig, double seconds) {
  std::vector<core::ImuSample> samples;
  for (int k = 1; k <= static_cast<int>(seconds * 100); ++k) {
    core::ImuSample& sample = samples.emplace_back();
    sample.t = core::time_from_ns(std::int64_t{k} * 10'000'000);
    sample.accel_m_s2 = rig.imus[0].T_body_imu.linear().transpose() * Eigen::Vector3d(0, 0, rig.gravity_m_s2);
  }
  return samples;
}

inline core::Recording write_recording(const std::filesystem::path& folder, const core::Rig& rig,
                                       const std::vector<core::LidarSweep>& sweeps,
                                       const std::vector<core::ImuSample>& imu = {}) {
  core::RecordingWriter writer(folder, rig);
  for (const core::LidarSweep& sweep : sweeps) writer.write(sweep);
  if (!imu.empty()) writer.write(0, imu);
  writer.finish();
  return core::Recording::open(folder);
}

}  // namespace tarmac::tests
