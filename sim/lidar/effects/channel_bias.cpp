#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {

ChannelBias::ChannelBias(const Profile& p, double scale, std::uint64_t seed, const char* stream) {
  const core::RandomStream draws(seed, stream);
  for (std::size_t c = 0; c < p.channels(); ++c) bias_m_.push_back(scale * p.channel_bias_sigma_m * draws.normal(c));
}

void ChannelBias::operator()(Echoes& echoes) const {
  for (std::size_t i = 0, channel = 0; i < echoes.size(); ++i) {
    if (echoes.range_m[i] > 0) echoes.range_m[i] += bias_m_[channel];
    if (++channel == echoes.channels) channel = 0;
  }
}

}  // namespace tarmac::sim::lidar
