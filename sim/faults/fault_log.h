/// What was injected, for truth/faults.json: one entry a fault, with its numbers under names that carry their units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/faults/fault_options.h"
#include "sim/faults/lidar_faults.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::sim::faults {

/// Empty when nothing is wrong. `columns[k]` = columns of sweep k, for the count of lost packets.
std::vector<truth::Fault> lidar_log(const LidarFaultOptions& options, const LidarFaults& realised,
                                    const std::vector<std::size_t>& columns, const std::string& sensor);
/// `lost` of `samples` (after gaps) were lost by chance.
std::vector<truth::Fault> imu_log(const ImuFaultOptions& options, std::size_t lost, std::size_t samples,
                                  const std::string& sensor);

}  // namespace tarmac::sim::faults
