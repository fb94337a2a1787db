#include <algorithm>
#include <cmath>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double normal_quantile_90 = 1.2815515655446004;  // Phi(x) = 0.9: the data sheet's probability
constexpr double table_step_m = 0.0625;
// Farther than this from the threshold, chance has no say (probability below 1e-7).
constexpr float certain = 5.3f;

}  // namespace

Detection::Detection(const Profile& p, std::uint64_t seed, const char* stream)
    : stream_(seed, stream),
      threshold_(p.threshold_snr),
      range_10_m_(p.range_10_percent_m),
      exponent_(std::log(8.0) / std::log(p.range_80_percent_m / p.range_10_percent_m)),
      snr_0_(p.threshold_snr + normal_quantile_90),
      range_step_m_(table_step_m) {
  for (double r = 0; r < p.max_range_m + 2; r += range_step_m_)
    falloff_.push_back(static_cast<float>(snr(1.0, std::max(r, range_step_m_))));
}

double Detection::snr(double signal, double range_m) const {
  return snr_0_ * (signal / 0.1) * std::pow(range_10_m_ / range_m, exponent_);
}

void Detection::operator()(Echoes& echoes) const {
  const float per_step = static_cast<float>(1 / range_step_m_);
  const float threshold = static_cast<float>(threshold_);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (echoes.range_m[i] <= 0) continue;
    const float x = static_cast<float>(echoes.range_m[i]) * per_step;
    const std::size_t k = std::min(static_cast<std::size_t>(x), falloff_.size() - 2);
    const float excess =
        echoes.signal[i] * (falloff_[k] + (x - static_cast<float>(k)) * (falloff_[k + 1] - falloff_[k])) - threshold;
    if (excess > certain) continue;
    float n = 0;
    if (excess > -certain) stream_.normals(echoes.first_firing + i, {&n, 1});
    if (excess + n <= 0) echoes.range_m[i] = 0;
  }
}

}  // namespace tarmac::sim::lidar
