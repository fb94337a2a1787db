/// All faults of one LiDAR's stream.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "sim/faults/columns.h"
#include "sim/faults/fault_options.h"
#include "sim/faults/losses.h"
#include "sim/faults/point_times.h"
#include "sim/faults/sweep_stamps.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::sim::faults {

/// A pure function of a sweep's index once constructed: sweeps may come in any order, on any threads.
class LidarFaults {
 public:
  /// `true_sweeps`: begin and end of sweeps 0, 1, 2, ...; `sensor` names the random draws: "lidar0".
  LidarFaults(const LidarFaultOptions& options, const std::vector<SweepStamp>& true_sweeps, std::uint64_t seed,
              const std::string& sensor);

  /// The whole sweep never reaches the recording.
  bool lost(std::int64_t index) const;
  /// apply() reads `columns`; otherwise it may be empty.
  bool needs_columns() const { return losses_.needs_columns() || point_times_.needs_columns(); }
  /// Turns a sweep with true times into what is recorded. Labels lose the same points and keep their true times.
  void apply(core::LidarSweep& sweep, truth::PointLabels& labels, const Columns& columns) const;
  /// How many packets of the sweep are lost.
  std::size_t lost_packets(std::int64_t index, std::size_t columns) const;

 private:
  LidarFaultOptions options_;
  std::vector<SweepStamp> true_, recorded_;
  PointTimes point_times_;
  Losses losses_;
};

}  // namespace tarmac::sim::faults
