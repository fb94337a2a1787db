/// A world of fixed points, seen without noise unless asked for: whoever sees it twice sees the same points, so that
/// what a method gets wrong is the method's.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/lie.h"
#include "core/measurements.h"
#include "core/random.h"

namespace tarmac::tests {

using Motion = std::function<core::SE3(double t_s)>;  ///< T_world_lidar

/// One landmark a grid cell, within `radius_m` of the origin, jittered about the cell's centre. In random order, so
/// that firing order has nothing to do with place.
inline std::vector<Eigen::Vector3d> landmarks(double radius_m, double spacing_m, double jitter_m,
                                              std::uint64_t seed = 1) {
  const core::RandomStream random(seed, "test/landmarks");
  std::vector<std::pair<double, Eigen::Vector3d>> ordered;
  const int n = static_cast<int>(radius_m / spacing_m);
  std::uint64_t draw = 0;
  for (int x = -n; x < n; ++x) {
    for (int y = -n; y < n; ++y) {
      for (int z = -n; z < n; ++z, ++draw) {
        Eigen::Vector3d p = (Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5)) * spacing_m;
        for (unsigned k = 0; k < 3; ++k) p[k] += jitter_m * (2 * random.uniform(draw, k) - 1);
        if (p.norm() < radius_m && p.norm() > 2) ordered.emplace_back(random.uniform(draw, 3), p);
      }
    }
  }
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3d> points;
  for (const auto& [order, p] : ordered) points.push_back(p);
  return points;
}

/// The walls of a room, 16 x 13 x 6 m about the origin, as fixed points some 0.3 m apart: surfaces for methods that
/// need them, and points to be met again for those that do not. In random order.
inline std::vector<Eigen::Vector3d> wall_points(std::uint64_t seed = 1) {
  const core::RandomStream random(seed, "test/walls");
  const Eigen::Vector3d half(8, 6.5, 3);
  constexpr double kSpacing_m = 0.3;
  std::vector<std::pair<double, Eigen::Vector3d>> ordered;
  std::uint64_t draw = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (double a = -half[u] + 0.2; a < half[u]; a += kSpacing_m) {
        for (double b = -half[v] + 0.2; b < half[v]; b += kSpacing_m, ++draw) {
          Eigen::Vector3d p;
          p[axis] = side * half[axis];
          p[u] = a + 0.1 * random.uniform(draw, 0);
          p[v] = b + 0.1 * random.uniform(draw, 1);
          ordered.emplace_back(random.uniform(draw, 3), p);
        }
      }
    }
  }
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::Vector3d> points;
  for (const auto& [order, p] : ordered) points.push_back(p);
  return points;
}

struct SweepSetup {
  double period_s = 0.1;
  bool flash = false;  ///< every point at the sweep's end: no distortion
  double noise_m = 0;
  std::uint64_t seed = 1;
};

/// Sweep k covers [k, k + 1] periods: its first point fires at the begin, its last at the end.
inline core::LidarSweep sweep_at(std::int64_t k, const std::vector<Eigen::Vector3d>& world, const Motion& T_world_lidar,
                                 const SweepSetup& setup = {}) {
  const core::RandomStream random(setup.seed, "test/sweep_noise");
  const core::Duration period = core::duration_from_s(setup.period_s);
  core::LidarSweep sweep;
  sweep.index = k;
  sweep.begin = core::time_from_ns(k * period.count());
  sweep.end = sweep.begin + period;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const std::int64_t last = static_cast<std::int64_t>(world.size()) - 1;
    const std::int64_t t_ns = setup.flash ? period.count() : period.count() * static_cast<std::int64_t>(i) / last;
    Eigen::Vector3d p = T_world_lidar(core::to_s(sweep.begin + core::Duration(t_ns))).inverse() * world[i];
    const std::uint64_t draw = static_cast<std::uint64_t>(k) * world.size() + i;
    for (unsigned axis = 0; axis < 3 && setup.noise_m > 0; ++axis) p[axis] += setup.noise_m * random.normal(draw, axis);
    sweep.push_back(p.cast<float>(), static_cast<std::int32_t>(t_ns), static_cast<std::uint16_t>(i % 64), 1.0F);
  }
  return sweep;
}

/// A sweep without points, right after another one.
inline core::LidarSweep empty_sweep(std::int64_t index, core::Time begin, core::Time end) {
  core::LidarSweep sweep;
  sweep.index = index;
  sweep.begin = begin;
  sweep.end = end;
  return sweep;
}

inline Motion still() {
  return [](double) { return core::SE3::Identity(); };
}
/// Constant twist (velocity and rate in the moving frame), at the identity at t = 0.
inline Motion constant_twist(const core::Vector6& twist_per_s) {
  return [twist_per_s](double t_s) { return core::se3::exp(t_s * twist_per_s); };
}

/// A pose that has nothing special.
inline core::SE3 some_pose(double angle_rad = 0.7, double distance_m = 1.5) {
  core::Vector6 xi;
  xi << distance_m * Eigen::Vector3d(0.6, -0.48, 0.64), angle_rad * Eigen::Vector3d(0.48, 0.6, -0.64);
  return core::se3::exp(xi);
}

}  // namespace tarmac::tests
