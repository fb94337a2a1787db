#include "metrics/drift.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "metrics/statistics.h"
#include "metrics/trajectory_error.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr double kRowStretchM = 50;
constexpr std::size_t kKittiStep = 10;

/// One component of a SplitError, as tables and figures name it.
struct Component {
  const char* name;
  const char* unit;
  double (*value)(const SplitError&);
};
constexpr std::array<Component, 5> kComponents = {{
    {"along", "m", [](const SplitError& e) { return e.along_m; }},
    {"cross", "m", [](const SplitError& e) { return e.cross_m; }},
    {"height", "m", [](const SplitError& e) { return e.height_m; }},
    {"yaw", "deg", [](const SplitError& e) { return e.yaw_rad * kDegPerRad; }},
    {"tilt", "deg", [](const SplitError& e) { return e.tilt_rad * kDegPerRad; }},
}};
constexpr const char* kLabels[] = {"along-track error [m]", "cross-track error [m]", "height error [m]",
                                   "yaw error [deg]", "roll and pitch error [deg]"};

/// Error vectors along the world's axes to the level axes of the true heading.
SplitError split(const Eigen::Vector3d& e_world_m, const Eigen::Vector3d& turn_world_rad, const SE3& T_world_body) {
  const Eigen::Vector3d x = T_world_body.linear().col(0);
  const double norm = std::hypot(x.x(), x.y());
  // Pointing straight up there is no heading; any will do.
  const double c = norm > 0 ? x.x() / norm : 1, s = norm > 0 ? x.y() / norm : 0;
  return {c * e_world_m.x() + s * e_world_m.y(), -s * e_world_m.x() + c * e_world_m.y(), e_world_m.z(),
          turn_world_rad.z(), std::hypot(turn_world_rad.x(), turn_world_rad.y())};
}

std::vector<double> magnitudes(const std::vector<SplitError>& errors, const Component& component) {
  std::vector<double> values;
  for (const SplitError& e : errors) values.push_back(std::abs(component.value(e)));
  return values;
}

std::vector<SplitError> splits(const std::vector<PosePair>& pairs, const std::vector<RelativeError>& stretches) {
  std::vector<SplitError> errors;
  for (const RelativeError& e : stretches) errors.push_back(split_of_motion(pairs, e.from, e.to));
  return errors;
}

/// Drift over stretches that `of_length` finds, until there are none.
void add_drift(const std::vector<PosePair>& pairs, const char* over, const char* x_label,
               const std::function<std::vector<RelativeError>(double)>& of_length, std::vector<Series>& series) {
  std::array<Series, kComponents.size()> drift;
  for (std::size_t c = 0; c < kComponents.size(); ++c)
    drift[c] = {fmt::format("drift_{}_vs_{}", kComponents[c].name, over), x_label, kLabels[c], {}, {}, {}, {}};
  const auto append = [&](double length) {
    const std::vector<SplitError> errors = splits(pairs, of_length(length));
    if (errors.empty()) return false;
    for (std::size_t c = 0; c < kComponents.size(); ++c) {
      const std::vector<double> values = magnitudes(errors, kComponents[c]);
      drift[c].x.push_back(length);
      drift[c].y.push_back(rms(values));
      drift[c].low.push_back(quantile(values, 0.05));
      drift[c].high.push_back(quantile(values, 0.95));
    }
    return true;
  };
  bool more = true;
  for (double decade = 1; more && decade < 1e7; decade *= 10)
    for (const double step : {1.0, 2.0, 3.0, 5.0, 7.0}) more = more && append(step * decade);
  for (Series& s : drift) series.push_back(std::move(s));
}

}  // namespace

std::size_t KittiSegments::segments() const {
  std::size_t n = 0;
  for (const std::size_t c : count) n += c;
  return n;
}

std::string KittiSegments::counts() const {
  std::string text;
  for (std::size_t k = 0; k < kLengths; ++k)
    if (count[k] > 0) text += fmt::format("{}{:.0f} m: {}", text.empty() ? "" : ", ", length_m(k), count[k]);
  return text;
}

