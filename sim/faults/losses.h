/// What of a LiDAR's stream never arrives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "sim/faults/columns.h"
#include "sim/faults/fault_options.h"
#include "sim/faults/sweep_stamps.h"

namespace tarmac::sim::faults {

class Losses {
 public:
  Losses(const LidarFaultOptions& options, std::uint64_t seed, const std::string& sensor);

  bool sweep_lost(std::int64_t index, core::Time true_begin) const;
  bool packet_lost(std::int64_t sweep_index, std::size_t packet) const;
  /// Per column: 1 where it is lost with its packet or its sector.
  std::vector<std::uint8_t> lost_columns(std::int64_t sweep_index, core::Time true_begin, const Columns& columns) const;
  bool needs_columns() const { return options_.lost_packets > 0 || !options_.lost_sectors.empty(); }

 private:
  LidarFaultOptions options_;
  core::RandomStream sweeps_, packets_;
};

}  // namespace tarmac::sim::faults
