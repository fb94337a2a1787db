#include "sim/faults/imu_faults.h"

#include <algorithm>

#include "core/random.h"
#include "sim/faults/clock.h"

namespace tarmac::sim::faults {

using namespace core;

std::size_t apply_imu_faults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor,
                             std::vector<ImuSample>& samples) {
  const FaultyClock clock(options.clock_offset_ms, options.clock_drift_ppm);
  const RandomStream losses(seed, sensor + "/faults/lost_samples"), jitter(seed, sensor + "/faults/jitter");
  std::vector<ImuSample> kept;
  kept.reserve(samples.size());
  std::size_t lost = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample sample = samples[k];
    if (std::any_of(options.gaps.begin(), options.gaps.end(),
                    [&](const Interval& gap) { return gap.holds(to_s(sample.t)); }))
      continue;
    if (options.lost_samples > 0 && losses.uniform(k) < options.lost_samples) {
      ++lost;
      continue;
    }
    sample.t = clock(sample.t);
    if (options.jitter_ms > 0) {
      sample.t += duration_from_s(1e-3 * options.jitter_ms * jitter.normal(k));
      if (!kept.empty()) sample.t = std::max(sample.t, kept.back().t + Duration(1));
    }
    kept.push_back(sample);
  }
  samples = std::move(kept);
  return lost;
}

}  // namespace tarmac::sim::faults
