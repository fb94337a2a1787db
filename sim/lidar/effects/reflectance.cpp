#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vector_loop.h"
#include "sim/lidar/effects/echoes.h"

namespace tarmac::sim::lidar {
namespace {

constexpr float max_roughness_factor = 5;
constexpr float retro_half_width_rad = static_cast<float>(30 * std::numbers::pi / 180);

/// Diffuse and glossy parts; rows of six coefficients a material.
TARMAC_VECTOR_LOOP void reflect(std::size_t count, const std::uint16_t* __restrict material,
                                const float* __restrict cosine, const float* __restrict table,
                                float* __restrict signal) {
  for (std::size_t i = 0; i < count; ++i) {
    const int row = 6 * static_cast<int>(material[i]);
    const float diffuse = table[row], a = table[row + 1], b = table[row + 2], alpha2 = table[row + 3],
                glossy = table[row + 4];
    const float c = cosine[i] > 1e-4f ? cosine[i] : 1e-4f, c2 = c * c, s2 = 1 - c2;
    const float rough = a + b * s2 / c, held = rough < max_roughness_factor ? rough : max_roughness_factor;
    const float d = c2 * (alpha2 - 1) + 1, g1 = 2 / (1 + std::sqrt(1 + alpha2 * s2 / c2));
    const float lobe = glossy * g1 * g1 / (d * d * c2);
    signal[i] = c * (diffuse * held + (alpha2 > 0 ? lobe : 0.0f));
  }
}

}  // namespace

void Echoes::resize(std::size_t n) {
  range_m.resize(n);
  cos_incidence.resize(n);
  material.resize(n);
  signal.resize(n);
  intensity.resize(n);
  draws.resize(n);
}

void Echoes::draw(const core::RandomStream& stream) {
  if (firings.empty())
    stream.normals(first_firing, draws);
  else
    for (std::size_t i = 0; i < firings.size(); ++i) stream.normals(firings[i], {&draws[i], 1});
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
  signals(echoes.size(), echoes.material.data(), echoes.cos_incidence.data(), echoes.signal.data());
}

void Reflectance::signals(std::size_t count, const std::uint16_t* material, const float* cos_incidence,
                          float* signal) const {
  static_assert(sizeof(Coefficients) == 6 * sizeof(float));
  reflect(count, material, cos_incidence, &materials_.front().diffuse, signal);
  for (std::size_t i = 0; i < count; ++i) {
    const float retro = materials_[material[i]].retro;
    if (retro <= 0) continue;
    const float c = std::clamp(cos_incidence[i], 1e-4f, 1.0f);
    const float theta = std::acos(c) / retro_half_width_rad, theta2 = theta * theta;
    signal[i] += c * retro * std::exp(-theta2 * theta2);
  }
}

}  // namespace tarmac::sim::lidar
