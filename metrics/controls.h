/// Positive controls: estimates made from the truth itself, which give every metric its floor and its known answer.
/// They live outside the wall: no estimator can name them.
#pragma once

#include "core/estimate.h"
#include "core/recording.h"
#include "metrics/sweep_source.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

/// A known error put into the truth; map stays the world's frame. `start` is the first sweep's reference instant:
///   T_hat(t) = Turn(t) Scale(T(t + shift)) C_right
/// Turn(t) turns the world about the vertical through the true position at `start`, by yaw_rate_error (t - start);
/// Scale moves the position away from that point by the factor and keeps the rotation; shift acts in one sweep only.
struct KnownError {
  core::SE3 C_right = core::SE3::Identity();  ///< a wrong extrinsic (lever arm)
  double yaw_rate_error_rad_s = 0;
  double speed_scale = 1;
  std::int64_t shifted_sweep = -1;  ///< this sweep's poses are those of `shift` later
  core::Duration shift{0};
};

/// `truth-replay` when `error` is the default, `truth-with-known-error` else. Reference instant: sweep end. Each sweep
/// is a segment of poses at its points' stamps (of bursts closer than 100 us the first and the last), with a constant
/// twist between: exact at these, and off by at most acceleration x (200 us)^2 / 8 at the others. A sweep that the
/// truth does not cover is `lost`. Throws InputError when a shift leads out of the truth's span.
core::Estimate make_control(const sim::truth::GroundTruth& truth, const SweepSource& sweeps,
                            const KnownError& error = {});
core::Estimate make_control(const sim::truth::GroundTruth& truth, const core::Recording& recording,
                            const KnownError& error = {});

}  // namespace tarmac::metrics
