#include "sim/rig_options.h"

#include "core/error.h"

namespace tarmac::sim {

using namespace core;

LidarOptions::LidarOptions() { T_body_lidar.translation().z() = 1.9; }

void LidarOptions::visit(OptionVisitor& v) {
  v.choice("model", model, lidar::profile_names(), "the sensor: `tarmac list sensors`");
  v("columns", columns, "firings of each channel a revolution; 0 = the model's default (always 0 where a clock fires them)",
    {.at_least = 0});
  v("sweep_rate_hz", sweep_rate_hz, "revolutions a second; 0 = the model's default", {.at_least = 0});
  v("T_body_lidar", T_body_lidar, "pose of the sensor frame in the body frame (x forward, y left, z up)");
  v.group("noise", noise, "errors of the measurement");
}

void RigOptions::visit(OptionVisitor& v) {
  v.group("lidar", lidar, "a spinning LiDAR");
  v("gravity_m_s2", gravity_m_s2, "magnitude of gravity", {.above = 0});
}

RigOptions read_rig(const ConfigNode& rig) {
  RigOptions options;
  rig.read(options);
  LidarOptions& lidar = options.lidar;
  const lidar::Profile& profile = lidar::profile(lidar.model);
  lidar::Mode mode;
  try {
    mode = lidar::mode_of(profile, lidar.columns, lidar.sweep_rate_hz);
  } catch (const InputError& error) {
    rig.child("lidar").fail(error.what());
  }
  lidar.columns = mode.columns;
  lidar.sweep_rate_hz = mode.rate_hz;
  return options;
}

LidarSheet sheet_of(const LidarOptions& options) {
  const lidar::Profile& profile = lidar::profile(options.model);
  LidarSheet sheet;
  sheet.model = options.model;
  sheet.T_body_lidar = options.T_body_lidar;
  sheet.sweep_rate_hz = options.sweep_rate_hz;
  sheet.min_range_m = profile.min_range_m;
  sheet.max_range_m = profile.max_range_m;
  return sheet;
}

}  // namespace tarmac::sim
