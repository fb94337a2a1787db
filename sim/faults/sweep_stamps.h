/// What a faulty clock and driver write as begin and end of each sweep.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"
#include "sim/faults/fault_options.h"

namespace tarmac::sim::faults {

struct SweepStamp {
  core::Time begin, end;
};

/// Of true begins and ends: clock, the instant at which the stamp is taken, jitter drawn per sweep. A recording holds
/// sweeps in order, so where jitter would make them overlap, a sweep begins at least 1 ns after its predecessor and
/// ends at least 1 ns before its successor; point times count from the jittered begin all the same.
std::vector<SweepStamp> faulty_stamps(const LidarFaultOptions& options, const std::vector<SweepStamp>& true_sweeps,
                                      std::uint64_t seed, const std::string& sensor);

}  // namespace tarmac::sim::faults
