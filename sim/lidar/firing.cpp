#include "sim/lidar/firing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double turn_rad = 2 * std::numbers::pi;
// Channels whose azimuth offsets differ by less than this look the same way.
constexpr double same_fan_rad = 1.0 * rad_per_deg;

}  // namespace

FiringTable::FiringTable(const Profile& p, const Mode& mode)
    : mode_(mode),
      by_encoder_(p.by_encoder()),
      cycle_ns_(by_encoder_ ? 1e9 / (mode.columns * mode.rate_hz) : p.cycle_us * 1e3),
      cycles_per_turn_(by_encoder_ ? mode.columns : 1e9 / (mode.rate_hz * cycle_ns_)),
      start_rad_(p.azimuth_start_deg * rad_per_deg),
      step_rad_(turn_rad / cycles_per_turn_),
      radius_m_(p.beam_origin_radius_m),
      height_m_(p.beam_origin_height_m),
      staggered_(std::any_of(p.firing_us.begin(), p.firing_us.end(), [](double t) { return t != 0; })) {
  const double spin_rad_ns = by_encoder_ ? 0 : turn_rad * mode.rate_hz * 1e-9;
  for (std::size_t c = 0; c < p.channels(); ++c) {
    const double offset_ns = std::round(p.firing_us[c] * 1e3);
    const double elevation = p.elevation_deg[c] * rad_per_deg;
    const double azimuth = p.azimuth_offset_cw_deg[c] * rad_per_deg + spin_rad_ns * offset_ns;
    beams_.push_back(
        {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)});
    offset_ns_.push_back(static_cast<std::int32_t>(offset_ns));
    elevation_rad_.push_back(elevation);
    azimuth_rad_.push_back(azimuth);
  }
}

core::Time FiringTable::cycle_time(std::int64_t cycle) const {
  return core::time_from_ns(std::llround(static_cast<double>(cycle) * cycle_ns_));
}

std::int64_t FiringTable::first_cycle_of(std::int64_t sweep) const {
  if (by_encoder_) return sweep * mode_.columns;
  // The margin keeps a cycle that starts on the boundary, to rounding, in the later sweep.
  return static_cast<std::int64_t>(std::ceil(static_cast<double>(sweep) * cycles_per_turn_ - 1e-6));
}

SweepSpan FiringTable::sweep(std::int64_t index) const {
  SweepSpan span;
  span.index = index;
  span.first_cycle = first_cycle_of(index);
  span.cycles = first_cycle_of(index + 1) - span.first_cycle;
  const auto [first, last] = std::minmax_element(offset_ns_.begin(), offset_ns_.end());
  span.begin = cycle_time(span.first_cycle) + core::Duration(*first);
  span.end = cycle_time(span.first_cycle + span.cycles - 1) + core::Duration(*last);
  return span;
}

Cycle FiringTable::cycle(const SweepSpan& sweep, std::int64_t k) const {
  const double turns = (static_cast<double>(sweep.first_cycle) - static_cast<double>(sweep.index) * cycles_per_turn_ +
                        static_cast<double>(k)) /
                       cycles_per_turn_;
  const double azimuth = start_rad_ + turns * turn_rad;
  return {cycle_time(sweep.first_cycle + k), std::cos(azimuth), std::sin(azimuth)};
}

std::int64_t FiringTable::sweeps_until(core::Time end) const {
  std::int64_t n = static_cast<std::int64_t>(core::to_s(end) * mode_.rate_hz) + 1;
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
      if (cost(h) < cost(high)) high = h;
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
