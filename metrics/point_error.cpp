#include "metrics/point_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "metrics/align.h"
#include "metrics/firing_poses.h"
#include "metrics/pose_pairs.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kFamilyNames{"point", "deskew", "reference"};
constexpr std::array kFamilyLabels{"error after first-pose alignment [m]", "error after the sweep's best fit [m]",
                                   "error seen from the reference instant [m]"};

/// One sweep at work. Poses are taken as seen from the true reference pose, in the body's frame there: small numbers
/// even where the world's origin is far, and one 3x4 matrix a firing that takes a point of the sensor straight to its
/// error.
class SweepScoring {
 public:
  SweepScoring(const PointScorer& scorer, const LidarSweep& sweep, const sim::truth::PointLabels& labels,
               Time reference, const SE3& T_map_body_reference)
      : s_(scorer),
        sweep_(sweep),
        labels_(labels),
        firings_(firings_of(labels, scorer.estimate, scorer.truth, sweep.point_sensor)) {
    const SE3 T_reference_world = scorer.truth.pose(reference).inverse();
    const SE3 T_reference_map = T_map_body_reference.inverse();
    A_first_ = (T_reference_world * scorer.A_first * T_map_body_reference).matrix().topRows<3>();
    A_se3_ = (T_reference_world * scorer.A_se3 * T_map_body_reference).matrix().topRows<3>();
    seen_.resize(firings_.size());
    for (std::size_t f = 0; f < firings_.size(); ++f) {
      if (!firings_[f].covered) continue;
      seen_[f].estimate = (T_reference_map * (firings_[f].T_map_body * scorer.T_body_lidar_nominal)).matrix();
      seen_[f].truth =
          (T_reference_world * (firings_[f].T_world_body * scorer.true_mounting(firings_[f].sensor))).matrix();
    }
  }

  void score(SweepErrors& out, PointHistograms& histograms) const {
    const Matrix34 A_deskew = fit_sweep().matrix().topRows<3>();
    for (std::size_t f = 0; f < firings_.size(); ++f) {
      if (firings_[f].covered) {
        score_firing(firings_[f], seen_[f], A_deskew, out, histograms);
      } else {
        for (std::size_t i = firings_[f].first; i < firings_[f].last; ++i) out.points += is_finite(i);
      }
    }
    score_shear(out);
  }

  /// Jittered strata: even over the sweep without following the pattern of rings.
  MapSample sample(std::size_t wanted) const {
    MapSample map;
    const std::size_t n = sweep_.size();
    const RandomStream stream(static_cast<std::uint64_t>(sweep_.index), "metrics/map_sample");
    std::size_t f = 0;
    for (std::size_t k = 0; k < std::min(wanted, n); ++k) {
      const double u = wanted < n ? stream.uniform(k) : 0.5;
      const auto i = static_cast<std::size_t>((static_cast<double>(k) + u) * static_cast<double>(n) /
                                              static_cast<double>(std::min(wanted, n)));
      while (firings_[f].last <= i) ++f;
      if (!firings_[f].covered || !is_finite(i) || !stands(i)) continue;
      const Eigen::Vector3d x = s_.A_first * (firings_[f].T_map_body * (s_.T_body_lidar_nominal * sweep_.point(i)));
      const Eigen::Vector3d y = firings_[f].T_world_body * (s_.true_mounting(firings_[f].sensor) * sweep_.point(i));
      map.p_world_m.push_back(x.cast<float>());
      map.error_m.push_back(static_cast<float>((x - y).norm()));
      map.moving.push_back(labels_.moving[i]);
    }
    return map;
  }

 private:
  bool is_finite(std::size_t i) const {
    return std::isfinite(sweep_.x_m[i]) && std::isfinite(sweep_.y_m[i]) && std::isfinite(sweep_.z_m[i]);
  }

  /// Something of the world is there: no ghost, no part of the own vehicle, no noise.
  bool stands(std::size_t i) const { return sim::truth::on_a_surface(labels_.kind_of(i)); }

  /// The poses of the LiDAR at one firing.
  struct Seen {
    Eigen::Matrix4d estimate, truth;
  };

  /// The rigid motion, in the reference body's frame, that carries the estimate's static points onto the true ones
  /// best.
  SE3 fit_sweep() const {
    Eigen::Matrix4d cross = Eigen::Matrix4d::Zero();  // sum of (y, 1) (x, 1)^T
    for (std::size_t f = 0; f < firings_.size(); ++f) {
      const Firing& firing = firings_[f];
      if (!firing.covered) continue;
      Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();  // sum of (p, 1) (p, 1)^T
      for (std::size_t i = firing.first; i < firing.last; ++i) {
        if (labels_.moving[i] || !is_finite(i) || !stands(i)) continue;
        const Eigen::Vector4d p = sweep_.point(i).homogeneous();
        moments.noalias() += p * p.transpose();
      }
      cross += seen_[f].truth * moments * seen_[f].estimate.transpose();
    }
    const double n = cross(3, 3);
    if (n == 0) return SE3::Identity();
    const Eigen::Vector3d y_mean = cross.topRightCorner<3, 1>() / n;
    const Eigen::Vector3d x_mean = cross.bottomLeftCorner<1, 3>().transpose() / n;
    SE3 A = SE3::Identity();
    A.linear() = fit_rotation(cross.topLeftCorner<3, 3>() - n * y_mean * x_mean.transpose(), n,
                              Eigen::Matrix3d::Identity(), nullptr);
    A.translation() = y_mean - A.linear() * x_mean;
    return A;
  }

