#include "metrics/sweep_source.h"

namespace tarmac::metrics {

SweepSource sweeps_of(const core::Recording& recording, std::size_t lidar) {
  return {recording.sweep_count(lidar), [&recording, lidar](std::size_t i) { return recording.sweep(i, lidar); },
          recording.rig(), lidar};
}

}  // namespace tarmac::metrics
