#include <cstdint>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {

void quantise(double step_m, Echoes& echoes) {
  // Ranges are not negative (0 = no echo), so cutting off the fraction rounds down.
  for (double& range : echoes.range_m)
    range = step_m * static_cast<double>(static_cast<std::int64_t>(range / step_m + 0.5));
}

}  // namespace tarmac::sim::lidar
