/// IMU samples as a gapless chain of spans.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/measurements.h"
#include "core/rig.h"

namespace tarmac::estimators {

/// What is missing from a rig that a method can integrate its IMU; empty when nothing is.
std::string no_usable_imu(const core::Rig& rig);

/// A span of constant rate and specific force, as read: biases included.
struct ImuSpan {
  core::Time begin, end;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  bool hole = false;  ///< no sample stands for it, and it is longer than may be bridged
};

/// A sample stands for the mean over one period around its middle, which lies ImuSheet::delay before its stamp. Spans
/// touch: half a period absorbs jittering stamps, and a hole between two samples becomes a span with the mean of its
/// two sides, marked when it is longer than `max_gap_periods`.
class SampleChain {
 public:
  /// @param first where the chain begins: a span from before the first sample
  SampleChain(const core::ImuSheet& sheet, double max_gap_periods, const ImuSpan& first)
      : delay_(sheet.delay),
        period_(core::duration_from_s(1 / sheet.rate_hz)),
        max_gap_periods_(max_gap_periods),
        last_(first) {}
  /// @returns the spans that the sample adds to the chain's end, in order: none, one, or two
  std::vector<ImuSpan> add(const core::ImuSample& sample);

  core::Duration period() const { return period_; }
  /// How long after the chain's end the next sample may still come, without anything missing.
  core::Duration patience() const;

 private:
  core::Duration delay_, period_;
  double max_gap_periods_;
  ImuSpan last_;
};

}  // namespace tarmac::estimators
