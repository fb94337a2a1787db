#include <algorithm>
#include <cmath>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double unbiased_signal = 0.2;
constexpr float full_signal = 100;  // the intensity's upper end

}  // namespace

double Brightness::bias_m(float signal) const {
  const double s = std::max(1e-9, static_cast<double>(signal));
  double bias = walk_m * std::clamp(std::log10(s / unbiased_signal), -1.0, 1.0);
  if (saturates(signal)) bias += saturation_bias_m * std::min(1.0, std::log10(s / saturation_signal) / 2);
  return bias;
}

void Brightness::operator()(Echoes& echoes) const {
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (echoes.range_m[i] <= 0) continue;
    echoes.range_m[i] += bias_m(echoes.signal[i]);
    if (saturates(echoes.signal[i])) echoes.signal[i] = full_signal;
  }
}

}  // namespace tarmac::sim::lidar
