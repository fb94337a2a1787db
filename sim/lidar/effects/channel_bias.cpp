#include <algorithm>

#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

TARMAC_VECTOR_LOOP void add(std::size_t count, const double* __restrict bias_m, double* __restrict range_m) {
  for (std::size_t i = 0; i < count; ++i) range_m[i] += range_m[i] > 0 ? bias_m[i] : 0.0;
}

}  // namespace

ChannelBias::ChannelBias(const Profile& p, double scale, std::uint64_t seed, const char* stream,
                         std::span<const std::uint32_t> channels) {
  const core::RandomStream draws(seed, stream);
  const std::size_t firings = channels.empty() ? p.channels() : channels.size();
  for (std::size_t i = 0; i < firings; ++i) {
    const std::size_t c = channels.empty() ? i : channels[i];
    bias_m_.push_back(scale * p.channel_bias_sigma_m * draws.normal(c));
  }
}

void ChannelBias::operator()(Echoes& echoes) const {
  for (std::size_t i = 0; i < echoes.firings.size(); ++i)
    if (echoes.range_m[i] > 0) echoes.range_m[i] += bias_m_[echoes.firings[i] % echoes.channels];
  if (!echoes.firings.empty()) return;
  for (std::size_t first = 0; first < echoes.size(); first += echoes.channels)
    add(std::min(echoes.channels, echoes.size() - first), bias_m_.data(), echoes.range_m.data() + first);
}

}  // namespace tarmac::sim::lidar
