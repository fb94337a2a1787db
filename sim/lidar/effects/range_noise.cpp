#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

TARMAC_VECTOR_LOOP void choose_sigma(std::size_t count, const double* __restrict range_m, double from_m, float sigma_m,
                                     float* __restrict chosen_m) {
  for (std::size_t i = 0; i < count; ++i) chosen_m[i] = range_m[i] >= from_m ? sigma_m : chosen_m[i];
}

TARMAC_VECTOR_LOOP void add_noise(std::size_t count, const float* __restrict sigma_m, const float* __restrict draws,
                                  double* __restrict range_m) {
  for (std::size_t i = 0; i < count; ++i) {
    const double noise = static_cast<double>(sigma_m[i]) * static_cast<double>(draws[i]);
    range_m[i] += range_m[i] > 0 ? noise : 0.0;
  }
}

}  // namespace

RangeNoise::RangeNoise(const Profile& p, double scale, std::uint64_t seed, const char* stream)
    : stream_(seed, stream), from_m_(p.sigma_from_m) {
  for (const double sigma : p.sigma_m) sigma_m_.push_back(static_cast<float>(scale * sigma));
}

void RangeNoise::operator()(Echoes& echoes) const {
  echoes.draw(stream_);
  std::vector<float>& sigma_m = echoes.scratch;
  sigma_m.assign(echoes.size(), sigma_m_.front());
  for (std::size_t k = 1; k < from_m_.size(); ++k)
    choose_sigma(echoes.size(), echoes.range_m.data(), from_m_[k], sigma_m_[k], sigma_m.data());
  add_noise(echoes.size(), sigma_m.data(), echoes.draws.data(), echoes.range_m.data());
}

}  // namespace tarmac::sim::lidar
