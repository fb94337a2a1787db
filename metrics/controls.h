/// Positive controls: estimates made from the truth itself, which give every metric its floor and its known answer.
/// They live outside the wall: no estimator can name them.
#pragma once

#include "core/estimate.h"
#include "core/recording.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics {

/// A known error put into the truth.
struct KnownError {
  core::SE3 C_right = core::SE3::Identity();  ///< T_hat(t) = T(t) C_right: a wrong extrinsic (lever arm)
  double yaw_rate_error_rad_s = 0;            ///< T_hat(t) = T(t) turned about the start by an angle growing with time
  double speed_scale = 1;                     ///< path scaled about its start
  std::int64_t shifted_sweep = -1;            ///< this sweep's poses are those of `shift` later
  core::Duration shift{0};
};

/// `truth-replay` when `error` is the default, `truth-with-known-error` else. Reference instant: sweep end.
core::Estimate make_control(const sim::truth::GroundTruth& truth, const core::Recording& recording,
                            const KnownError& error = {});

}  // namespace tarmac::metrics
