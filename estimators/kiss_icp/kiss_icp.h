/// KISS-ICP as an estimator of the body's motion; rigid-icp is the same with deskewing off.
#pragma once

#include <tbb/task_arena.h>

#include "estimators/estimator.h"
#include "estimators/kiss_icp/odometry.h"

namespace tarmac::estimators {

/// Throws InputError when options contradict each other.
KissIcpOptions checked(const KissIcpOptions& options);
/// Options with deskewing as told.
KissIcpOptions kiss_options(const RigidIcpOptions& options, bool deskew);

/// T_map_body = T_map_lidar T_lidar_body by the nominal extrinsic; the map is the LiDAR's frame at the first sweep's
/// last point. Reference instant: the sweep's last point.
class KissIcp : public Estimator {
 public:
  /// Throws InputError when options contradict each other.
  KissIcp(const KissIcpOptions& options, const EstimatorContext& context);
  using Estimator::add;
  SweepOutcome add(const core::LidarSweep& sweep) override;

 private:
  KissOdometry odometry_;
  core::DiagnosticsLevel level_;
  core::SE3 T_lidar_body_;
  tbb::task_arena arena_;
};

class RigidIcp final : public KissIcp {
 public:
  RigidIcp(const RigidIcpOptions& options, const EstimatorContext& context);
};

}  // namespace tarmac::estimators
