/// An odometry on a window as an estimator of the body's motion: what composed and the published methods built on it
/// share.
#pragma once

#include <tbb/task_arena.h>

#include "estimators/estimator.h"
#include "estimators/window_odometry/odometry.h"

namespace tarmac::estimators {

/// T_map_body over each sweep as the window had it when the sweep was done, in the model's own terms. Reference
/// instant: the sweep's end. With an IMU the map is gravity-aligned.
class WindowOdometryEstimator : public Estimator {
 public:
  WindowOdometryEstimator(const WindowOdometrySettings& settings, const EstimatorContext& context);
  void add(const core::ImuSample& sample) override { odometry_.add(sample); }
  SweepOutcome add(const core::LidarSweep& sweep) override;
  void finish(core::Estimate& estimate) override;

 private:
  WindowOdometry odometry_;
  core::DiagnosticsLevel level_;
  tbb::task_arena arena_;
  bool started_ = false;
};

}  // namespace tarmac::estimators
