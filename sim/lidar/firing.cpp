#include "sim/lidar/firing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double turn_rad = 2 * std::numbers::pi;
// Channels whose azimuth offsets differ by less than this look the same way.
constexpr double same_fan_rad = 1.0 * rad_per_deg;

// Pulses of a scanner with prisms in a cycle: the vehicle's motion is first order inside it.
constexpr std::size_t prism_pulses = 8;

double value_or_0(const std::vector<double>& values, std::size_t i) {
  return values.empty() ? 0 : values[i];
}

std::size_t blocks_of(const Profile& p) {
  return p.by_prism() ? prism_pulses : std::max<std::size_t>(1, p.states.size());
}

/// One firing in a cycle of all blocks.
struct Shot {
  std::size_t channel, block;
  double offset_ns;
};

std::vector<Shot> shots_of(const Profile& p) {
  std::vector<Shot> shots;
  for (std::size_t block = 0; block < blocks_of(p); ++block)
    for (std::size_t c = 0; c < p.channels(); ++c) {
      const double firing_us = p.states.empty() ? p.firing_us[c] : p.states[block].firing_us[c];
      if (firing_us == AzimuthState::silent) continue;
      shots.push_back({c, block, std::round((static_cast<double>(block) * p.cycle_us + firing_us) * 1e3)});
    }
  std::stable_sort(shots.begin(), shots.end(), [](const Shot& a, const Shot& b) { return a.offset_ns < b.offset_ns; });
  return shots;
}

bool fires_one_after_the_other(const Profile& p) {
  const std::vector<Shot> shots = shots_of(p);
  return std::any_of(shots.begin(), shots.end(), [](const Shot& s) { return s.offset_ns != 0; });
}

}  // namespace

FiringTable::FiringTable(const Profile& p, const Mode& mode)
    : mode_(mode),
      by_encoder_(p.by_encoder()),
      blocks_(blocks_of(p)),
      cycle_ns_(by_encoder_ ? 1e9 / (mode.columns * mode.rate_hz) : p.cycle_us * 1e3 * static_cast<double>(blocks_)),
      cycles_per_turn_(by_encoder_ ? mode.columns : 1e9 / (mode.rate_hz * cycle_ns_)),
      start_rad_(p.azimuth_start_deg * rad_per_deg),
      step_rad_(turn_rad / cycles_per_turn_),
      radius_m_(p.beam_origin_radius_m),
      height_m_(p.beam_origin_height_m),
      range_offset_m_(p.range_offset_m),
      staggered_(fires_one_after_the_other(p)),
      channel_origins_(!p.origin_forward_m.empty() || !p.origin_left_m.empty() || !p.origin_up_m.empty() ||
                       (staggered_ && radius_m_ != 0)),
      window_first_(0),
      window_cycles_(mode.columns),
      window_wrapped_(0) {
  if (!p.column_window.empty()) {
    window_first_ = static_cast<std::int64_t>(p.column_window[0]);
    const auto last = static_cast<std::int64_t>(p.column_window[1]);
    window_wrapped_ = last < window_first_ ? last + 1 : 0;
    window_cycles_ = last < window_first_ ? last + 1 + mode.columns - window_first_ : last + 1 - window_first_;
  }
  if (p.by_prism()) prism_.emplace(p);
  for (const Shot& shot : shots_of(p)) add_firing(p, shot.channel, shot.block, shot.offset_ns);
  if (channel_origins_) radius_m_ = 0;
}

void FiringTable::add_firing(const Profile& p, std::size_t c, std::size_t block, double offset_ns) {
  const double spin = prism_ ? 0 : turn_rad * mode_.rate_hz * 1e-9 * offset_ns;
  const double elevation = p.elevation_deg[c] * rad_per_deg;
  const double azimuth = p.azimuth_offset_cw_deg[c] * rad_per_deg + spin;
  const double ahead = value_or_0(p.origin_forward_m, c), right = -value_or_0(p.origin_left_m, c);
  // Where channels fire one after the other the head's circle turns on between them: it is part of each offset then.
  const double radius = channel_origins_ ? radius_m_ : 0;
  beams_.push_back(
      {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
       ahead * std::cos(azimuth) - right * std::sin(azimuth) + radius * std::cos(spin),
       ahead * std::sin(azimuth) + right * std::cos(azimuth) + radius * std::sin(spin), value_or_0(p.origin_up_m, c)});
  offset_ns_.push_back(static_cast<std::int32_t>(offset_ns));
  elevation_rad_.push_back(elevation);
  azimuth_rad_.push_back(azimuth);
  channel_.push_back(static_cast<std::uint32_t>(c));
  block_.push_back(static_cast<std::uint32_t>(block));
  ring_.push_back(static_cast<std::uint16_t>(p.ring[c]));
}

