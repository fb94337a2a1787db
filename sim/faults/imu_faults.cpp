#include "sim/faults/imu_faults.h"

#include <algorithm>

namespace tarmac::sim::faults {

using namespace core;

ImuFaults::ImuFaults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor)
    : options_(options),
      clock_(options.clock_offset_ms, options.clock_drift_ppm),
      losses_(seed, sensor + "/faults/lost_samples"),
      jitter_(seed, sensor + "/faults/jitter") {}

std::optional<ImuSample> ImuFaults::next(ImuSample sample) {
  const std::uint64_t k = count_++;
  if (std::any_of(options_.gaps.begin(), options_.gaps.end(),
                  [&](const Interval& gap) { return gap.holds(to_s(sample.t)); }))
    return std::nullopt;
  if (options_.lost_samples > 0 && losses_.uniform(k) < options_.lost_samples) {
    ++lost_;
    return std::nullopt;
  }
  sample.t = clock_(sample.t);
  if (options_.jitter_ms > 0) {
    sample.t += duration_from_s(1e-3 * options_.jitter_ms * jitter_.normal(k));
    if (last_) sample.t = std::max(sample.t, *last_ + Duration(1));
  }
  last_ = sample.t;
  return sample;
}

std::size_t apply_imu_faults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor,
                             std::vector<ImuSample>& samples) {
  ImuFaults faults(options, seed, sensor);
  std::vector<ImuSample> kept;
  kept.reserve(samples.size());
  for (const ImuSample& sample : samples)
    if (const std::optional<ImuSample> recorded = faults.next(sample)) kept.push_back(*recorded);
  samples = std::move(kept);
  return faults.lost();
}

}  // namespace tarmac::sim::faults
