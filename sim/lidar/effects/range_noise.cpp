#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {

RangeNoise::RangeNoise(const Profile& p, double scale, std::uint64_t seed, const char* stream)
    : stream_(seed, stream), from_m_(p.sigma_from_m) {
  for (const double sigma : p.sigma_m) sigma_m_.push_back(scale * sigma);
}

void RangeNoise::operator()(Echoes& echoes) const {
  stream_.normals(echoes.first_firing, echoes.draws);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const double range = echoes.range_m[i];
    if (range <= 0) continue;
    double sigma = sigma_m_.front();
    for (std::size_t k = 1; k < from_m_.size(); ++k)
      if (range >= from_m_[k]) sigma = sigma_m_[k];
    echoes.range_m[i] = range + sigma * static_cast<double>(echoes.draws[i]);
  }
}

}  // namespace tarmac::sim::lidar
