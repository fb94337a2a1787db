/// Where in a sweep's image of rings and columns a point belongs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/time.h"
#include "sim/lidar/firing.h"

namespace tarmac::sim::lidar {

/// The firings of one sweep as a grid: a row for each ring, a column for each block of each cycle (FiringTable::blocks;
/// one a cycle for most sensors). Channels that fire at different instants of a cycle share its column; beams of a
/// column may look in different directions.
class FiringGrid {
 public:
  struct Cell {
    std::size_t ring, column;
  };

  FiringGrid(const FiringTable& firing, std::int64_t sweep);

  std::size_t rings() const { return by_ring_.size(); }
  std::size_t columns() const { return cycles_ns_.size() * blocks_; }
  core::Time begin() const { return begin_; }  ///< true, of the sweep's first firing
  /// The firing of a ring at that true time from begin(), to the nanosecond; nullopt where the table has none.
  std::optional<Cell> cell(std::uint16_t ring, std::int64_t t_ns) const;
  /// Firing time of a column's first firing, from begin() [ns].
  std::vector<std::int64_t> column_times_ns() const;

 private:
  struct Firing {
    std::int64_t offset_ns;
    std::size_t block;
  };
  core::Time begin_;
  std::size_t blocks_;
  std::vector<std::int64_t> cycles_ns_;       // begins of the cycles, from begin()
  std::vector<std::vector<Firing>> by_ring_;  // of a cycle
};

}  // namespace tarmac::sim::lidar
