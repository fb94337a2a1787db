/// Surfaces in closed form and a spinning sensor that moves between them, in double precision: what an oracle sees.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "metrics/degeneracy/oracle.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {

/// Where a ray from o along d first meets the surface, and the unit normal there.
using Surface = std::function<std::optional<SurfacePoint>(const Eigen::Vector3d& o, const Eigen::Vector3d& d)>;

inline std::optional<SurfacePoint> at_distance(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double t,
                                               const Eigen::Vector3d& n) {
  constexpr double kReach_m = 100;
  if (!(t > 0) || t > kReach_m) return std::nullopt;
  return SurfacePoint{o + t * d, n, 0};
}

/// n'x = offset.
inline Surface plane(const Eigen::Vector3d& n, double offset_m) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    return at_distance(o, d, (offset_m - n.dot(o)) / n.dot(d), n);
  };
}

inline Surface nearest_of(std::vector<Surface> surfaces) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    std::optional<SurfacePoint> best;
    for (const Surface& surface : surfaces) {
      const std::optional<SurfacePoint> hit = surface(o, d);
      if (hit && (!best || (hit->p_world - o).norm() < (best->p_world - o).norm())) best = hit;
    }
    return best;
  };
}

/// Floor, ceiling and two walls along x, without ends.
inline Surface corridor(double width_m = 5, double height_m = 3.5) {
  return nearest_of(
      {plane({0, 1, 0}, width_m / 2), plane({0, 1, 0}, -width_m / 2), plane({0, 0, 1}, 0), plane({0, 0, 1}, height_m)});
}

/// Seen from inside: the far root of |Q (o + t d - centre)| = radius, Q the projection that the radius is measured in.
inline Surface round_from_inside(const Eigen::Vector3d& centre, double radius_m, const Eigen::Matrix3d& Q) {
  return [=](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const Eigen::Vector3d u = Q * (o - centre), v = Q * d;
    const double a = v.squaredNorm(), b = u.dot(v), c = u.squaredNorm() - radius_m * radius_m;
    const double t = (-b + std::sqrt(b * b - a * c)) / a;
    return at_distance(o, d, t, (Q * (o + t * d - centre)).normalized());
  };
}

/// Circular, along x.
inline Surface tunnel(double radius_m = 4) {
  return round_from_inside({0, 0.7, 1.2}, radius_m, Eigen::Vector3d(0, 1, 1).asDiagonal());
}

inline Surface sphere(double radius_m = 15) {
  return round_from_inside({1, -2, 3}, radius_m, Eigen::Matrix3d::Identity());
}

/// Walls, floor and ceiling: nothing is free.
inline Surface room(double length_m, double width_m, double height_m) {
  return nearest_of({plane({1, 0, 0}, length_m / 2), plane({1, 0, 0}, -length_m / 2), corridor(width_m, height_m)});
}

struct Sweep {
  std::vector<SurfacePoint> points;
  core::SE3 T_world_c;
  double mean_range_m = 0;
  std::optional<BlockAnalysis> analyse() const {
    return metrics::analyse(exact_information(points, T_world_c), mean_range_m);
  }
};

inline constexpr core::Duration kSpan{100'000'000};  ///< of a sweep

/// 32 rings over +-22.5 degrees, 512 columns from `begin` on.
inline Sweep sweep_of(const Surface& surface, const core::SmoothTrajectory& motion, core::Time begin,
                      int columns = 512) {
  constexpr int kRings = 32;
  Sweep sweep;
  sweep.T_world_c = motion.pose(begin + kSpan / 2);
  for (int c = 0; c < columns; ++c) {
    const double phase = c / (columns - 1.0), azimuth = -2 * M_PI * c / columns;
    const core::SE3 T = motion.pose(begin + core::duration_from_s(phase * core::to_s(kSpan)));
    for (int r = 0; r < kRings; ++r) {
      const double elevation = (-22.5 + 45 * (r + 0.5) / kRings) * M_PI / 180;
      const Eigen::Vector3d d =
          T.linear() * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                       std::sin(elevation));
      std::optional<SurfacePoint> hit = surface(T.translation(), d);
      if (!hit) continue;
      hit->phase = phase;
      sweep.mean_range_m += (hit->p_world - T.translation()).norm();
      sweep.points.push_back(*hit);
    }
  }
  sweep.mean_range_m /= static_cast<double>(sweep.points.size());
  return sweep;
}

inline Sweep sweep_of(const Surface& surface, const core::SmoothTrajectory& motion) {
  return sweep_of(surface, motion, motion.begin());
}

/// What a point-to-plane method records of the sweep: float rows by the pose at the point's own time.
inline core::SweepDiagnostics recorded(const Sweep& sweep, const core::SmoothTrajectory& motion, core::Time begin,
                                       const core::SE3& T_map_world) {
  core::SweepDiagnostics record;
  record.rows_are_surface = true;
  for (const SurfacePoint& point : sweep.points) {
    const core::Duration t = core::duration_from_s(core::to_s(kSpan) * point.phase);
    const core::SE3 T_map_body = T_map_world * motion.pose(begin + t);
    const Eigen::Vector3d p = T_map_body.inverse() * (T_map_world * point.p_world);
    const Eigen::Vector3d n = T_map_body.linear().transpose() * (T_map_world.linear() * point.n_world);
    const Eigen::Vector3d moment = p.cross(n);
    core::ResidualRow row;
    row.t_ns = static_cast<std::int32_t>(t.count());
    row.weight = 25;
    for (int k = 0; k < 3; ++k) {
      row.jacobian[k] = static_cast<float>(n[k]);
      row.jacobian[3 + k] = static_cast<float>(moment[k]);
    }
    record.rows.push_back(row);
  }
  record.residuals = static_cast<std::int32_t>(record.rows.size());
  return record;
}

/// What a point-to-point method records: three rows a point, along the map's axes.
inline void add_axis_rows(const Sweep& sweep, const core::SmoothTrajectory& motion, core::Time begin,
                          core::SweepDiagnostics& record) {
  for (const SurfacePoint& point : sweep.points) {
    const core::Duration t = core::duration_from_s(core::to_s(kSpan) * point.phase);
    const core::SE3 T = motion.pose(begin + t);
    Eigen::Matrix<double, 3, 6> J;
    J << T.linear(), -T.linear() * core::so3::hat(T.inverse() * point.p_world);
    for (int axis = 0; axis < 3; ++axis) {
      core::ResidualRow row;
      row.t_ns = static_cast<std::int32_t>(t.count());
      row.weight = 1;
      for (int k = 0; k < 6; ++k) row.jacobian[k] = static_cast<float>(J(axis, k));
      record.rows.push_back(row);
    }
  }
  record.residuals = static_cast<std::int32_t>(record.rows.size());
}

/// 8 m/s and 70 degrees a second, bumpy: no perturbation that is linear in time leaves such a sweep's shape.
class Bumpy final : public core::SmoothTrajectory {
 public:
  explicit Bumpy(const core::SE3& T0) : T0_(T0) {}
  core::Time begin() const override { return core::Time{}; }
  core::Time end() const override { return core::time_from_s(1); }
  core::Kinematics at(core::Time time) const override {
    const double t = core::to_s(time);
    core::Kinematics k;
    k.T_world_body =
        T0_ * tests::pose({8 * t + 0.05 * std::sin(60 * t), 0.04 * std::sin(45 * t), 0.03 * std::cos(80 * t)},
                          {0.02 * std::sin(50 * t), 0.03 * std::cos(40 * t), 1.2 * t});
    return k;
  }

 private:
  core::SE3 T0_;
};

}  // namespace tarmac::metrics::tests
