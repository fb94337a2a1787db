/// The scenario's `rig:` block.
#pragma once

#include <optional>
#include <string>

#include "core/config.h"
#include "core/options.h"
#include "core/rig.h"
#include "sim/imu/imu.h"
#include "sim/lidar/profile.h"
#include "sim/lidar/sweep_simulator.h"

namespace tarmac::sim {

struct LidarOptions {
  LidarOptions();  ///< a sensor on the vehicle's roof
  std::string model = "ouster-os1-64-gen2";
  int columns = 0;           ///< 0: the model's default
  double sweep_rate_hz = 0;  ///< 0: the model's default
  core::SE3 T_body_lidar = core::SE3::Identity();
  lidar::NoiseOptions noise;
  void visit(core::OptionVisitor& v);
};

struct RigOptions {
  LidarOptions lidar;
  bool has_imu = false;  ///< the block is there: without it the rig carries none
  ImuOptions imu;
  double gravity_m_s2 = 9.80665;
  void visit(core::OptionVisitor& v);
};

/// Options with the model's defaults filled in. Throws InputError with file and line.
RigOptions read_rig(const core::ConfigNode& rig);
/// The data sheet that goes with the recording: nominal values, which here are the true ones.
core::Rig data_sheet(const RigOptions& options);

}  // namespace tarmac::sim
