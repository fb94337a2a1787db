#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr float max_roughness_factor = 5;
constexpr float retro_half_width_rad = static_cast<float>(30 * std::numbers::pi / 180);

}  // namespace

void Echoes::resize(std::size_t n) {
  range_m.resize(n);
  cos_incidence.resize(n);
  material.resize(n);
  signal.resize(n);
  intensity.resize(n);
  draws.resize(n);
}

Reflectance::Reflectance(const std::vector<scenes::Material>& materials) {
  for (const scenes::Material& m : materials) {
    const double s2 = m.oren_nayar_sigma_rad * m.oren_nayar_sigma_rad, a2 = m.ggx_alpha * m.ggx_alpha;
    materials_.push_back({static_cast<float>(m.diffuse), static_cast<float>(1 - 0.5 * s2 / (s2 + 0.33)),
                          static_cast<float>(0.45 * s2 / (s2 + 0.09)), static_cast<float>(a2),
                          // pi F0 / 4 times D's alpha^2 / pi
                          static_cast<float>(m.specular_f0 * a2 / 4), static_cast<float>(m.retro)});
  }
}

void Reflectance::operator()(Echoes& echoes) const {
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Coefficients& m = materials_[echoes.material[i]];
    const float c = std::max(echoes.cos_incidence[i], 1e-4f), c2 = c * c, s2 = 1 - c2;
    float rho = m.diffuse * std::min(m.a + m.b * s2 / c, max_roughness_factor);
    if (m.alpha2 > 0) {
      const float d = c2 * (m.alpha2 - 1) + 1;
      const float g1 = 2 / (1 + std::sqrt(1 + m.alpha2 * s2 / c2));
      rho += m.glossy * g1 * g1 / (d * d * c2);
    }
    if (m.retro > 0) {
      const float theta = std::acos(std::min(c, 1.0f)) / retro_half_width_rad, theta2 = theta * theta;
      rho += m.retro * std::exp(-theta2 * theta2);
    }
    echoes.signal[i] = rho * c;
  }
}

}  // namespace tarmac::sim::lidar