KittiSegments kitti_segments(const std::vector<PosePair>& pairs) {
  KittiSegments result;
  std::vector<double> distance_m(pairs.size(), 0);
  for (std::size_t k = 1; k < pairs.size(); ++k)
    distance_m[k] =
        distance_m[k - 1] + (pairs[k].T_world_body.translation() - pairs[k - 1].T_world_body.translation()).norm();
  if (!pairs.empty()) result.path_m = distance_m.back();
  for (std::size_t first = 0; first < pairs.size(); first += kKittiStep) {
    std::size_t last = first;
    for (std::size_t k = 0; k < KittiSegments::kLengths; ++k) {
      const double length_m = KittiSegments::length_m(k);
      while (last < pairs.size() && !(distance_m[last] > distance_m[first] + length_m)) ++last;
      if (last == pairs.size()) break;
      const SE3 dT_true = pairs[first].T_world_body.inverse() * pairs[last].T_world_body;
      const SE3 dT_est = pairs[first].T_map_body.inverse() * pairs[last].T_map_body;
      const SE3 E = dT_est.inverse() * dT_true;
      result.trans_fraction += E.translation().norm() / length_m;
      result.rot_rad_per_m += so3::angle_rad(E.linear()) / length_m;
      ++result.count[k];
    }
  }
  if (const std::size_t n = result.segments(); n > 0) {
    result.trans_fraction /= static_cast<double>(n);
    result.rot_rad_per_m /= static_cast<double>(n);
  }
  return result;
}

SplitError split_of_motion(const std::vector<PosePair>& pairs, std::size_t from, std::size_t to) {
  const SE3 dT_true = pairs[from].T_world_body.inverse() * pairs[to].T_world_body;
  const SE3 dT_est = pairs[from].T_map_body.inverse() * pairs[to].T_map_body;
  const SE3 E = dT_true.inverse() * dT_est;
  const Eigen::Matrix3d R = pairs[to].T_world_body.linear();
  return split(R * E.translation(), R * so3::log(E.linear()), pairs[to].T_world_body);
}

SplitError split_of_pose(const PosePair& pair, const SE3& T_world_map) {
  const SE3 T = T_world_map * pair.T_map_body;
  return split(T.translation() - pair.T_world_body.translation(),
               so3::log(T.linear() * pair.T_world_body.linear().transpose()), pair.T_world_body);
}

void add_drift_rows(const std::vector<PosePair>& pairs, RowSet& rows) {
  const KittiSegments kitti = kitti_segments(pairs);
  if (kitti.path_m < KittiSegments::kShortestPathM || kitti.segments() == 0) {
    const std::string reason =
        fmt::format("the path is {:.0f} m, KITTI's segments need {:.0f}", kitti.path_m, KittiSegments::kShortestPathM);
    rows.missing("kitti_trans_percent", reason);
    rows.missing("kitti_rot_deg_per_100m", reason);
  } else {
    rows.put("kitti_trans_percent", 100 * kitti.trans_fraction, kitti.counts());
    rows.put("kitti_rot_deg_per_100m", 100 * kitti.rot_rad_per_m * kDegPerRad, kitti.counts());
  }
  const std::vector<SplitError> errors = splits(pairs, relative_over_distance(pairs, kRowStretchM));
  for (const Component& component : kComponents) {
    const std::string name = fmt::format("drift_50m_{}_rms_{}", component.name, component.unit);
    if (errors.empty())
      rows.missing(name, "no stretch of 50 m is scored");
    else
      rows.put(name, rms(magnitudes(errors, component)));
  }
}

void add_drift_series(const std::vector<PosePair>& pairs, Time t_zero, std::vector<Series>& series) {
  if (pairs.empty()) return;
  add_drift(
      pairs, "distance", "length of the stretch [m]",
      [&](double length_m) { return relative_over_distance(pairs, length_m); }, series);
  add_drift(
      pairs, "duration", "duration of the stretch [s]",
      [&](double s) { return relative_over_time(pairs, duration_from_s(s)); }, series);
  const SE3 A = first_pose_alignment(pairs);
  for (std::size_t c = 0; c < kComponents.size(); ++c) {
    Series s{fmt::format("error_{}_vs_time", kComponents[c].name), "time [s]", kLabels[c], {}, {}, {}, {}};
    for (const PosePair& pair : pairs) {
      s.x.push_back(to_s(pair.t - t_zero));
      s.y.push_back(kComponents[c].value(split_of_pose(pair, A)));
    }
    series.push_back(std::move(s));
  }
}

}  // namespace tarmac::metrics
