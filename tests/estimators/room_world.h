/// A furnished room seen along beams: every sweep hits other places of the same surfaces.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/trajectory.h"
#include "tests/estimators/landmark_world.h"

namespace tarmac::tests {

/// An axis-aligned box. The room is one seen from inside, its furniture are others seen from outside.
struct Box {
  Eigen::Vector3d low, high;
};

class Room {
 public:
  /// 24 x 18 x 7 m around the origin with three blocks in it.
  Room()
      : walls_{{-11, -8, -2}, {13, 10, 5}},
        blocks_{{{5, -4, -2}, {7, -1, 1.5}}, {{-6, 3, -2}, {-4, 7, 2.5}}, {{-3, -7, -2}, {1, -6, 0.5}}} {}
  Room(const Box& walls, std::vector<Box> blocks) : walls_(walls), blocks_(std::move(blocks)) {}

  /// Distance along a unit direction to the first surface; infinite where there is none.
  double range(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    double nearest = crossing(walls_, from, direction).second;
    for (const Box& block : blocks_) {
      const auto [in, out] = crossing(block, from, direction);
      if (in > 0 && in < out) nearest = std::min(nearest, in);
    }
    return nearest;
  }

 private:
  /// Where a line enters and leaves a box.
  static std::pair<double, double> crossing(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& u) {
    double in = -std::numeric_limits<double>::infinity(), out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double a = (box.low[k] - from[k]) / u[k], b = (box.high[k] - from[k]) / u[k];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return {in, out};
  }
  Box walls_;
  std::vector<Box> blocks_;
};

struct Spinner {
  int rings = 32, columns = 512;
  double elevation_deg = 22.5;  ///< rings spread from minus to plus this
  double noise_m = 0.01;        ///< along the beam
  double max_range_m = 100;
  std::uint64_t seed = 1;
};

/// Sweep k covers [k, k + 1] times 0.1 s; columns fire evenly in time, one turn a sweep.
inline core::LidarSweep sweep_of(const Room& room, std::int64_t k, const Motion& T_world_lidar,
                                 const Spinner& spinner = {}) {
  const core::RandomStream random(spinner.seed, "test/room_noise");
  constexpr double kDeg = std::numbers::pi / 180;
  constexpr std::int64_t kPeriod_ns = 100'000'000;
  core::LidarSweep sweep;
  sweep.index = k;
  sweep.begin = core::time_from_ns(k * kPeriod_ns);
  sweep.end = sweep.begin + core::Duration(kPeriod_ns);
  std::uint64_t draw = static_cast<std::uint64_t>(k) << 32;
  for (int column = 0; column < spinner.columns; ++column) {
    const std::int64_t t_ns = kPeriod_ns * column / (spinner.columns - 1);
    const core::SE3 T = T_world_lidar(core::to_s(sweep.begin + core::Duration(t_ns)));
    const double azimuth = -360 * kDeg * (column + 0.5) / spinner.columns;
    for (int ring = 0; ring < spinner.rings; ++ring, ++draw) {
      const double elevation = spinner.elevation_deg * kDeg * (2.0 * ring / (spinner.rings - 1) - 1);
      const Eigen::Vector3d u(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      const double range_m = room.range(T.translation(), T.linear() * u) + spinner.noise_m * random.normal(draw);
      if (range_m > spinner.max_range_m) continue;
      sweep.push_back((range_m * u).cast<float>(), static_cast<std::int32_t>(t_ns), static_cast<std::uint16_t>(ring),
                      1.0F);
    }
  }
  return sweep;
}

/// One pose at the begin of every sweep and one at its end; between them slerp and lerp, so that a two-pose trajectory
/// can be exact. begins[k] need not be ends[k - 1].
struct TwoPoseDrive {
  std::vector<core::SE3> begins, ends;

  core::SE3 at(double t_s) const {
    const auto last = static_cast<double>(begins.size() - 1);
    const double sweep = std::clamp(std::floor(t_s / 0.1 + 1e-9), 0.0, last);
    return within(static_cast<std::size_t>(sweep), std::clamp(t_s / 0.1 - sweep, 0.0, 1.0));
  }
  core::SE3 within(std::size_t k, double s) const {
    const core::Segment segment = core::Segment::two_pose(core::SegmentModel::two_pose_slerp, core::time_from_ns(0),
                                                          begins[k], core::time_from_ns(1'000'000'000), ends[k]);
    return segment.pose(core::time_from_ns(std::llround(s * 1e9)));
  }
  /// Of sweep k alone, as a function of the recording's time.
  Motion of_sweep(std::size_t k) const {
    return [this, k](double t_s) { return within(k, std::clamp(t_s / 0.1 - static_cast<double>(k), 0.0, 1.0)); };
  }
};

}  // namespace tarmac::tests
