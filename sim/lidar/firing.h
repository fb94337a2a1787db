/// When each channel fires and where its beam points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "sim/lidar/column_times.h"
#include "sim/lidar/prism.h"
#include "sim/lidar/profile.h"
#include "sim/lidar/spin.h"

namespace tarmac::sim::lidar {

/// One firing cycle: a column of an encoder-driven sensor; of a clock-driven one a sequence, or all its states once; a
/// few pulses of a scanner with prisms, whose `azimuth` is always 0.
struct Cycle {
  core::Time t;                     ///< of its beginning
  double cos_azimuth, sin_azimuth;  ///< of the head at t, clockwise from sensor +x
  double cos_encoder, sin_encoder;  ///< of the head as its encoder has it: the same unless the encoder errs

  /// The cycle as a driver sees it, from which it computes points.
  Cycle reported() const { return {t, cos_encoder, sin_encoder, cos_encoder, sin_encoder}; }
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
///   prism:   t = n cycle_us, sweeps alike; directions of Prism at t + firing_us
/// and `start` later altogether where the sensor begins later than the recording.
/// Channel c fires at t + firing_us[c], in the direction azimuth + azimuth_offset_cw_deg[c] + 360 rate firing_us[c].
/// Times are rounded to a nanosecond.
///
/// A sensor whose channels fire at other times from cycle to cycle (Profile::states), or whose beams differ from pulse
/// to pulse, has several `blocks` in a cycle here: a cycle then takes that many cycle_us, and holds each channel as
/// often as it fires in that time. What is called a channel of this table is one of those firings; channel_of() tells
/// whose.
///
/// A head that turns unevenly (`jitter`) passes the fixed angles of an encoder-driven sensor at other times,
/// t + lead(t), and has other angles at the fixed times of a clock-driven one, 360 rate (t + lead(t)); inside a cycle
/// it turns at its nominal rate. An encoder that errs tells another angle than the head has: an encoder-driven sensor
/// fires where the error leaves it, a clock-driven one reports the angle with the error. `replay`: sweep k's columns
/// fire at recorded times, at their nominal angles.
class FiringTable {
 public:
  FiringTable(const Profile& profile, const Mode& mode);
  /// Throws InputError when the sensor cannot do what is asked for: column times with clock timing, times that
  /// check_column_times refuses, jitter that would let cycles overlap.
  FiringTable(const Profile& profile, const Mode& mode, const SpinJitter& jitter,
              std::vector<ReplayedSweep> replay = {}, core::Duration start = {});

  const Mode& mode() const { return mode_; }
  std::size_t channels() const { return offset_ns_.size(); }  ///< firings in a cycle, in their order
  std::size_t blocks() const { return blocks_; }
  std::size_t block_of(std::size_t channel) const { return block_[channel]; }      ///< of the cycle
  std::size_t channel_of(std::size_t channel) const { return channel_[channel]; }  ///< of the profile
  std::span<const std::uint32_t> profile_channels() const { return channel_; }
  std::uint16_t ring(std::size_t channel) const { return ring_[channel]; }
  SweepSpan sweep(std::int64_t index) const;
  Cycle cycle(const SweepSpan& sweep, std::int64_t k) const;  ///< the k-th of the sweep
  /// How many sweeps end no later than `end`; no more than there are recorded times for.
  std::int64_t sweeps_until(core::Time end) const;

  std::int32_t offset_ns(std::size_t channel) const { return offset_ns_[channel]; }
  double step_rad() const { return step_rad_; }  ///< of the head, from one cycle to the next
  bool staggered() const { return staggered_; }  ///< channels fire at different instants
  /// Unit vector of the beam in the sensor frame.
  Eigen::Vector3d direction(const Cycle& cycle, std::size_t channel) const {
    if (prism_)
      return prism_->direction(
          static_cast<double>((cycle.t - start_).time_since_epoch().count() + offset_ns_[channel]));
    const Beam& b = beams_[channel];
    return turned(cycle, b.forward, b.right, b.up);
  }
  /// A channel's beam is another in every cycle; otherwise direction() is that of one cycle, turned by the azimuth.
  bool beams_change() const { return prism_.has_value(); }
  /// Where the beams of a cycle start, sensor frame [m].
  Eigen::Vector3d origin(const Cycle& cycle) const {
    return {radius_m_ * cycle.cos_azimuth, -radius_m_ * cycle.sin_azimuth, height_m_};
  }
  /// Beams of a cycle start at different points: at origin() + origin_offset().
  bool channel_origins() const { return channel_origins_; }
  Eigen::Vector3d origin_offset(const Cycle& cycle, std::size_t channel) const {
    const Beam& b = beams_[channel];
    return turned(cycle, b.origin_forward_m, b.origin_right_m, b.origin_up_m);
  }
  /// What a sensor's raw range counts beyond the way from the beam's origin [m].
  double range_offset_m() const { return range_offset_m_; }

  /// Tiles of 16 firings that look the same way, for `cycles` consecutive cycles in firing order (index = cycle *
  /// channels + channel); tiles that the cycles do not fill up hold raycast::SweepTracer::no_ray.
  std::vector<std::uint32_t> tiles(std::size_t cycles) const;

 private:
  struct Beam {
    double forward, right, up;  // at azimuth 0
    double origin_forward_m, origin_right_m, origin_up_m;
  };
  // Clockwise azimuth a of the head seen as x forward, y left.
  static Eigen::Vector3d turned(const Cycle& cycle, double forward, double right, double up) {
    return {forward * cycle.cos_azimuth - right * cycle.sin_azimuth,
            -(forward * cycle.sin_azimuth + right * cycle.cos_azimuth), up};
  }
  void add_firing(const Profile& profile, std::size_t channel, std::size_t block, double offset_ns);
  std::int64_t first_cycle_of(std::int64_t sweep) const;
  std::int64_t column_of(std::int64_t k) const;
  core::Time cycle_time(const SweepSpan& sweep, std::int64_t k) const;
  double turns_at_cycle(std::int64_t cycle) const;
  std::vector<std::vector<std::size_t>> channel_groups() const;

  Mode mode_;
  bool by_encoder_;
  core::Duration start_{0};
  std::size_t blocks_;
  double cycle_ns_;  // real-valued for encoder timing
  double cycles_per_turn_;
  double start_rad_, step_rad_;
  double radius_m_, height_m_, range_offset_m_;
  bool staggered_, channel_origins_;
  std::int64_t window_first_,
      window_cycles_;            // encoder timing: columns that are fired, through the last into the first
  std::int64_t window_wrapped_;  // how many of them lie at the sweep's begin when the window wraps
  std::vector<Beam> beams_;
  std::vector<std::int32_t> offset_ns_;
  std::vector<std::uint32_t> channel_, block_;
  std::vector<std::uint16_t> ring_;
  std::optional<Prism> prism_;
  std::vector<double> elevation_rad_, azimuth_rad_;  // azimuth offset, spin inside the cycle included
  std::optional<SpinJitter> jitter_;
  std::shared_ptr<const std::vector<ReplayedSweep>> replay_;  // shared by copies: it may be long
};

}  // namespace tarmac::sim::lidar