  void score_firing(const Firing& firing, const Seen& seen, const Matrix34& A_deskew, SweepErrors& out,
                    PointHistograms& h) const {
    const Matrix34 truth = seen.truth.topRows<3>();
    const std::array<Matrix34, kPointFamilies> to_error{
        A_first_ * seen.estimate - truth, A_deskew * seen.estimate - truth, seen.estimate.topRows<3>() - truth};
    const Matrix34 to_error_se3 = A_se3_ * seen.estimate - truth;
    const std::size_t bin = phase_bin(firing.t);
    std::array<SquaredSum, kPointFamilies> sums;

    for (std::size_t i = firing.first; i < firing.last; ++i) {
      if (!is_finite(i)) continue;
      ++out.points;
      ++out.placed;
      if (!stands(i)) continue;
      const Eigen::Vector4d p = sweep_.point(i).homogeneous();
      if (labels_.moving[i]) {
        out.moving.add((to_error[0] * p).squaredNorm());
        continue;
      }
      for (std::size_t f = 0; f < kPointFamilies; ++f) {
        const double e_squared = (to_error[f] * p).squaredNorm();
        sums[f].add(e_squared);
        h.by_phase[f][bin].add(e_squared);
        if (f != 0) continue;
        h.point.add(e_squared);
        out.largest_squared = std::max(out.largest_squared, e_squared);
      }
      out.se3.add((to_error_se3 * p).squaredNorm());
    }
    for (std::size_t f = 0; f < kPointFamilies; ++f) {
      out.of[f].add(sums[f]);
      out.by_phase[f][bin].add(sums[f]);
    }
  }

  std::size_t phase_bin(Time t) const {
    const int bin = static_cast<int>(ratio(t, labels_.begin, labels_.end) * s_.phase_bins);
    return static_cast<std::size_t>(std::clamp(bin, 0, s_.phase_bins - 1));
  }

  /// E = (T(begin)^-1 T(end))^-1 (T^(begin)^-1 T^(end)), by the motion inside the sweep: at its end from before.
  void score_shear(SweepErrors& out) const {
    if (labels_.begin == labels_.end) return;
    const Segment* at_begin = s_.estimate.find(labels_.begin);
    const std::optional<SE3> T_map_end = pose_from_before(s_.estimate, labels_.end);
    if (!at_begin || !T_map_end || !s_.truth.covers(labels_.begin) || !s_.truth.covers(labels_.end)) return;
    const SE3 true_motion = s_.truth.pose(labels_.begin).inverse() * s_.truth.pose(labels_.end);
    const SE3 E = true_motion.inverse() * (at_begin->pose(labels_.begin).inverse() * *T_map_end);
    out.shear_m = E.translation().norm();
    out.shear_rad = so3::angle_rad(E.linear());
  }

  const PointScorer& s_;
  const LidarSweep& sweep_;
  const sim::truth::PointLabels& labels_;
  std::vector<Firing> firings_;
  std::vector<Seen> seen_;  ///< one a firing; unset where it is not covered
  Matrix34 A_first_, A_se3_;
};

template <class Get>
void put_rms(const std::string& metric, const std::vector<SweepErrors>& sweeps, const Get& get,
             const std::string& reason, RowSet& rows) {
  SquaredSum total;
  for (const SweepErrors& sweep : sweeps) total.add(get(sweep));
  total.n ? rows.put(metric, total.rms()) : rows.missing(metric, reason);
}

Series phase_series(std::size_t family, const std::vector<SweepErrors>& sweeps, const PointHistograms& histograms) {
  const std::size_t bins = histograms.by_phase[family].size();
  Series s{fmt::format("{}_error_by_phase", kFamilyNames[family]),
           "phase in the sweep (0 = first firing, 1 = last)",
           kFamilyLabels[family],
           {},
           {},
           {},
           {}};
  for (std::size_t b = 0; b < bins; ++b) {
    SquaredSum total;
    for (const SweepErrors& sweep : sweeps)
      if (sweep.scored) total.add(sweep.by_phase[family][b]);
    s.x.push_back((static_cast<double>(b) + 0.5) / static_cast<double>(bins));
    s.y.push_back(total.rms());
    s.low.push_back(histograms.by_phase[family][b].quantile(0.05));
    s.high.push_back(histograms.by_phase[family][b].quantile(0.95));
  }
  return s;
}

}  // namespace

