#include "sim/faults/sweep_stamps.h"

#include <algorithm>

#include "core/random.h"
#include "sim/faults/clock.h"

namespace tarmac::sim::faults {

using namespace core;

namespace {

Duration taken_after(const std::string& instant, Duration span) {
  return instant == "end" ? span : instant == "mid" ? span / 2 : Duration(0);
}

void put_in_order(std::vector<SweepStamp>& sweeps) {
  constexpr Duration least{1};
  for (std::size_t k = 1; k < sweeps.size(); ++k) {
    sweeps[k].begin = std::max(sweeps[k].begin, sweeps[k - 1].begin + least);
    sweeps[k - 1].end = std::max(sweeps[k - 1].begin, std::min(sweeps[k - 1].end, sweeps[k].begin - least));
  }
  if (!sweeps.empty()) sweeps.back().end = std::max(sweeps.back().begin, sweeps.back().end);
}

}  // namespace

std::vector<SweepStamp> faulty_stamps(const LidarFaultOptions& options, const std::vector<SweepStamp>& true_sweeps,
                                      std::uint64_t seed, const std::string& sensor) {
  const FaultyClock clock(options.clock_offset_ms, options.clock_drift_ppm);
  const RandomStream jitter(seed, sensor + "/faults/sweep_jitter");
  std::vector<SweepStamp> out;
  for (std::size_t k = 0; k < true_sweeps.size(); ++k) {
    const Time begin = clock(true_sweeps[k].begin), end = clock(true_sweeps[k].end);
    Duration late = taken_after(options.stamp, end - begin);
    if (options.sweep_jitter_ms > 0) late += duration_from_s(1e-3 * options.sweep_jitter_ms * jitter.normal(k));
    out.push_back({begin + late, end + late});
  }
  if (options.sweep_jitter_ms > 0) put_in_order(out);
  return out;
}

}  // namespace tarmac::sim::faults
