#include "metrics/foreign.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/trajectory.h"
#include "metrics/drift.h"
#include "metrics/pose_pairs.h"
#include "metrics/trajectory_error.h"

namespace tarmac::metrics {

using namespace core;

namespace {

void check(const std::vector<StampedPose>& poses, const char* which) {
  if (poses.empty()) throw InputError(fmt::format("the {} has no poses: nothing to evaluate", which));
  for (std::size_t k = 1; k < poses.size(); ++k)
    if (poses[k].first <= poses[k - 1].first)
      throw InputError(
          fmt::format("the {} is not in strictly ascending time: pose {} has stamp {} ns, the one before {} "
                      "ns; sort it and remove doubles",
                      which, k + 1, to_ns(poses[k].first), to_ns(poses[k - 1].first)));
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (!se3::all_finite(poses[k].second))
      throw InputError(fmt::format("the {} has a pose that is not finite: pose {}", which, k + 1));
}

std::string span_text(const std::vector<StampedPose>& poses) {
  return fmt::format("{:.3f} s to {:.3f} s", to_s(poses.front().first), to_s(poses.back().first));
}

/// The truth in pieces: a gap ends one and begins the next.
PiecewiseTrajectory pieces_of(const std::vector<StampedPose>& truth, Duration max_gap) {
  PiecewiseTrajectory pieces;
  std::vector<Time> times;
  std::vector<SE3> poses;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    times.push_back(truth[k].first);
    poses.push_back(truth[k].second);
    if (k + 1 < truth.size() && truth[k + 1].first - truth[k].first <= max_gap) continue;
    pieces.append(Segment::sampled(SegmentModel::sampled_screw, std::move(times), std::move(poses)));
    times.clear();
    poses.clear();
  }
  return pieces;
}

/// Path length over the interpolated truth; a gap counts as the straight line across it.
void measure_foreign_path(std::vector<PosePair>& pairs, const std::vector<StampedPose>& truth) {
  auto next = truth.begin();
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    Eigen::Vector3d last = pairs[k - 1].T_world_body.translation();
    double length = 0;
    while (next != truth.end() && next->first <= pairs[k - 1].t) ++next;
    for (; next != truth.end() && next->first < pairs[k].t; ++next) {
      length += (next->second.translation() - last).norm();
      last = next->second.translation();
    }
    pairs[k].distance_m = pairs[k - 1].distance_m + length + (pairs[k].T_world_body.translation() - last).norm();
  }
}

}  // namespace

ForeignEvaluation evaluate_poses(const std::vector<StampedPose>& truth, const std::vector<StampedPose>& estimate,
                                 const ForeignSettings& settings) {
  check(truth, "truth");
  check(estimate, "estimate");
  const PiecewiseTrajectory pieces = pieces_of(truth, settings.max_gap);
  ForeignEvaluation result;
  std::vector<PosePair> pairs;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const Time t = estimate[k].first;
    if (t < truth.front().first || t > truth.back().first)
      ++result.outside;
    else if (!pieces.covers(t))
      ++result.in_gaps;
    else
      pairs.push_back({static_cast<std::int64_t>(k), t, pieces.pose(t), estimate[k].second, 0});
  }
  if (pairs.empty())
    throw InputError(fmt::format(
        "no pose of the estimate can be compared: it spans {}, the truth {}, with {} stamps outside and {} in gaps "
        "longer than {} s; check the clocks and the unit of the stamps",
        span_text(estimate), span_text(truth), result.outside, result.in_gaps, to_s(settings.max_gap)));
  measure_foreign_path(pairs, truth);
  result.associated = pairs.size();

  RowSet rows("causal");
  rows.put("coverage_percent", 100 * static_cast<double>(pairs.size()) / static_cast<double>(estimate.size()));
  add_trajectory_rows(pairs, {.gravity_aligned = settings.gravity_aligned, .common_frame = true}, rows);
  add_drift_rows(pairs, rows);
  result.rows = rows.rows();
  if (settings.alignment) {
    const std::string wanted = fmt::format("ate_{}_", name_of(*settings.alignment));
    std::erase_if(result.rows,
                  [&](const Row& row) { return row.metric.starts_with("ate_") && !row.metric.starts_with(wanted); });
  }
  return result;
}

}  // namespace tarmac::metrics
