/// Where a point lies between its sweep's begin and end.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/measurements.h"

namespace tarmac::estimators {

/// The time that a sweep's motion covers: from its first firing to its last. Where the points' stamps cover less than
/// half of it (a sector of the sweep, or stamps in a wrong unit), from the first stamp to the last: begin and end could
/// not be told apart otherwise. Stamps outside are moved to the nearer end and counted. Where all stamps are equal
/// nothing can be said of motion inside the sweep: `elastic` is false.
class SweepSpan {
 public:
  SweepSpan() = default;
  explicit SweepSpan(const core::LidarSweep& sweep);

  bool elastic() const { return elastic_; }
  core::Time begin() const { return begin_; }
  core::Time end() const { return end_; }
  int clipped() const { return clipped_; }
  /// In [0, 1]; 1 where the span is empty.
  double alpha(std::int32_t t_ns) const {
    if (last_ns_ <= first_ns_) return 1;
    return std::clamp(static_cast<double>(t_ns - first_ns_) / static_cast<double>(last_ns_ - first_ns_), 0.0, 1.0);
  }

 private:
  bool elastic_ = false;
  int clipped_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;  ///< from the sweep's begin
  core::Time begin_, end_;
};

}  // namespace tarmac::estimators
