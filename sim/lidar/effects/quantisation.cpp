#include <cmath>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {

void quantise(double step_m, Echoes& echoes) {
  for (double& range : echoes.range_m) range = step_m * std::floor(range / step_m + 0.5);
}

}  // namespace tarmac::sim::lidar
