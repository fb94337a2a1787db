#include <algorithm>
#include <cmath>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {

SnrNoise::SnrNoise(const Profile& p, double scale, double smear, std::uint64_t seed, const char* stream)
    : stream_(seed, stream),
      from_m_(p.sigma_from_m),
      sigma_m_(p.sigma_m),
      scale_(scale),
      spread_(p.divergence_mrad.empty()
                  ? 0
                  : smear * 1e-3 * std::sqrt(p.divergence_mrad.front() * p.divergence_mrad.back())) {}

double SnrNoise::sigma_m(double range_m, double signal, double cos_incidence) const {
  std::size_t row = 0;
  while (row + 1 < from_m_.size() && range_m >= from_m_[row + 1]) ++row;
  const double ratio = std::min(max_ratio, reference_signal / std::max(signal, 1e-9));
  const double c = std::clamp(cos_incidence, 1e-6, 1.0), tangent = std::min(max_tangent, std::sqrt(1 - c * c) / c);
  const double smear_m = spread_ * range_m * tangent;
  return scale_ * std::sqrt(sigma_m_[row] * sigma_m_[row] * (0.5 + 0.5 * ratio) + smear_m * smear_m);
}

void SnrNoise::operator()(Echoes& echoes) const {
  echoes.draw(stream_);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (echoes.range_m[i] <= 0) continue;
    const double sigma =
        sigma_m(echoes.range_m[i], static_cast<double>(echoes.signal[i]), static_cast<double>(echoes.cos_incidence[i]));
    echoes.range_m[i] += sigma * static_cast<double>(echoes.draws[i]);
  }
}

}  // namespace tarmac::sim::lidar
