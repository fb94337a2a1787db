/// How far the constant-velocity prediction has been off so far: KISS-ICP's only notion of scale.
#pragma once

#include <cmath>

#include "core/lie.h"

namespace tarmac::estimators {

/// sigma = sqrt(mean of e^2), e(M) = |trans(M)| + 2 r_max sin(theta / 2), over deviations M = T_pred^-1 T_new with
/// e above min_motion_m; the initial threshold counts as the first sample. Never windowed, never forgotten.
/// Source: Vizzo et al., RA-L 8(2) 2023, section III-D, with upstream v1.2.3's treatment of the initial value.
class AdaptiveThreshold {
 public:
  AdaptiveThreshold(double initial_threshold_m, double min_motion_m, double max_range_m)
      : min_motion_m_(min_motion_m), max_range_m_(max_range_m), sum_m2_(initial_threshold_m * initial_threshold_m) {}

  double sigma_m() const { return std::sqrt(sum_m2_ / samples_); }

  void update(const core::SE3& deviation) {
    const double theta = core::so3::angle_rad(deviation.linear());
    last_deviation_m_ = deviation.translation().norm() + 2 * max_range_m_ * std::sin(theta / 2);
    if (last_deviation_m_ > min_motion_m_) {
      sum_m2_ += last_deviation_m_ * last_deviation_m_;
      ++samples_;
    }
  }
  double last_deviation_m() const { return last_deviation_m_; }

 private:
  double min_motion_m_;
  double max_range_m_;
  double sum_m2_;
  int samples_ = 1;
  double last_deviation_m_ = 0;
};

}  // namespace tarmac::estimators
