/// When and where the columns of one sweep were fired.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tarmac::sim::faults {

/// One value a column (firing cycle), in firing order.
struct Columns {
  std::vector<std::int32_t> begin_ns;  ///< true, from the sweep's true begin; ascending from 0
  std::vector<double> azimuth_deg;     ///< of the head, clockwise from sensor +x, 0 to 360

  std::size_t size() const { return begin_ns.size(); }
  /// The column in which a point was fired at this true time from the sweep's begin.
  std::size_t of(std::int32_t t_ns) const {
    const auto after = std::upper_bound(begin_ns.begin(), begin_ns.end(), t_ns);
    return after == begin_ns.begin() ? 0 : static_cast<std::size_t>(after - begin_ns.begin()) - 1;
  }
};

}  // namespace tarmac::sim::faults
