/// CT-ICP as an estimator of the body's motion.
#pragma once

#include <tbb/task_arena.h>

#include "estimators/ct_icp/odometry.h"
#include "estimators/estimator.h"

namespace tarmac::estimators {

/// Two poses of the body a sweep, at its begin and its end, T_map_body interpolated between them; the motion jumps
/// between sweeps. Reference instant: the end. The map is the body's frame at the first sweep.
class CtIcp final : public Estimator {
 public:
  /// Throws InputError when options contradict each other.
  CtIcp(const CtIcpOptions& options, const EstimatorContext& context);
  using Estimator::add;
  SweepOutcome add(const core::LidarSweep& sweep) override;

 private:
  CtOdometry odometry_;
  core::DiagnosticsLevel level_;
  tbb::task_arena arena_;
};

}  // namespace tarmac::estimators
