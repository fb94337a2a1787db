#include "metrics/trajectory_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
/// Below this a path is no drive, and an error divided by it says nothing.
constexpr double kShortestPathM = 1;

Eigen::Matrix3Xd estimated_positions(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd p(3, pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    p.col(static_cast<Eigen::Index>(k)) = pairs[k].T_map_body.translation();
  return p;
}

Eigen::Matrix3Xd true_positions(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd q(3, pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    q.col(static_cast<Eigen::Index>(k)) = pairs[k].T_world_body.translation();
  return q;
}

RelativeError relative_error(const std::vector<PosePair>& pairs, std::size_t from, std::size_t to) {
  const SE3 dT_true = pairs[from].T_world_body.inverse() * pairs[to].T_world_body;
  const SE3 dT_est = pairs[from].T_map_body.inverse() * pairs[to].T_map_body;
  const SE3 E = dT_true.inverse() * dT_est;
  return {from, to, E.translation().norm(), so3::angle_rad(E.linear())};
}

void add_ate(const std::vector<PosePair>& pairs, Alignment a, const TrajectoryOptions& options, RowSet& rows) {
  const std::string prefix = fmt::format("ate_{}_", name_of(a));
  const bool detailed = a == Alignment::first_pose || a == Alignment::se3;
  const std::optional<Fit> fit = align(pairs, a, options.gravity_aligned);
  if (!fit) {
    rows.missing(prefix + "rmse_m", "the estimated positions are all equal, no scale is defined");
    return;
  }
  const std::vector<double> errors = position_errors_m(pairs, fit->A);
  rows.put(prefix + "rmse_m", rms(errors), fit->note);
  if (!detailed) return;
  rows.put(prefix + "median_m", quantile(errors, 0.5), fit->note);
  rows.put(prefix + "max_m", quantile(errors, 1), fit->note);
}

void add_rpe(const std::string& name, const std::vector<RelativeError>& errors, const std::string& reason,
             RowSet& rows) {
  const std::string trans = fmt::format("rpe_{}_trans_rmse_m", name), rot = fmt::format("rpe_{}_rot_rmse_deg", name);
  if (errors.empty()) {
    rows.missing(trans, reason);
    rows.missing(rot, reason);
    return;
  }
  std::vector<double> trans_m, rot_rad;
  for (const RelativeError& e : errors) {
    trans_m.push_back(e.trans_m);
    rot_rad.push_back(e.rot_rad);
  }
  rows.put(trans, rms(trans_m));
  rows.put(rot, rms(rot_rad) * kDegPerRad);
}

void add_end_error(const std::vector<PosePair>& pairs, double error_m, RowSet& rows) {
  const double path_m = pairs.back().distance_m;
  rows.put("end_error_m", error_m);
  rows.put("path_length_m", path_m);
  if (path_m >= kShortestPathM)
    rows.put("end_error_percent", 100 * error_m / path_m);
  else
    rows.missing("end_error_percent", fmt::format("the path is shorter than {} m", kShortestPathM));
}

Series drift_vs_distance(const std::vector<PosePair>& pairs) {
  Series drift{"drift_vs_distance", "length of the stretch [m]", "error over the stretch [m]", {}, {}, {}, {}};
  for (double decade = 1; decade < 1e7; decade *= 10) {
    for (const double step : {1.0, 2.0, 3.0, 5.0, 7.0}) {
      std::vector<double> errors;
      for (const RelativeError& e : relative_over_distance(pairs, step * decade)) errors.push_back(e.trans_m);
      if (errors.empty()) return drift;
      drift.x.push_back(step * decade);
      drift.y.push_back(rms(errors));
      drift.low.push_back(quantile(errors, 0.05));
      drift.high.push_back(quantile(errors, 0.95));
    }
  }
  return drift;
}

}  // namespace

SE3 first_pose_alignment(const std::vector<PosePair>& pairs) {
  return pairs.front().T_world_body * pairs.front().T_map_body.inverse();
}

std::optional<Fit> align(const std::vector<PosePair>& pairs, Alignment alignment, bool gravity_aligned) {
  if (pairs.empty()) return std::nullopt;
  const SE3 first = first_pose_alignment(pairs);
  switch (alignment) {
    case Alignment::none:
      return Fit{};
    case Alignment::first_pose:
      return Fit{{1, first}, ""};
    case Alignment::yaw_pos:
      return align_yaw_position(estimated_positions(pairs), true_positions(pairs),
                                gravity_aligned ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(first.linear()));
    case Alignment::se3:
      return align_se3(estimated_positions(pairs), true_positions(pairs), first.linear());
    case Alignment::sim3:
      return align_sim3(estimated_positions(pairs), true_positions(pairs), first.linear());
  }
  return std::nullopt;
}

std::vector<double> position_errors_m(const std::vector<PosePair>& pairs, const Similarity& A) {
  std::vector<double> errors;
  for (const PosePair& pair : pairs)
    errors.push_back((A * pair.T_map_body.translation() - pair.T_world_body.translation()).norm());
  return errors;
}

std::vector<double> rotation_errors_rad(const std::vector<PosePair>& pairs, const Similarity& A) {
  std::vector<double> errors;
  for (const PosePair& pair : pairs)
    errors.push_back(
        so3::angle_rad(pair.T_world_body.linear().transpose() * A.T_world_map.linear() * pair.T_map_body.linear()));
  return errors;
}

std::vector<RelativeError> relative_over_sweeps(const std::vector<PosePair>& pairs, std::int64_t n) {
  std::vector<RelativeError> errors;
  for (std::size_t k = 0, j = 0; k < pairs.size(); ++k) {
    while (j < pairs.size() && pairs[j].index < pairs[k].index + n) ++j;
    if (j < pairs.size() && pairs[j].index == pairs[k].index + n) errors.push_back(relative_error(pairs, k, j));
  }
  return errors;
}

std::vector<RelativeError> relative_over_time(const std::vector<PosePair>& pairs, Duration span) {
  std::vector<RelativeError> errors;
  if (pairs.size() < 2) return errors;
  std::vector<double> spacing_s;
  for (std::size_t k = 1; k < pairs.size(); ++k) spacing_s.push_back(to_s(pairs[k].t - pairs[k - 1].t));
  const double tolerance_s = quantile(spacing_s, 0.5) / 2;
  const auto miss_s = [&](std::size_t k, std::size_t j) { return std::abs(to_s(pairs[j].t - pairs[k].t - span)); };
  for (std::size_t k = 0, j = 0; k < pairs.size(); ++k) {
    j = std::max(j, k + 1);
    while (j + 1 < pairs.size() && miss_s(k, j + 1) < miss_s(k, j)) ++j;
    if (j < pairs.size() && miss_s(k, j) <= tolerance_s) errors.push_back(relative_error(pairs, k, j));
  }
  return errors;
}

std::vector<RelativeError> relative_over_distance(const std::vector<PosePair>& pairs, double length_m) {
  std::vector<RelativeError> errors;
  for (std::size_t k = 0, j = 0; k < pairs.size(); ++k) {
    while (j < pairs.size() && pairs[j].distance_m < pairs[k].distance_m + length_m) ++j;
    if (j < pairs.size()) errors.push_back(relative_error(pairs, k, j));
  }
  return errors;
}

void add_trajectory_rows(const std::vector<PosePair>& pairs, const TrajectoryOptions& options, RowSet& rows) {
  if (pairs.empty()) return;
  for (const Alignment a : {Alignment::first_pose, Alignment::yaw_pos, Alignment::se3, Alignment::sim3})
    add_ate(pairs, a, options, rows);
  if (options.common_frame)
    add_ate(pairs, Alignment::none, options, rows);
  else
    rows.missing("ate_none_rmse_m", "the method is given no initial pose");

  const Similarity first{1, first_pose_alignment(pairs)};
  rows.put("ate_first_pose_rot_rmse_deg", rms(rotation_errors_rad(pairs, first)) * kDegPerRad);
  add_rpe("1sweep", relative_over_sweeps(pairs, 1), "no two neighbouring sweeps are scored", rows);
  add_rpe("10sweep", relative_over_sweeps(pairs, 10), "no two scored sweeps are ten apart", rows);
  add_rpe("1s", relative_over_time(pairs, Duration(1'000'000'000)), "no two scored sweeps are a second apart", rows);
  add_rpe("10m", relative_over_distance(pairs, 10), "no two scored sweeps are ten metres apart", rows);
  add_end_error(pairs, position_errors_m({pairs.back()}, first).front(), rows);
}

void add_trajectory_series(const std::vector<PosePair>& pairs, Time t_zero, std::vector<Series>& series) {
  Series by_time{"error_vs_time", "time [s]", "position error [m]", {}, {}, {}, {}};
  Series by_distance{"error_vs_distance", "distance travelled [m]", "position error [m]", {}, {}, {}, {}};
  if (!pairs.empty()) by_time.y = by_distance.y = position_errors_m(pairs, {1, first_pose_alignment(pairs)});
  for (const PosePair& pair : pairs) {
    by_time.x.push_back(to_s(pair.t - t_zero));
    by_distance.x.push_back(pair.distance_m);
  }
  series.push_back(std::move(by_time));
  series.push_back(std::move(by_distance));
  series.push_back(drift_vs_distance(pairs));
}

}  // namespace tarmac::metrics
