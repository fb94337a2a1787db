#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

TARMAC_VECTOR_LOOP void round_to(double step_m, std::size_t count, double* __restrict range_m) {
  constexpr double whole = 4503599627370496.0;  // 2^52: from here on doubles have no fraction
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = range_m[i] / step_m + 0.5, nearest = (wanted + whole) - whole;
    range_m[i] = step_m * (nearest > wanted ? nearest - 1 : nearest);  // halves up; 0 = no echo stays 0
  }
}

}  // namespace

void quantise(double step_m, Echoes& echoes) {
  round_to(step_m, echoes.size(), echoes.range_m.data());
}

}  // namespace tarmac::sim::lidar
