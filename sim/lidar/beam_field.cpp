#include "sim/lidar/beam_field.h"

#include <algorithm>
#include <cmath>

#include "core/vector_loop.h"

namespace tarmac::sim::lidar {
namespace {

using raycast::Hits;

// Off the plane by so much a neighbour still counts as on it: a footprint ends at a third of the way to it or less, and
// what bends between the two is then off by less than a tenth of that at the outermost rays.
constexpr float off_plane_m = 0.002f;
constexpr float off_plane_by_cosine_m = 0.01f;
constexpr float parallel = 0.985f;     // cosine of 10 degrees
constexpr float least_cosine = 0.02f;  // nearer to grazing, outer rays may pass beside the plane

struct HitArrays {
  const double* t_m;
  const std::uint32_t* instance;
  const float* relief_m;
};

TARMAC_VECTOR_LOOP void keep_points(std::size_t count, const double* __restrict ox, const double* __restrict oy,
                                    const double* __restrict oz, const double* __restrict dx,
                                    const double* __restrict dy, const double* __restrict dz, const HitArrays hits,
                                    double* __restrict t_m, float* __restrict x, float* __restrict y,
                                    float* __restrict z) {
  for (std::size_t i = 0; i < count; ++i) {
    const double t = hits.instance[i] != Hits::nothing ? hits.t_m[i] : 0.0;
    const double macro = t - static_cast<double>(hits.relief_m[i]);
    t_m[i] = t;
    x[i] = static_cast<float>(ox[i] + macro * dx[i]);
    y[i] = static_cast<float>(oy[i] + macro * dy[i]);
    z[i] = static_cast<float>(oz[i] + macro * dz[i]);
  }
}

TARMAC_VECTOR_LOOP void keep_facing(std::size_t count, const double* __restrict dx, const double* __restrict dy,
                                    const double* __restrict dz, const float* __restrict nx, const float* __restrict ny,
                                    const float* __restrict nz, float* __restrict facing) {
  for (std::size_t i = 0; i < count; ++i)
    facing[i] =
        -(nx[i] * static_cast<float>(dx[i]) + ny[i] * static_cast<float>(dy[i]) + nz[i] * static_cast<float>(dz[i]));
}

struct Surfaces {
  const double* t_m;
  const float *x, *y, *z, *nx, *ny, *nz, *facing;
  const std::uint32_t* instance;
  const std::uint16_t* material;
};

Surfaces surfaces_of(const CentreField& f) {
  return {f.t_m.data(), f.x.data(),  f.y.data(),      f.z.data(),        f.nx.data(),
          f.ny.data(),  f.nz.data(), f.facing.data(), f.instance.data(), f.material.data()};
}

/// Both on one plane of one material, or neither on anything.
inline bool agree(const Surfaces& s, std::size_t i, std::size_t j) {
  const float x = s.x[j] - s.x[i], y = s.y[j] - s.y[i], z = s.z[j] - s.z[i];
  const float off_i = std::abs(s.nx[i] * x + s.ny[i] * y + s.nz[i] * z);
  const float off_j = std::abs(s.nx[j] * x + s.ny[j] * y + s.nz[j] * z);
  const float cosine = std::min(s.facing[i], s.facing[j]);
  const float most = std::max(off_plane_m, off_plane_by_cosine_m * cosine);
  const float along = s.nx[i] * s.nx[j] + s.ny[i] * s.ny[j] + s.nz[i] * s.nz[j];
  const bool met_i = s.t_m[i] > 0, met_j = s.t_m[j] > 0;
  const bool plane = (s.instance[i] == s.instance[j]) & (s.material[i] == s.material[j]) & (along > parallel) &
                     (off_i < most) & (off_j < most) & (cosine > least_cosine);
  return (met_i & met_j & plane) | (!met_i & !met_j);
}

void agree_across(const Surfaces& s, std::size_t count, std::size_t channels, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = agree(s, i, i + channels);
}

}  // namespace

void CentreField::resize(std::size_t n) {
  t_m.resize(n);
  for (auto* v : {&relief_m, &x, &y, &z, &nx, &ny, &nz, &facing, &cos_incidence}) v->resize(n);
  instance.resize(n);
  material.resize(n);
}

void CentreField::keep(std::size_t first, const raycast::Rays& rays, const Hits& hits) {
  const std::size_t n = hits.size();
  keep_points(n, rays.ox.data(), rays.oy.data(), rays.oz.data(), rays.dx.data(), rays.dy.data(), rays.dz.data(),
              {hits.t_m.data(), hits.instance.data(), hits.relief_m.data()}, &t_m[first], &x[first], &y[first],
              &z[first]);
  keep_facing(n, rays.dx.data(), rays.dy.data(), rays.dz.data(), hits.nx.data(), hits.ny.data(), hits.nz.data(),
              &facing[first]);
  const auto copy = [&](const auto& from, auto& to) {
    std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
  };
  copy(hits.relief_m, relief_m);
  copy(hits.nx, nx);
  copy(hits.ny, ny);
  copy(hits.nz, nz);
  copy(hits.cos_incidence, cos_incidence);
  copy(hits.instance, instance);
  for (std::size_t i = 0; i < n; ++i) material[first + i] = hits.instance[i] == Hits::nothing ? 0 : hits.material[i];
}

void EchoField::resize(std::size_t n) {
  t_m.assign(n, 0);
  for (auto* v : {&signal, &cos_incidence, &nx, &ny, &nz}) v->resize(n);
  instance.resize(n);
  kind.assign(n, ReturnKind::surface);
  others.clear();
}

void EchoField::put(std::size_t i, const Echo& e) {
  t_m[i] = e.t_m;
  signal[i] = e.signal;
  cos_incidence[i] = e.cos_incidence;
  nx[i] = e.nx;
  ny[i] = e.ny;
  nz[i] = e.nz;
  instance[i] = e.instance;
  kind[i] = e.kind;
}

Echo EchoField::at(std::size_t i) const {
  return {t_m[i], signal[i], cos_incidence[i], nx[i], ny[i], nz[i], instance[i], kind[i]};
}

void Neighbours::set(std::size_t channels, const std::vector<std::int64_t>& above_cycles,
                     const std::vector<std::int32_t>& above_channel) {
  channels_ = channels;
  above_cycles_ = above_cycles;
  above_channel_ = above_channel;
}

void Neighbours::settle(const CentreField& field, const std::vector<std::uint8_t>& unsettled_material,
                        std::vector<std::uint8_t>& settled) const {
  const std::size_t n = field.size();
  const auto channels = static_cast<std::int64_t>(channels_), cycles = static_cast<std::int64_t>(n) / channels;
  const Surfaces s = surfaces_of(field);
  settled.assign(n, 0);
  if (cycles < 3) return;
  std::vector<std::uint8_t> across(n, 0);
  agree_across(s, n - channels_, channels_, across.data());
  // The first and the last cycle have no neighbour on one side.
  for (std::size_t i = channels_; i + channels_ < n; ++i) settled[i] = across[i] & across[i - channels_];
  // Cycle by cycle: what is looked at together lies together.
  for (std::int64_t k = 0; k < cycles; ++k)
    for (std::int64_t c = 0; c < channels; ++c) {
      const std::int32_t above = above_channel_[static_cast<std::size_t>(c)];
      if (above < 0) continue;
      const std::int64_t other = k + above_cycles_[static_cast<std::size_t>(c)];
      const auto i = static_cast<std::size_t>(k * channels + c);
      const bool there = other >= 0 && other < cycles;
      const auto j = static_cast<std::size_t>(there ? other * channels + above : 0);
      if (there && (settled[i] | settled[j]) && agree(s, i, j)) continue;
      settled[i] = 0;
      if (there) settled[j] = 0;
    }
  for (std::size_t i = 0; i < n; ++i) settled[i] &= !unsettled_material[field.material[i]];
}

}  // namespace tarmac::sim::lidar
