#include <algorithm>
#include <cmath>

#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr float share_of_noise = 0.05f;
constexpr float counts_of_noise = 1;

float above_white(float signal) {
  return 100 + 155 * std::log10(signal) / 2;
}

TARMAC_VECTOR_LOOP void in_percent(std::size_t count, const float* __restrict signal, float* __restrict intensity) {
  for (std::size_t i = 0; i < count; ++i) intensity[i] = 100 * signal[i];
}

TARMAC_VECTOR_LOOP void count_out(std::size_t count, const float* __restrict draws, float* __restrict intensity) {
  for (std::size_t i = 0; i < count; ++i) {
    const float value = intensity[i], noisy = value + draws[i] * (counts_of_noise + share_of_noise * value);
    const float low = noisy < 0 ? 0 : noisy, held = low > 255 ? 255 : low;
    intensity[i] = static_cast<float>(static_cast<int>(held + 0.5f));
  }
}

}  // namespace

Intensity::Intensity(bool noise, std::uint64_t seed, const char* stream) : stream_(seed, stream), noise_(noise) {}

void Intensity::operator()(Echoes& echoes) const {
  if (noise_)
    echoes.draw(stream_);
  else
    std::fill(echoes.draws.begin(), echoes.draws.end(), 0.0f);
  in_percent(echoes.size(), echoes.signal.data(), echoes.intensity.data());
  for (std::size_t i = 0; i < echoes.size(); ++i)
    if (echoes.signal[i] > 1) echoes.intensity[i] = above_white(echoes.signal[i]);
  count_out(echoes.size(), echoes.draws.data(), echoes.intensity.data());
}

}  // namespace tarmac::sim::lidar
