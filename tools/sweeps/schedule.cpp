#include "tools/sweeps/schedule.h"

#include <algorithm>
#include <numeric>

namespace tarmac::tools {

SweepSchedule::SweepSchedule(std::vector<std::vector<std::size_t>> cells, const std::vector<double>& cost)
    : order_(cells.size()) {
  for (std::vector<std::size_t>& of_world : cells) {
    std::reverse(of_world.begin(), of_world.end());
    World world;
    world.unfinished = of_world.size();
    world.to_start = std::move(of_world);
    worlds_.push_back(std::move(world));
  }
  std::iota(order_.begin(), order_.end(), 0);
  // The longest first: what is left for the end is short, and no slot waits long for another.
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return cost[a] > cost[b]; });
}

std::optional<SweepTask> SweepSchedule::next() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (stopped_) return std::nullopt;
    bool simulating = false;
    for (const std::size_t w : order_) {
      World& world = worlds_[w];
      if (world.to_start.empty()) continue;
      if (world.state == World::State::ready) {
        const SweepTask task{SweepTask::Kind::cell, w, world.to_start.back()};
        world.to_start.pop_back();
        return task;
      }
      simulating = simulating || world.state == World::State::simulating;
    }
    for (const std::size_t w : order_) {
      World& world = worlds_[w];
      if (world.to_start.empty() || world.state != World::State::waiting) continue;
      world.state = World::State::simulating;
      return SweepTask{SweepTask::Kind::simulate, w, 0};
    }
    if (!simulating) return std::nullopt;
    changed_.wait(lock);
  }
}

void SweepSchedule::simulated(std::size_t world) {
  const std::lock_guard lock(mutex_);
  worlds_[world].state = World::State::ready;
  changed_.notify_all();
}

bool SweepSchedule::finished(const SweepTask& cell) {
  const std::lock_guard lock(mutex_);
  return --worlds_[cell.world].unfinished == 0;
}

void SweepSchedule::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

}  // namespace tarmac::tools
