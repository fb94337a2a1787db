/// What faulty clocks, drivers and readers make of the firing times of a sweep's points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/time.h"
#include "sim/faults/clock.h"
#include "sim/faults/columns.h"
#include "sim/faults/fault_options.h"
#include "sim/faults/sweep_stamps.h"

namespace tarmac::sim::faults {

class PointTimes {
 public:
  PointTimes(const LidarFaultOptions& options, std::uint64_t seed, const std::string& sensor);

  /// True firing times [ns from the true begin] to recorded ones [ns from the recorded begin]. Order of effects: stamps
  /// of packets, clock, packets' jitter, reversal, unit and scale, origin, step, 32-bit floats, missing. `columns` is
  /// read only where packets matter.
  void apply(std::int64_t sweep_index, const SweepStamp& true_sweep, const SweepStamp& recorded, const Columns& columns,
             std::vector<std::int32_t>& t_ns) const;
  bool needs_columns() const { return options_.point_time_per_packet || options_.packet_jitter_ms > 0; }

 private:
  std::vector<std::int64_t> by_sensor(std::int64_t sweep_index, const SweepStamp& true_sweep, const Columns& columns,
                                      const std::vector<std::int32_t>& t_ns) const;
  double by_driver(double t_ns, std::int64_t span_ns, core::Time recorded_begin) const;

  LidarFaultOptions options_;
  FaultyClock clock_;
  core::RandomStream packet_jitter_;
};

}  // namespace tarmac::sim::faults
