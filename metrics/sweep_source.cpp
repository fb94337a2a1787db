#include "metrics/sweep_source.h"

namespace tarmac::metrics {

DiagnosticsSource diagnostics_of(const core::DiagnosticsReader& reader) {
  return {reader.size(), [&reader](std::size_t i) { return reader.read(i); }};
}

DiagnosticsSource diagnostics_of(const std::vector<core::SweepDiagnostics>& sweeps) {
  return {sweeps.size(), [&sweeps](std::size_t i) { return sweeps[i]; }};
}

SweepSource sweeps_of(const core::Recording& recording, std::size_t lidar) {
  return {recording.sweep_count(lidar), [&recording, lidar](std::size_t i) { return recording.sweep(i, lidar); },
          recording.rig(), lidar};
}

}  // namespace tarmac::metrics
