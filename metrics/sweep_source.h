/// Where metrics get a LiDAR's sweeps from: a recording, or memory.
#pragma once

#include <cstddef>
#include <functional>

#include "core/measurements.h"
#include "core/recording.h"
#include "core/rig.h"

namespace tarmac::metrics {

struct SweepSource {
  std::size_t count = 0;
  std::function<core::LidarSweep(std::size_t)> sweep;  ///< the i-th; may be called from several threads
  core::Rig rig;                                       ///< nominal
  std::size_t lidar = 0;                               ///< index into rig.lidars
};

/// Keeps a reference to the recording.
SweepSource sweeps_of(const core::Recording& recording, std::size_t lidar = 0);

}  // namespace tarmac::metrics
