/// When each channel fires and where its beam points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/time.h"
#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// One firing cycle: a column of an encoder-driven sensor, a sequence of a clock-driven one.
struct Cycle {
  core::Time t;                     ///< of its beginning
  double cos_azimuth, sin_azimuth;  ///< of the head at t, clockwise from sensor +x
};

struct SweepSpan {
  std::int64_t index = 0;
  std::int64_t first_cycle = 0;  ///< counted from the recording's start
  std::int64_t cycles = 0;
  core::Time begin, end;  ///< of the first and the last firing
};

/// The firing table of one sensor in one mode. Cycle n of the recording:
///   encoder: t = n / (columns rate), azimuth = start + 360 (n mod columns) / columns
///   clock:   t = n cycle_us,         azimuth = start + 360 rate t; sweep k holds the cycles with k <= rate t < k + 1
/// Channel c fires at t + firing_us[c], in the direction azimuth + azimuth_offset_cw_deg[c] + (clock: 360 rate
/// firing_us[c]). Times are rounded to a nanosecond.
class FiringTable {
 public:
  FiringTable(const Profile& profile, const Mode& mode);

  const Mode& mode() const { return mode_; }
  std::size_t channels() const { return offset_ns_.size(); }
  SweepSpan sweep(std::int64_t index) const;
  core::Time cycle_time(std::int64_t cycle) const;
  Cycle cycle(const SweepSpan& sweep, std::int64_t k) const;  ///< the k-th of the sweep
  /// How many sweeps end no later than `end`.
  std::int64_t sweeps_until(core::Time end) const;

  std::int32_t offset_ns(std::size_t channel) const { return offset_ns_[channel]; }
  bool staggered() const { return staggered_; }  ///< channels fire at different instants
  /// Unit vector of the beam in the sensor frame.
  Eigen::Vector3d direction(const Cycle& cycle, std::size_t channel) const {
    const Beam& b = beams_[channel];
    // Clockwise azimuth a + b seen as x forward, y left: (cos(a + b), -sin(a + b)).
    return {b.forward * cycle.cos_azimuth - b.right * cycle.sin_azimuth,
            -(b.forward * cycle.sin_azimuth + b.right * cycle.cos_azimuth), b.up};
  }
  /// Where the beams of a cycle start, sensor frame [m].
  Eigen::Vector3d origin(const Cycle& cycle) const {
    return {radius_m_ * cycle.cos_azimuth, -radius_m_ * cycle.sin_azimuth, height_m_};
  }
  /// Length from the range datum to the beam's origin: a sensor's raw range counts it [m].
  double range_offset_m() const { return radius_m_; }

  /// Tiles of 16 firings that look the same way, for `cycles` consecutive cycles in firing order (index = cycle *
  /// channels + channel); tiles that the cycles do not fill up hold raycast::SweepTracer::no_ray.
  std::vector<std::uint32_t> tiles(std::size_t cycles) const;

 private:
  struct Beam {
    double forward, right, up;  // at azimuth 0
  };
  std::int64_t first_cycle_of(std::int64_t sweep) const;
  std::vector<std::vector<std::size_t>> channel_groups() const;

  Mode mode_;
  bool by_encoder_;
  double cycle_ns_;  // real-valued for encoder timing
  double cycles_per_turn_;
  double start_rad_, step_rad_;
  double radius_m_, height_m_;
  bool staggered_;
  std::vector<Beam> beams_;
  std::vector<std::int32_t> offset_ns_;
  std::vector<double> elevation_rad_, azimuth_rad_;  // azimuth offset, spin inside the cycle included
};

}  // namespace tarmac::sim::lidar
