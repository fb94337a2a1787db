/// KISS-ICP with the IMU in place of its constant-velocity model.
#pragma once

#include <tbb/task_arena.h>

#include <optional>
#include <string>

#include "estimators/estimator.h"
#include "estimators/kiss_icp/odometry.h"
#include "estimators/kiss_icp_imu/inertial_path.h"
#include "estimators/kiss_icp_imu/options.h"

namespace tarmac::estimators {

/// Points are placed, and the pose at the sweep's last point predicted, by the IMU's propagation since the last
/// registration; the registration then sets position and attitude, and part of the velocity. map: gravity-aligned, its
/// origin at the body at rest. Reference instant: the sweep's last point.
class KissIcpImu final : public Estimator {
 public:
  /// Throws InputError when options contradict each other.
  KissIcpImu(const KissIcpImuOptions& options, const EstimatorContext& context);
  void add(const core::ImuSample& sample) override;
  SweepOutcome add(const core::LidarSweep& sweep) override;
  void finish(core::Estimate& estimate) override;

 private:
  SweepOutcome register_sweep(const core::LidarSweep& sweep, bool has_map);
  void correct(const InertialState& predicted, const core::SE3& T_map_body, bool has_map);

  KissIcpImuOptions options_;
  KissOdometry odometry_;
  core::DiagnosticsLevel level_;
  core::SE3 T_body_lidar_;
  core::ImuSheet sheet_;
  double gravity_m_s2_;
  tbb::task_arena arena_;
  std::string cannot_start_;  ///< why; empty when it can
  std::optional<StaticStart> static_start_;
  std::optional<InertialPath> path_;
};

}  // namespace tarmac::estimators
