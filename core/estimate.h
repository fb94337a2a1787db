/// What an estimator returns: T_map_body as a function of time, and a result per sweep. `map` is an arbitrary frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/lie.h"
#include "core/trajectory.h"

namespace tarmac::core {

/// Values are written to files: never renumber.
enum class SweepStatus : std::uint8_t {
  ok = 0,
  initialising = 1,  ///< the method says itself that this pose is not to be trusted yet
  lost = 2,          ///< the method found no solution and kept its prediction
  empty = 3,         ///< no usable point in the sweep
  out_of_order = 4,  ///< the sweep begins before its predecessor ended: dropped
};
const char* name_of(SweepStatus status);

struct SweepResult {
  std::int64_t index = 0;
  Time begin, end;
  Time reference;  ///< the instant at which T_map_body holds (KISS-ICP: the time of the sweep's last point)
  SweepStatus status = SweepStatus::ok;
  SE3 T_map_body = SE3::Identity();
};

/// How the whole run ended.
enum class RunStatus : std::uint8_t { ok = 0, not_initialised = 1, failed = 2 };
const char* name_of(RunStatus status);

struct Estimate {
  std::string estimator;
  RunStatus status = RunStatus::ok;
  std::string message;           ///< why, when status is not ok
  bool gravity_aligned = false;  ///< map's z axis is up
  bool has_causal = true;        ///< batch methods have `final` only
  bool has_final = false;
  PiecewiseTrajectory causal;  ///< what was known when each sweep was done: what the method placed its points by
  PiecewiseTrajectory final;   ///< after all data
  std::vector<SweepResult> sweeps;

  const PiecewiseTrajectory& headline() const { return has_causal ? causal : final; }
};

/// trajectory.bin: both trajectories with their models and parameters in full, the sweep results and the run's status.
/// Written under another name and renamed when whole.
void save_estimate(const std::filesystem::path& file, const Estimate& estimate);
/// Throws DamagedFile when the file is not whole.
Estimate load_estimate(const std::filesystem::path& file);

}  // namespace tarmac::core
