#include "estimators/kiss_icp/deskew.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

namespace tarmac::estimators {

using core::SE3;

SweepMotion::SweepMotion(const core::LidarSweep& sweep, const SE3& D, bool deskew) {
  if (sweep.empty()) {
    last_ns_ = static_cast<std::int32_t>(std::min<std::int64_t>((sweep.end - sweep.begin).count(), INT32_MAX));
  } else {
    const auto [first, last] = std::minmax_element(sweep.t_ns.begin(), sweep.t_ns.end());
    first_ns_ = *first;
    last_ns_ = *last;
  }
  moves_ = deskew && last_ns_ > first_ns_;
  twist_ = core::se3::log(D);
}

void deskew(const core::LidarSweep& sweep, const SweepMotion& motion, std::vector<Eigen::Vector3d>& points_m) {
  points_m.resize(sweep.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sweep.size(), 4096), [&](const auto& range) {
    std::int32_t t_ns = sweep.t_ns[range.begin()];
    SE3 T = motion.T_end_point(t_ns);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      // The channels that fire together share their stamp, and the exponential is most of the work.
      if (sweep.t_ns[i] != t_ns) {
        t_ns = sweep.t_ns[i];
        T = motion.T_end_point(t_ns);
      }
      points_m[i] = T.linear() * sweep.point(i) + T.translation();
    }
  });
}

}  // namespace tarmac::estimators
