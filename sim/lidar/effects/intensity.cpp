#include <algorithm>
#include <cmath>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr float share_of_noise = 0.05f;
constexpr float counts_of_noise = 1;

float calibrated(float signal) {
  return signal <= 1 ? 100 * signal : 100 + 155 * std::log10(signal) / 2;
}

}  // namespace

Intensity::Intensity(bool noise, std::uint64_t seed, const char* stream) : stream_(seed, stream), noise_(noise) {}

void Intensity::operator()(Echoes& echoes) const {
  if (noise_)
    stream_.normals(echoes.first_firing, echoes.draws);
  else
    std::fill(echoes.draws.begin(), echoes.draws.end(), 0.0f);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const float value = calibrated(echoes.signal[i]);
    const float noisy = value + echoes.draws[i] * (counts_of_noise + share_of_noise * value);
    echoes.intensity[i] = static_cast<float>(static_cast<int>(std::clamp(noisy, 0.0f, 255.0f) + 0.5f));
  }
}

}  // namespace tarmac::sim::lidar
