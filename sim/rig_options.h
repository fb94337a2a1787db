/// The scenario's `rig:` block.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/options.h"
#include "core/rig.h"
#include "sim/imu/imu.h"
#include "sim/lidar/beam_options.h"
#include "sim/lidar/firing.h"
#include "sim/lidar/own_body.h"
#include "sim/lidar/profile.h"
#include "sim/lidar/sweep_simulator.h"

namespace tarmac::sim {

struct LidarOptions {
  LidarOptions();  ///< a sensor on the vehicle's roof
  /// A bundled sensor's name or the path of a sensor file (lidar/profile_file.h), relative to the file that says it or,
  /// from `--set`, to the working directory. After read_rig: a name; the sensor is in `profile`.
  std::string model = "ouster-os1-64-gen2";
  int columns = 0;             ///< 0: the model's default
  double sweep_rate_hz = 0;    ///< 0: the model's default
  double start_offset_ms = 0;  ///< when its first sweep begins: the phase between LiDARs
  core::SE3 T_body_lidar = core::SE3::Identity();
  lidar::NoiseOptions noise;
  lidar::SpinOptions spin;
  lidar::BeamOptions beam;
  /// Path of recorded column times (lidar/column_times.h), relative as `model` is. After read_rig: empty, and `replay`
  /// holds what was read.
  std::string column_times;
  std::vector<lidar::ReplayedSweep> replay;
  /// The scenario's own sensor, written out: a resolved scenario needs no other file. A bundled one stays a name.
  bool own_profile = false;
  lidar::Profile profile;
  void visit(core::OptionVisitor& v);
};

struct RigOptions {
  std::vector<LidarOptions> lidars{1};  ///< at least one
  bool listed = false;                  ///< written as `lidars: [...]`, not as one `lidar:` block
  bool has_imu = false;                 ///< the block is there: without it the rig carries none
  ImuOptions imu;
  double gravity_m_s2 = 9.80665;
  lidar::BodyOptions body;
  void visit(core::OptionVisitor& v);
};

/// Options with the model's defaults filled in and its files read. Throws InputError with file and line.
RigOptions read_rig(const core::ConfigNode& rig);
/// When and where a LiDAR fires; `seed` draws its spin jitter.
lidar::FiringTable firing_table(const RigOptions& options, std::uint64_t seed, std::size_t lidar = 0);
/// The data sheet that goes with the recording: nominal values, which here are the true ones.
core::Rig data_sheet(const RigOptions& options);

}  // namespace tarmac::sim
