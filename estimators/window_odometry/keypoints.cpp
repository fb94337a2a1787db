#include "estimators/window_odometry/keypoints.h"

#include <algorithm>

namespace tarmac::estimators {

TimedPoints timed_points(const core::LidarSweep& sweep, std::span<const std::uint32_t> indices,
                         const core::SE3& T_body_lidar) {
  TimedPoints points;
  const auto last_ns = static_cast<std::int32_t>((sweep.end - sweep.begin).count());
  std::vector<std::uint32_t> order(indices.begin(), indices.end());
  const auto t_ns = [&](std::uint32_t i) { return std::clamp(sweep.t_ns[i], std::int32_t{0}, last_ns); };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return t_ns(a) < t_ns(b); });
  points.p_body.reserve(order.size());
  points.point = order;
  points.stamp.reserve(order.size());
  for (const std::uint32_t i : order) {
    if (sweep.t_ns[i] != t_ns(i)) ++points.clipped;
    const core::Time t = sweep.begin + core::Duration(t_ns(i));
    if (points.stamps.empty() || points.stamps.back() != t) points.stamps.push_back(t);
    points.p_body.push_back(T_body_lidar * sweep.point(i));
    points.stamp.push_back(static_cast<std::uint32_t>(points.stamps.size() - 1));
  }
  return points;
}

void place(const TimedPoints& points, const core::ParametricTrajectory& trajectory, std::vector<core::SE3>& T_map_body,
           std::vector<Eigen::Vector3d>& p_map) {
  T_map_body.resize(points.stamps.size());
  trajectory.poses(points.stamps, T_map_body);
  p_map.resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) p_map[k] = T_map_body[points.stamp[k]] * points.p_body[k];
}

LidarFactors lidar_factors(const TimedPoints& points, std::span<const SurfaceMatch> matches, bool distributions) {
  LidarFactors factors;
  factors.distributions = distributions;
  factors.first.clear();
  std::uint32_t last_stamp = 0;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    if (!matches[k].used) continue;
    if (factors.stamps.empty() || points.stamp[k] != last_stamp) {
      last_stamp = points.stamp[k];
      factors.stamps.push_back(points.stamps[last_stamp]);
      factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
    }
    factors.factors.push_back(matches[k].factor);
    factors.factors.back().point = points.point[k];
  }
  factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
  return factors;
}

}  // namespace tarmac::estimators
