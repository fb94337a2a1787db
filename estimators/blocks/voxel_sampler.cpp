#include "estimators/blocks/voxel_sampler.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace tarmac::estimators {

void VoxelSampler::clear_for(std::size_t candidates) {
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * candidates, 64));
  mask_ = static_cast<std::uint32_t>(slots - 1);
  if (slots_.size() < slots) slots_.resize(slots);
  occupied_.assign(slots / 64, 0);
}

bool VoxelSampler::contains(const Voxel& voxel) const {
  for (std::uint32_t slot = spatial_hash(voxel) & mask_; occupied(slot); slot = (slot + 1) & mask_) {
    if (slots_[slot].voxel == voxel) return true;
  }
  return false;
}

void VoxelSampler::insert(Slot item) {
  std::uint32_t slot = spatial_hash(item.voxel) & mask_;
  for (std::uint32_t distance = 0; occupied(slot); ++distance, slot = (slot + 1) & mask_) {
    // Whoever is farther from home takes the place, and the other moves on.
    const std::uint32_t other = distance_from_home(slot);
    if (distance > other) {
      std::swap(item, slots_[slot]);
      distance = other;
    }
  }
  slots_[slot] = item;
  occupied_[slot >> 6] |= std::uint64_t{1} << (slot & 63);
}

void VoxelSampler::collect(std::vector<std::uint32_t>& kept) const {
  for (std::size_t word = 0; word < occupied_.size(); ++word) {
    for (std::uint64_t bits = occupied_[word]; bits != 0; bits &= bits - 1) {
      kept.push_back(slots_[word * 64 + static_cast<std::size_t>(std::countr_zero(bits))].point);
    }
  }
}

void VoxelSampler::sample(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> candidates,
                          double cell_m, std::vector<std::uint32_t>& kept) {
  kept.clear();
  clear_for(candidates.size());
  for (const std::uint32_t i : candidates) {
    const Voxel voxel = voxel_of(points[i], cell_m);
    if (!contains(voxel)) insert({voxel, i});
  }
  collect(kept);
}

}  // namespace tarmac::estimators
