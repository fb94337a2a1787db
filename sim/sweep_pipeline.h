/// Sweeps made on many threads and written in order, a few in memory at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/chunk_file.h"
#include "core/recording.h"
#include "scenes/scene.h"
#include "sim/faults/lidar_faults.h"
#include "sim/lidar/sweep_simulator.h"

namespace tarmac::sim {

/// A chunk as it is appended to a file.
struct EncodedChunk {
  std::uint64_t digest = 0;
  std::vector<std::byte> bytes;
};

struct EncodedSweep {
  EncodedChunk points, labels;
};

/// Points for the recording, what they hit for the truth.
EncodedSweep encode(const lidar::SimulatedSweep& simulated, const scenes::Scene& scene);

struct PipelineTotals {
  std::size_t sweeps = 0, rays = 0, points = 0;  ///< recorded
  std::size_t lost = 0;                          ///< sweeps that a fault kept from the recording
  double trace_cpu_s = 0;
};

/// Called after each written sweep, from one thread at a time; what it throws ends the pipeline and comes out of run().
using AfterSweep = std::function<void(const PipelineTotals& so_far)>;

/// Simulates sweeps [0, count) on `threads` threads, points to `recording`, what they hit to `labels`; both as `faults`
/// leaves them, when it is given.
PipelineTotals run_sweeps(const lidar::SweepSimulator& simulator, const scenes::Scene& scene, std::int64_t count,
                          int threads, core::RecordingWriter& recording, core::ChunkWriter& labels,
                          const AfterSweep& after_sweep, const faults::LidarFaults* faults = nullptr);

}  // namespace tarmac::sim