FiringTable::FiringTable(const Profile& p, const Mode& mode, const SpinJitter& jitter,
                         std::vector<ReplayedSweep> replay, core::Duration start)
    : FiringTable(p, mode) {
  jitter_ = jitter;
  start_ = start;
  if (prism_ && (jitter.on() || jitter.encoder_errs()))
    throw core::InputError(fmt::format("{} has no head that turns: leave spin out", p.name));
  const auto [first, last] = std::minmax_element(offset_ns_.begin(), offset_ns_.end());
  if (by_encoder_ && *last - *first >= cycle_ns_ * (1 - jitter.largest_rate_error()))
    throw core::InputError(
        fmt::format("{}: spin.rate_jitter may be so large that a column begins before the last "
                    "channel of the one before has fired; make it smaller",
                    p.name));
  if (replay.empty()) return;
  if (!by_encoder_)
    throw core::InputError(fmt::format(
        "{} fires by the clock: recorded column times say nothing about where its head was; replay needs a sensor with "
        "timing: encoder",
        p.name));
  if (jitter.on()) throw core::InputError("give recorded column times or spin.rate_jitter, not both");
  if (start.count() != 0) throw core::InputError("give recorded column times or start_offset_ms, not both");
  check_column_times(replay, static_cast<std::size_t>(window_cycles_));
  replay_ = std::make_shared<const std::vector<ReplayedSweep>>(std::move(replay));
}

std::int64_t FiringTable::column_of(std::int64_t k) const {
  return k < window_wrapped_ ? k : window_first_ + k - window_wrapped_;
}

core::Time FiringTable::cycle_time(const SweepSpan& sweep, std::int64_t k) const {
  if (replay_) {
    const ReplayedSweep& times = replay_->at(static_cast<std::size_t>(sweep.index));
    return core::time_from_ns(times.begin_ns + static_cast<std::int64_t>(times.column_ns[static_cast<std::size_t>(k)]));
  }
  double t_ns = static_cast<double>(sweep.first_cycle + (by_encoder_ ? column_of(k) : k)) * cycle_ns_;
  if (by_encoder_ && jitter_ && jitter_->on()) t_ns += 1e9 * jitter_->lead_s(1e-9 * t_ns);
  return core::time_from_ns(std::llround(t_ns)) + start_;
}

// Of a clock-driven head that turns unevenly, at the beginning of a cycle; 0 at the recording's start.
double FiringTable::turns_at_cycle(std::int64_t cycle) const {
  const double t_s = 1e-9 * cycle_ns_ * static_cast<double>(cycle);
  return mode_.rate_hz * (t_s + jitter_->lead_s(t_s));
}

