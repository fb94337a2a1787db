/// Thins a cloud out to one point a voxel: the first to come, at its own coordinates.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "estimators/blocks/voxel.h"

namespace tarmac::estimators {

/// Keeps the first point of every voxel. The kept ones come out in the order of a robin-hood hash table with at least
/// two buckets a candidate, which scatters them over space: thinned out a second time with a larger cell, first-come in
/// that order picks a point from anywhere in the large cell, where firing order would always pick the same edge of it.
/// The order is a function of the input alone. It is also KISS-ICP's, whose down-sampling walks over such a table.
/// Source: Celis, Robin Hood Hashing (1986).
class VoxelSampler {
 public:
  /// `kept` receives those indices out of `candidates` (indices into `points`) that come first in their voxel.
  /// Every candidate must satisfy has_voxel(point, cell_m).
  void sample(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> candidates, double cell_m,
              std::vector<std::uint32_t>& kept);

 private:
  struct Slot {
    Voxel voxel;
    std::uint32_t point = 0;
  };
  void clear_for(std::size_t candidates);
  bool occupied(std::uint32_t slot) const { return (occupied_[slot >> 6] >> (slot & 63)) & 1U; }
  std::uint32_t distance_from_home(std::uint32_t slot) const {
    return (slot - spatial_hash(slots_[slot].voxel)) & mask_;
  }
  bool contains(const Voxel& voxel) const;
  void insert(Slot item);
  void collect(std::vector<std::uint32_t>& kept) const;

  std::uint32_t mask_ = 0;
  std::vector<Slot> slots_;
  std::vector<std::uint64_t> occupied_;  ///< one bit a slot: cheap to clear and to walk over
};

}  // namespace tarmac::estimators
