#include "sim/rig_options.h"

#include <fmt/format.h>

#include "core/error.h"

namespace tarmac::sim {

using namespace core;

LidarOptions::LidarOptions() {
  T_body_lidar.translation().z() = 1.9;
}

void LidarOptions::visit(OptionVisitor& v) {
  v.choice("model", model, lidar::profile_names(), "the sensor: `tarmac list sensors`");
  v("columns", columns,
    "firings of each channel a revolution; 0 = the model's default (always 0 where a clock fires them)",
    {.at_least = 0});
  v("sweep_rate_hz", sweep_rate_hz, "revolutions a second; 0 = the model's default", {.at_least = 0});
  v("T_body_lidar", T_body_lidar, "pose of the sensor frame in the body frame (x forward, y left, z up)");
  v.group("noise", noise, "errors of the measurement");
}

void RigOptions::visit(OptionVisitor& v) {
  v.group("lidar", lidar, "a spinning LiDAR");
  if (has_imu) v.group("imu", imu, "an IMU; without this block the rig carries none");
  v("gravity_m_s2", gravity_m_s2, "magnitude of gravity", {.above = 0});
}

RigOptions read_rig(const ConfigNode& rig) {
  RigOptions options;
  options.has_imu = rig.child("imu").present();
  rig.read(options);
  LidarOptions& lidar = options.lidar;
  const lidar::Profile& profile = lidar::profile(lidar.model);
  lidar::Mode mode;
  try {
    mode = lidar::mode_of(profile, lidar.columns, lidar.sweep_rate_hz);
  } catch (const InputError& error) {
    rig.child("lidar").fail(error.what());
  }
  if (options.has_imu && options.imu.rate_hz > imu_model(options.imu.model).max_rate_hz)
    rig.child("imu").fail_at("rate_hz", fmt::format("{} Hz is more than {} gives; at most {} Hz", options.imu.rate_hz,
                                                    options.imu.model, imu_model(options.imu.model).max_rate_hz));
  lidar.columns = mode.columns;
  lidar.sweep_rate_hz = mode.rate_hz;
  return options;
}

Rig data_sheet(const RigOptions& options) {
  const lidar::Profile& profile = lidar::profile(options.lidar.model);
  LidarSheet lidar;
  lidar.model = options.lidar.model;
  lidar.T_body_lidar = options.lidar.T_body_lidar;
  lidar.sweep_rate_hz = options.lidar.sweep_rate_hz;
  lidar.min_range_m = profile.min_range_m;
  lidar.max_range_m = profile.max_range_m;
  Rig rig;
  rig.gravity_m_s2 = options.gravity_m_s2;
  rig.lidars.push_back(lidar);
  if (options.has_imu) rig.imus.push_back(imu_sheet(options.imu));
  return rig;
}

}  // namespace tarmac::sim
