/// All faults of one IMU's stream.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "sim/faults/fault_options.h"

namespace tarmac::sim::faults {

/// Takes samples away (gaps, losses: by their true stamps), then restamps the rest: clock, jitter. Stamps strictly
/// ascend: one that jitter would put before its predecessor comes 1 ns after it. `sensor` names the draws: "imu0".
/// Returns how many were lost by chance.
std::size_t apply_imu_faults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor,
                             std::vector<core::ImuSample>& samples);

}  // namespace tarmac::sim::faults
