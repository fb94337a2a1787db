/// A long table of which only the part around the present is in memory.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tarmac::sim::truth {

/// Blocks are made when they are asked for, by a function whose answer depends on the block's index alone: who asks
/// first, and how often a block was dropped in between, cannot be seen. A drive of any length costs `capacity` blocks.
/// Safe to ask from several threads; what two of them miss at once is made twice, and is the same.
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
    put(index, made);
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
  Make make_;
  mutable std::mutex mutex_;
  mutable std::vector<Slot> slots_;  ///< a block's place is its index modulo their number: neighbours never collide
};

}  // namespace tarmac::sim::truth
