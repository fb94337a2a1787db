/// Where metrics get a LiDAR's sweeps and a method's diagnostics from: a file, or memory.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/diagnostics.h"
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

/// Where metrics get what the method recorded of each sweep: a file, or memory.
struct DiagnosticsSource {
  std::size_t count = 0;
  std::function<core::SweepDiagnostics(std::size_t)> sweep;  ///< the i-th; may be called from several threads
};

/// Keeps a reference to the reader.
DiagnosticsSource diagnostics_of(const core::DiagnosticsReader& reader);
/// Keeps a reference to the sweeps.
DiagnosticsSource diagnostics_of(const std::vector<core::SweepDiagnostics>& sweeps);

/// Keeps a reference to the recording.
SweepSource sweeps_of(const core::Recording& recording, std::size_t lidar = 0);

}  // namespace tarmac::metrics
