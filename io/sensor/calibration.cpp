#include "io/sensor/calibration.h"

#include <fmt/format.h>

#include "core/config.h"
#include "core/error.h"
#include "core/options.h"

namespace tarmac::io {
namespace {

using core::OptionVisitor;

struct LidarBlock {
  core::LidarSheet sheet;
  double clock_offset_s = 0;
  void visit(OptionVisitor& v) {
    v("model", sheet.model, "name of the sensor's model");
    v("T_body_lidar", sheet.T_body_lidar, "p_body = T_body_lidar * p_lidar, nominal");
    v("sweep_rate_hz", sheet.sweep_rate_hz, "sweeps a second", {.above = 0});
    v("min_range_m", sheet.min_range_m, "nearest range that the sensor reports", {.at_least = 0});
    v("max_range_m", sheet.max_range_m, "farthest range that the sensor reports; 0 = not known", {.at_least = 0});
    v("clock_offset_s", clock_offset_s, "nominal: sensor stamp minus recording clock");
    v.choice("stamp_convention", sheet.stamp_convention, {"begin", "mid", "end"}, "what a sweep's stamp stands for");
  }
};

struct ImuBlock {
  core::ImuSheet sheet;
  double delay_s = 0;
  void visit(OptionVisitor& v) {
    const auto noise = [&](const char* name, double& value, const char* meaning) {
      v(name, value, meaning, {.at_least = 0});
    };
    v("model", sheet.model, "name of the IMU's model");
    v("T_body_imu", sheet.T_body_imu, "p_body = T_body_imu * p_imu, nominal");
    v("rate_hz", sheet.rate_hz, "samples a second", {.above = 0});
    v("delay_s", delay_s, "stamp minus the middle of what the sample averages");
    noise("gyro_noise_density_rad_s_rthz", sheet.gyro_noise_density_rad_s_rthz, "gyroscope white noise");
    noise("gyro_random_walk_rad_s2_rthz", sheet.gyro_random_walk_rad_s2_rthz, "gyroscope bias random walk");
    noise("gyro_range_rad_s", sheet.gyro_range_rad_s, "largest rate that it reports; 0 = not known");
    noise("accel_noise_density_m_s2_rthz", sheet.accel_noise_density_m_s2_rthz, "accelerometer white noise");
    noise("accel_random_walk_m_s3_rthz", sheet.accel_random_walk_m_s3_rthz, "accelerometer bias random walk");
    noise("accel_range_m_s2", sheet.accel_range_m_s2, "largest specific force that it reports; 0 = not known");
  }
};

struct Calibration {
  LidarBlock lidar;
  ImuBlock imu;
  bool has_imu = false;
  double gravity_m_s2 = core::Rig{}.gravity_m_s2;
  void visit(OptionVisitor& v) {
    v.group("lidar", lidar, "the LiDAR");
    if (has_imu) v.group("imu", imu, "the IMU");
    v("gravity_m_s2", gravity_m_s2, "magnitude of gravity", {.above = 0});
  }
};

void require(const core::ConfigNode& file, const char* block, const char* key, const char* why) {
  if (file.child(block).child(key).present()) return;
  file.fail_at(block, fmt::format("{} is missing: {}", key, why));
}

}  // namespace

std::string calibration_text(const core::Rig& rig) {
  if (rig.lidars.size() != 1 || rig.imus.size() > 1) {
    throw core::InputError(fmt::format("the plain format holds one LiDAR and at most one IMU; the rig has {} and {}",
                                       rig.lidars.size(), rig.imus.size()));
  }
  Calibration calibration;
  calibration.lidar.sheet = rig.lidars[0];
  calibration.lidar.clock_offset_s = core::to_s(rig.lidars[0].clock_offset);
  calibration.has_imu = !rig.imus.empty();
  if (calibration.has_imu) {
    calibration.imu.sheet = rig.imus[0];
    calibration.imu.delay_s = core::to_s(rig.imus[0].delay);
  }
  calibration.gravity_m_s2 = rig.gravity_m_s2;
  return core::write_options(calibration);
}

core::Rig read_calibration(const std::filesystem::path& file, bool with_imu) {
  const core::ConfigNode node = core::ConfigNode::load(file.string());
  Calibration calibration;
  calibration.has_imu = with_imu || node.child("imu").present();
  node.read(calibration);
  require(node, "lidar", "T_body_lidar", "the LiDAR's pose on the body; without calibration remove the file");
  if (with_imu) require(node, "imu", "T_body_imu", "imu.csv is there, so its pose on the body must be");

  core::Rig rig;
  rig.lidars = {calibration.lidar.sheet};
  rig.lidars[0].clock_offset = core::duration_from_s(calibration.lidar.clock_offset_s);
  if (with_imu) {
    rig.imus = {calibration.imu.sheet};
    rig.imus[0].delay = core::duration_from_s(calibration.imu.delay_s);
  }
  rig.gravity_m_s2 = calibration.gravity_m_s2;
  return rig;
}

}  // namespace tarmac::io
