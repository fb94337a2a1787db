#include "estimators/kiss_icp/deskew.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

namespace tarmac::estimators {

using core::SE3;

void SweepMotion::find_stamps(const core::LidarSweep& sweep) {
  if (sweep.empty()) {
    last_ns_ = static_cast<std::int32_t>(std::min<std::int64_t>((sweep.end - sweep.begin).count(), INT32_MAX));
  } else {
    const auto [first, last] = std::minmax_element(sweep.t_ns.begin(), sweep.t_ns.end());
    first_ns_ = *first;
    last_ns_ = *last;
  }
}

SweepMotion::SweepMotion(const core::LidarSweep& sweep, const SE3& D, bool deskew) {
  find_stamps(sweep);
  moves_ = deskew && last_ns_ > first_ns_;
  twist_ = core::se3::log(D);
}

SweepMotion::SweepMotion(const core::LidarSweep& sweep, core::Segment path, const SE3& T_body_lidar)
    : begin_(sweep.begin), path_(std::move(path)), T_body_lidar_(T_body_lidar) {
  find_stamps(sweep);
  moves_ = last_ns_ > first_ns_;
  T_end_path_ = T_body_lidar_.inverse() * path_pose(last_ns_).inverse();
}

SE3 SweepMotion::path_pose(std::int64_t t_ns) const {
  return path_->pose(std::clamp(begin_ + core::Duration(t_ns), path_->t0, path_->t1));
}

SE3 SweepMotion::T_end_point(std::int64_t t_ns) const {
  if (!moves_) return SE3::Identity();
  if (path_) return T_end_path_ * path_pose(t_ns) * T_body_lidar_;
  return core::se3::exp((phase(t_ns) - 1) * twist_);
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
