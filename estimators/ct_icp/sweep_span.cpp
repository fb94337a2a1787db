#include "estimators/ct_icp/sweep_span.h"

namespace tarmac::estimators {

SweepSpan::SweepSpan(const core::LidarSweep& sweep) {
  last_ns_ = (sweep.end - sweep.begin).count();
  if (!sweep.empty()) {
    const auto [low, high] = std::minmax_element(sweep.t_ns.begin(), sweep.t_ns.end());
    const std::int64_t first = std::clamp<std::int64_t>(*low, 0, last_ns_);
    const std::int64_t last = std::clamp<std::int64_t>(*high, 0, last_ns_);
    elastic_ = last > first;
    if (elastic_ && 2 * (last - first) < last_ns_) {
      first_ns_ = first;
      last_ns_ = last;
    }
    clipped_ = static_cast<int>(std::count_if(sweep.t_ns.begin(), sweep.t_ns.end(),
                                              [&](std::int32_t t_ns) { return t_ns < first_ns_ || t_ns > last_ns_; }));
  }
  begin_ = sweep.begin + core::Duration(first_ns_);
  end_ = sweep.begin + core::Duration(last_ns_);
}

}  // namespace tarmac::estimators
