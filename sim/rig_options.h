/// The scenario's `rig:` block.
#pragma once

#include <string>

#include "core/config.h"
#include "core/options.h"
#include "core/rig.h"
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
  double gravity_m_s2 = 9.80665;
  void visit(core::OptionVisitor& v);
};

/// Options with the model's defaults filled in. Throws InputError with file and line.
RigOptions read_rig(const core::ConfigNode& rig);
core::LidarSheet sheet_of(const LidarOptions& options);

}  // namespace tarmac::sim
