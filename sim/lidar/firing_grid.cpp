#include "sim/lidar/firing_grid.h"

#include <algorithm>
#include <limits>

namespace tarmac::sim::lidar {

FiringGrid::FiringGrid(const FiringTable& firing, std::int64_t sweep) : blocks_(firing.blocks()) {
  const SweepSpan span = firing.sweep(sweep);
  begin_ = span.begin;
  for (std::int64_t k = 0; k < span.cycles; ++k) cycles_ns_.push_back((firing.cycle(span, k).t - span.begin).count());
  for (std::size_t c = 0; c < firing.channels(); ++c) {
    if (firing.ring(c) >= by_ring_.size()) by_ring_.resize(firing.ring(c) + std::size_t{1});
    by_ring_[firing.ring(c)].push_back({firing.offset_ns(c), firing.block_of(c)});
  }
}

std::optional<FiringGrid::Cell> FiringGrid::cell(std::uint16_t ring, std::int64_t t_ns) const {
  if (ring >= by_ring_.size()) return std::nullopt;
  for (const Firing& firing : by_ring_[ring]) {
    const auto cycle = std::lower_bound(cycles_ns_.begin(), cycles_ns_.end(), t_ns - firing.offset_ns);
    if (cycle == cycles_ns_.end() || *cycle != t_ns - firing.offset_ns) continue;
    return Cell{ring, static_cast<std::size_t>(cycle - cycles_ns_.begin()) * blocks_ + firing.block};
  }
  return std::nullopt;
}

std::vector<std::int64_t> FiringGrid::column_times_ns() const {
  std::vector<std::int64_t> first_ns(blocks_, std::numeric_limits<std::int64_t>::max());
  for (const auto& firings : by_ring_)
    for (const Firing& firing : firings) first_ns[firing.block] = std::min(first_ns[firing.block], firing.offset_ns);
  std::vector<std::int64_t> times;
  for (const std::int64_t cycle_ns : cycles_ns_)
    for (const std::int64_t offset_ns : first_ns) times.push_back(cycle_ns + offset_ns);
  return times;
}

}  // namespace tarmac::sim::lidar
