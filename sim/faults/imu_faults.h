/// All faults of one IMU's stream.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "core/random.h"
#include "sim/faults/clock.h"
#include "sim/faults/fault_options.h"

namespace tarmac::sim::faults {

/// The faults of one stream, sample by sample.
class ImuFaults {
 public:
  ImuFaults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor);
  /// What becomes of the next sample; nullopt: it never arrives.
  std::optional<core::ImuSample> next(core::ImuSample sample);
  std::size_t lost() const { return lost_; }  ///< by chance, so far

 private:
  ImuFaultOptions options_;
  FaultyClock clock_;
  core::RandomStream losses_, jitter_;
  std::uint64_t count_ = 0;
  std::size_t lost_ = 0;
  std::optional<core::Time> last_;
};

/// Takes samples away (gaps, losses: by their true stamps), then restamps the rest: clock, jitter. Stamps strictly
/// ascend: one that jitter would put before its predecessor comes 1 ns after it. `sensor` names the draws: "imu0".
/// Returns how many were lost by chance.
std::size_t apply_imu_faults(const ImuFaultOptions& options, std::uint64_t seed, const std::string& sensor,
                             std::vector<core::ImuSample>& samples);

}  // namespace tarmac::sim::faults