double SquaredSum::rms() const {
  return n ? std::sqrt(sum / static_cast<double>(n)) : kNaN;
}

PointHistograms::PointHistograms(int phase_bins) {
  for (auto& family : by_phase) family.resize(static_cast<std::size_t>(phase_bins));
}

void PointHistograms::add(const PointHistograms& other) {
  point.add(other.point);
  for (std::size_t f = 0; f < kPointFamilies; ++f)
    for (std::size_t b = 0; b < by_phase[f].size(); ++b) by_phase[f][b].add(other.by_phase[f][b]);
}

SweepErrors score_sweep(const PointScorer& scorer, const LidarSweep& sweep, const sim::truth::PointLabels& labels,
                        Time reference, const SE3& T_map_body_reference, std::size_t map_points,
                        PointHistograms& histograms) {
  if (labels.t_ns.size() != sweep.size() || labels.moving.size() != sweep.size())
    throw InputError(fmt::format(
        "sweep {} has {} points and its truth {} labels: the truth belongs to another recording; evaluate each "
        "recording with the truth that was written beside it",
        sweep.index, sweep.size(), labels.t_ns.size()));
  SweepErrors out;
  out.scored = true;
  out.t = labels.end;
  for (auto& family : out.by_phase) family.resize(static_cast<std::size_t>(scorer.phase_bins));
  const SweepScoring scoring(scorer, sweep, labels, reference, T_map_body_reference);
  scoring.score(out, histograms);
  out.map = scoring.sample(map_points);
  return out;
}

void add_point_rows(const std::vector<SweepErrors>& sweeps, const PointHistograms& histograms, RowSet& rows) {
  constexpr auto kPoint = static_cast<std::size_t>(PointFamily::point);
  constexpr auto kDeskew = static_cast<std::size_t>(PointFamily::deskew);
  const std::string none = "no static point of a scored sweep is covered by the estimate";
  put_rms(
      "point_error_rms_m", sweeps, [](const SweepErrors& s) { return s.of[kPoint]; }, none, rows);
  put_rms(
      "point_error_se3_rms_m", sweeps, [](const SweepErrors& s) { return s.se3; }, none, rows);
  put_rms(
      "deskew_error_rms_m", sweeps, [](const SweepErrors& s) { return s.of[kDeskew]; }, none, rows);
  put_rms(
      "point_error_moving_rms_m", sweeps, [](const SweepErrors& s) { return s.moving; },
      "no point lies on a moving object", rows);

  double largest_squared = 0;
  std::uint64_t points = 0, placed = 0;
  std::vector<double> shear_m, shear_deg;
  for (const SweepErrors& sweep : sweeps) {
    largest_squared = std::max(largest_squared, sweep.largest_squared);
    points += sweep.points;
    placed += sweep.placed;
    if (sweep.shear_m) shear_m.push_back(*sweep.shear_m);
    if (sweep.shear_rad) shear_deg.push_back(*sweep.shear_rad * 180 / std::numbers::pi);
  }
  if (histograms.point.total()) {
    rows.put("point_error_p50_m", histograms.point.quantile(0.5));
    rows.put("point_error_p95_m", histograms.point.quantile(0.95));
    rows.put("point_error_max_m", std::sqrt(largest_squared));
  } else {
    for (const char* metric : {"point_error_p50_m", "point_error_p95_m", "point_error_max_m"})
      rows.missing(metric, none);
  }
  if (points) rows.put("point_coverage_percent", 100 * static_cast<double>(placed) / static_cast<double>(points));
  const std::string no_shear = "the estimate covers no scored sweep from begin to end";
  shear_m.empty() ? rows.missing("sweep_shear_rms_m", no_shear) : rows.put("sweep_shear_rms_m", rms(shear_m));
  shear_deg.empty() ? rows.missing("sweep_shear_rot_rms_deg", no_shear)
                    : rows.put("sweep_shear_rot_rms_deg", rms(shear_deg));
}

void add_point_series(const std::vector<SweepErrors>& sweeps, const PointHistograms& histograms, Time t_zero,
                      std::vector<Series>& series) {
  for (std::size_t f = 0; f < kPointFamilies; ++f) series.push_back(phase_series(f, sweeps, histograms));
  Series deskew{"deskew_error_vs_time", "time [s]", "deskew error [m]", {}, {}, {}, {}};
  for (const SweepErrors& sweep : sweeps) {
    if (!sweep.scored) continue;
    deskew.x.push_back(to_s(sweep.t - t_zero));
    deskew.y.push_back(sweep.of[static_cast<std::size_t>(PointFamily::deskew)].rms());
  }
  series.push_back(std::move(deskew));
}

}  // namespace tarmac::metrics