std::int64_t FiringTable::first_cycle_of(std::int64_t sweep) const {
  if (by_encoder_) return sweep * mode_.columns;
  // The margin keeps a cycle that starts on the boundary, to rounding, in the later sweep.
  const auto even = static_cast<std::int64_t>(std::ceil(static_cast<double>(sweep) * cycles_per_turn_ - 1e-6));
  if (!jitter_ || !jitter_->on()) return even;
  const double boundary = static_cast<double>(sweep) - 1e-6 / cycles_per_turn_;
  std::int64_t low = even, high = even, reach = 1;  // turns(low - 1) < boundary <= turns(high)
  for (; low > 0 && turns_at_cycle(low - 1) >= boundary; reach *= 2) low = std::max<std::int64_t>(0, low - reach);
  for (reach = 1; turns_at_cycle(high) < boundary; reach *= 2) high += reach;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (turns_at_cycle(middle) < boundary)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

SweepSpan FiringTable::sweep(std::int64_t index) const {
  SweepSpan span;
  span.index = index;
  span.first_cycle = first_cycle_of(index);
  span.cycles = by_encoder_ ? window_cycles_ : first_cycle_of(index + 1) - span.first_cycle;
  const auto [first, last] = std::minmax_element(offset_ns_.begin(), offset_ns_.end());
  span.begin = cycle_time(span, 0) + core::Duration(*first);
  span.end = cycle_time(span, span.cycles - 1) + core::Duration(*last);
  return span;
}

Cycle FiringTable::cycle(const SweepSpan& sweep, std::int64_t k) const {
  if (prism_) return {cycle_time(sweep, k), 1, 0, 1, 0};
  double turns = 0;  // since the sweep's begin
  if (by_encoder_)
    turns = static_cast<double>(column_of(k)) / cycles_per_turn_;
  else if (jitter_ && jitter_->on())
    turns = turns_at_cycle(sweep.first_cycle + k) - static_cast<double>(sweep.index);
  else
    turns = (static_cast<double>(sweep.first_cycle) - static_cast<double>(sweep.index) * cycles_per_turn_ +
             static_cast<double>(k)) /
            cycles_per_turn_;
  const double azimuth = start_rad_ + turns * turn_rad;
  Cycle cycle{cycle_time(sweep, k), std::cos(azimuth), std::sin(azimuth), 0, 0};
  cycle.cos_encoder = cycle.cos_azimuth;
  cycle.sin_encoder = cycle.sin_azimuth;
  const double error = jitter_ ? jitter_->encoder_error_rad(sweep.first_cycle + k) : 0;
  if (error != 0) {
    // The encoder-driven head is not where its encoder has it; the clock-driven one is told to be where it is not.
    (by_encoder_ ? cycle.cos_azimuth : cycle.cos_encoder) = std::cos(azimuth + error);
    (by_encoder_ ? cycle.sin_azimuth : cycle.sin_encoder) = std::sin(azimuth + error);
  }
  return cycle;
}

std::int64_t FiringTable::sweeps_until(core::Time end) const {
  const double share = jitter_ && jitter_->on() ? 1.25 : 1;  // more turns than this no jitter can make
  const double span_s = std::max(0.0, core::to_s(end - start_));
  std::int64_t n = static_cast<std::int64_t>(span_s * mode_.rate_hz * share) + 1;
  if (replay_) n = std::ssize(*replay_);
  while (n > 0 && sweep(n - 1).end > end) --n;
  return n;
}

// Channels of one fan (equal azimuth offset), from the lowest beam up.
std::vector<std::vector<std::size_t>> FiringTable::channel_groups() const {
  std::vector<std::size_t> order(channels());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return azimuth_rad_[a] < azimuth_rad_[b]; });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t c : order) {
    if (groups.empty() || azimuth_rad_[c] - azimuth_rad_[groups.back().front()] > same_fan_rad) groups.emplace_back();
    groups.back().push_back(c);
  }
  for (auto& group : groups)
    std::stable_sort(group.begin(), group.end(),
                     [&](std::size_t a, std::size_t b) { return elevation_rad_[a] < elevation_rad_[b]; });
  return groups;
}

std::vector<std::uint32_t> FiringTable::tiles(std::size_t cycles) const {
  constexpr std::size_t tile = raycast::SweepTracer::tile;
  std::vector<std::uint32_t> order;
  if (prism_) {
    // A pulse follows the other by about a tenth of a degree: a tile is a piece of the rosette.
    for (std::size_t i = 0; i < cycles * channels(); ++i) order.push_back(static_cast<std::uint32_t>(i));
    while (order.size() % tile != 0) order.push_back(raycast::SweepTracer::no_ray);
    return order;
  }
  for (const std::vector<std::size_t>& group : channel_groups()) {
    const double rise = group.size() < 2 ? 0
                                         : (elevation_rad_[group.back()] - elevation_rad_[group.front()]) /
                                               static_cast<double>(group.size() - 1);
    std::size_t high = 1;  // channels in a tile
    for (const std::size_t h : {2, 4, 8, 16}) {
      // Rays of unequal elevation meet the ground far apart: height costs several times what width does (measured on
      // the stand: one row of 16 is a third faster than 4 x 4 where rows are 1.3 degrees apart and columns 0.35).
      const auto cost = [&](std::size_t n) {
        return 4 * static_cast<double>(n - 1) * rise + static_cast<double>(tile / n - 1) * step_rad_;
      };
      // Places in a tile that the fan does not fill are traced in vain.
      const bool wasteful = 8 * ((group.size() + h - 1) / h * h) > 9 * group.size();
      if (!wasteful && cost(h) < cost(high)) high = h;
    }
    const std::size_t wide = tile / high;
    for (std::size_t k = 0; k < cycles; k += wide)
      for (std::size_t g = 0; g < group.size(); g += high)
        for (std::size_t dk = 0; dk < wide; ++dk)
          for (std::size_t dg = 0; dg < high; ++dg)
            order.push_back(k + dk < cycles && g + dg < group.size()
                                ? static_cast<std::uint32_t>((k + dk) * channels() + group[g + dg])
                                : raycast::SweepTracer::no_ray);
  }
  return order;
}

}  // namespace tarmac::sim::lidar
