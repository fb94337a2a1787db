/// The IMU alone, integrated: what a LiDAR method has to beat.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "estimators/dead_reckoning/propagate.h"
#include "estimators/dead_reckoning/sample_chain.h"
#include "estimators/dead_reckoning/static_start.h"
#include "estimators/estimator.h"

namespace tarmac::estimators {

/// Starts from a rest and integrates. A sample stands for the mean over one period around its middle, which lies
/// ImuSheet::delay before its stamp. map: gravity-aligned, its origin at the body at rest. Reference: the sweep's end.
class DeadReckoning final : public Estimator {
 public:
  DeadReckoning(const DeadReckoningOptions& options, const EstimatorContext& context);
  void add(const core::ImuSample& sample) override;
  SweepOutcome add(const core::LidarSweep& sweep) override;
  void finish(core::Estimate& estimate) override;

 private:
  /// A span of constant rate and specific force.
  struct Interval {
    InertialState start;
    core::Time end;
    Eigen::Vector3d omega_rad_s, f_m_s2;
    bool hole = false;  ///< no sample stands for it
  };
  void begin_at(const StaticStart::Result& start, core::Time end);
  InertialState state_at(const Interval& interval, core::Time t) const;
  bool covers(const core::LidarSweep& sweep) const {
    return !intervals_.empty() && intervals_.front().start.t <= sweep.begin;
  }
  core::Segment motion_over(const core::LidarSweep& sweep) const;
  bool in_hole(const core::LidarSweep& sweep) const;

  DeadReckoningOptions options_;
  core::ImuSheet sheet_;
  double gravity_m_s2_;
  std::string cannot_start_;  ///< why; empty when it can
  std::optional<StaticStart> static_start_;
  std::optional<StaticStart::Result> start_;
  std::optional<SampleChain> chain_;
  std::deque<Interval> intervals_;  ///< contiguous, back to the last sweep's end
};

}  // namespace tarmac::estimators
