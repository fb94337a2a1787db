#include "metrics/pose_pairs.h"

#include <algorithm>

namespace tarmac::metrics {

using namespace core;

double path_length_m(const Trajectory& truth, Time t0, Time t1) {
  constexpr Duration kStep{10'000'000};
  double length = 0;
  Eigen::Vector3d last = truth.pose(t0).translation();
  for (Time t = t0; t < t1;) {
    t = std::min(t + kStep, t1);
    const Eigen::Vector3d next = truth.pose(t).translation();
    length += (next - last).norm();
    last = next;
  }
  return length;
}

void measure_path(const Trajectory& truth, std::vector<PosePair>& pairs) {
  for (std::size_t k = 0; k < pairs.size(); ++k)
    pairs[k].distance_m = k == 0 ? 0 : pairs[k - 1].distance_m + path_length_m(truth, pairs[k - 1].t, pairs[k].t);
}

std::optional<SE3> pose_from_before(const PiecewiseTrajectory& trajectory, Time t) {
  const Segment* earlier = trajectory.find(t - Duration(1));
  if (earlier && earlier->t1 >= t) return earlier->pose(t);
  if (const Segment* segment = trajectory.find(t)) return segment->pose(t);
  return std::nullopt;
}

std::optional<SE3> pose_of_sweep(const PiecewiseTrajectory& trajectory, const SweepResult& sweep) {
  if (sweep.reference == sweep.end && sweep.begin < sweep.end) return pose_from_before(trajectory, sweep.end);
  const Segment* segment = trajectory.find(sweep.reference);
  return segment ? std::optional<SE3>(segment->pose(sweep.reference)) : std::nullopt;
}

bool is_scored(const SweepResult& sweep, const Trajectory& truth) {
  return sweep.status == SweepStatus::ok && se3::all_finite(sweep.T_map_body) && truth.covers(sweep.reference);
}

std::vector<PosePair> pair_poses(const Estimate& estimate, bool final_trajectory, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (const SweepResult& sweep : estimate.sweeps) {
    if (!is_scored(sweep, truth)) continue;
    const std::optional<SE3> T_map_body =
        final_trajectory ? pose_of_sweep(estimate.final, sweep) : std::optional<SE3>(sweep.T_map_body);
    if (!T_map_body || !se3::all_finite(*T_map_body)) continue;
    pairs.push_back({sweep.index, sweep.reference, truth.pose(sweep.reference), *T_map_body, 0});
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const PosePair& a, const PosePair& b) { return a.t < b.t; });
  measure_path(truth, pairs);
  return pairs;
}

}  // namespace tarmac::metrics
