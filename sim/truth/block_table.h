/// A long table of which only the part around the present is in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tarmac::sim::truth {

/// Blocks are made when they are asked for, by a function whose answer depends on the block's index alone: who asks
/// first, and how often a block was dropped in between, cannot be seen. Who goes through a drive of any length a few
/// times (a simulation does) has `capacity` blocks in memory; for who goes through it again and again (a scoring does)
/// there will be room for more of them. Safe to ask from several threads; what two of them miss at once is made twice,
/// and is the same.
template <class Block>
class BlockTable {
 public:
  using Make = std::function<Block(std::size_t index)>;

  BlockTable(std::size_t capacity, Make make) : make_(std::move(make)), slots_(capacity) {}

  std::shared_ptr<const Block> get(std::size_t index) const {
    {
      const std::scoped_lock lock(mutex_);
      const Slot& slot = slots_[index % slots_.size()];
      if (slot.block && slot.index == index) return slot.block;
    }
    auto made = std::make_shared<const Block>(make_(index));
    const std::scoped_lock lock(mutex_);
    make_room(index);
    slots_[index % slots_.size()] = {index, made};
    return made;
  }

  /// For who has just made it anyway; it must be what make(index) gives.
  void put(std::size_t index, std::shared_ptr<const Block> block) const {
    const std::scoped_lock lock(mutex_);
    slots_[index % slots_.size()] = {index, std::move(block)};
  }

 private:
  struct Slot {
    std::size_t index = 0;
    std::shared_ptr<const Block> block;
  };
  static constexpr std::size_t few_times = 8;

  /// Doubles the room when, on average, every block has been made more than a few times. Under the lock.
  void make_room(std::size_t index) const {
    blocks_ = std::max(blocks_, index + 1);
    if (++made_ <= few_times * blocks_) return;
    made_ = 0;
    std::vector<Slot> wider(2 * slots_.size());
    for (Slot& slot : slots_) wider[slot.index % wider.size()] = std::move(slot);
    slots_ = std::move(wider);
  }

  Make make_;
  mutable std::mutex mutex_;
  mutable std::size_t blocks_ = 0, made_ = 0;  ///< the highest index so far and one; how often one was made anew
  mutable std::vector<Slot> slots_;  ///< a block's place is its index modulo their number: neighbours never collide
};

}  // namespace tarmac::sim::truth
