#include "metrics/firing_poses.h"

#include <algorithm>

namespace tarmac::metrics {

using namespace core;

SE3 TruthPoses::pose(Time t) {
  if (exact_) return truth_.pose(t);
  constexpr std::int64_t kBucketNs = 100'000;
  const std::int64_t bucket = to_ns(t) / kBucketNs;
  if (!has_anchor_ || bucket != bucket_) {
    has_anchor_ = true;
    bucket_ = bucket;
    anchor_t_ = std::clamp(time_from_ns(bucket * kBucketNs + kBucketNs / 2), truth_.begin(), truth_.end());
    if (!truth_.covers(anchor_t_)) anchor_t_ = t;
    anchor_ = truth_.at(anchor_t_);
  }
  const double dt = to_s(t - anchor_t_);
  SE3 T = anchor_.T_world_body;
  T.linear() = T.linear() * so3::exp(anchor_.omega_body * dt + anchor_.alpha_body * (dt * dt / 2));
  T.translation() += anchor_.v_world * dt + anchor_.a_world * (dt * dt / 2);
  return T;
}

std::vector<Firing> firings_of(const sim::truth::PointLabels& labels, const PiecewiseTrajectory& estimate,
                               const SmoothTrajectory& truth, const std::vector<std::uint16_t>& point_sensor) {
  std::vector<Firing> firings;
  const auto sensor = [&](std::size_t i) { return point_sensor.empty() ? std::uint16_t{0} : point_sensor[i]; };
  for (std::size_t i = 0; i < labels.t_ns.size(); ++i) {
    if (i == 0 || labels.t_ns[i] != labels.t_ns[i - 1] || sensor(i) != sensor(i - 1))
      firings.push_back({.first = i, .last = i, .t = labels.time(i), .sensor = sensor(i)});
    firings.back().last = i + 1;
  }
  TruthPoses truth_poses(truth, firings.size());
  for (Firing& firing : firings) {
    const Segment* segment = estimate.find(firing.t);
    firing.covered = segment && truth_poses.covers(firing.t);
    if (!firing.covered) continue;
    firing.T_map_body = segment->pose(firing.t);
    firing.T_world_body = truth_poses.pose(firing.t);
  }
  return firings;
}

}  // namespace tarmac::metrics
