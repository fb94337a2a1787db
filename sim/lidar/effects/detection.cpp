#include <algorithm>
#include <cmath>

#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double normal_quantile_90 = 1.2815515655446004;  // Phi(x) = 0.9: the data sheet's probability
constexpr double table_step_m = 0.0625;
// Farther than this from the threshold, chance has no say (probability below 1e-7).
constexpr float certain = 5.3f;

/// Signal over noise above the threshold; the table's last entry is never interpolated from.
TARMAC_VECTOR_LOOP void excess_of(std::size_t count, const double* __restrict range_m, const float* __restrict signal,
                                  const float* __restrict falloff, int last, float steps_per_m, float threshold,
                                  float* __restrict excess) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(range_m[i]) * steps_per_m;
    const int whole = static_cast<int>(x), k = whole < last ? whole : last;
    const float low = falloff[k], high = falloff[k + 1];
    excess[i] = signal[i] * (low + (x - static_cast<float>(k)) * (high - low)) - threshold;
  }
}

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
  std::vector<float>& excess = echoes.scratch;
  excess.resize(echoes.size());
  excess_of(echoes.size(), echoes.range_m.data(), echoes.signal.data(), falloff_.data(),
            static_cast<int>(falloff_.size()) - 2, static_cast<float>(1 / range_step_m_),
            static_cast<float>(threshold_), excess.data());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (excess[i] > certain || echoes.range_m[i] <= 0) continue;
    float n = 0;
    if (excess[i] > -certain) stream_.normals(echoes.first_firing + i, {&n, 1});
    if (excess[i] + n <= 0) echoes.range_m[i] = 0;
  }
}

}  // namespace tarmac::sim::lidar
