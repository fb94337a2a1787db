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

/// Not both on one plane of one material, nor both on nothing.
inline std::uint8_t differ(const Surfaces& s, std::size_t i, std::size_t j) {
  const float x = s.x[j] - s.x[i], y = s.y[j] - s.y[i], z = s.z[j] - s.z[i];
  const float i_to_j = s.nx[i] * x + s.ny[i] * y + s.nz[i] * z, j_to_i = s.nx[j] * x + s.ny[j] * y + s.nz[j] * z;
  const float off_i = i_to_j < 0 ? -i_to_j : i_to_j, off_j = j_to_i < 0 ? -j_to_i : j_to_i;
  const float cosine = s.facing[i] < s.facing[j] ? s.facing[i] : s.facing[j];
  const float by_cosine = off_plane_by_cosine_m * cosine, most = by_cosine > off_plane_m ? by_cosine : off_plane_m;
  const float along = s.nx[i] * s.nx[j] + s.ny[i] * s.ny[j] + s.nz[i] * s.nz[j];
  const bool met_i = s.t_m[i] > 0, met_j = s.t_m[j] > 0;
  const bool plane = (s.instance[i] == s.instance[j]) & (s.material[i] == s.material[j]) & (along > parallel) &
                     (off_i < most) & (off_j < most) & (cosine > least_cosine);
  return !((met_i & met_j & plane) | (!met_i & !met_j));
}

TARMAC_VECTOR_LOOP void differ_across(std::size_t count, std::size_t channels, const Surfaces s,
                                      std::uint8_t* __restrict out) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) out[i] = differ(s, i, i + channels);
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

void Neighbours::set(const std::vector<Above>& above) {
  above_ = above;
  nothing_below_.assign(above.size(), 1);
  for (const Above& a : above)
    if (a.channel >= 0) nothing_below_[static_cast<std::size_t>(a.channel)] = 0;
}

void Neighbours::look(const CentreField& field, const std::vector<std::uint8_t>& open_material,
                      std::vector<std::uint8_t>& open) const {
  const std::size_t n = field.size(), channels = above_.size();
  std::vector<std::uint8_t> across(n, 1);  // from each to the next cycle, which is on the right: heads turn clockwise
  if (n > channels) differ_across(n - channels, channels, surfaces_of(field), across.data());
  open.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const int on_left = i < channels ? 1 : across[i - channels];
    open[i] = static_cast<std::uint8_t>(on_left * side::left + across[i] * side::right);
  }
  look_up(field, open);
  for (std::size_t i = 0; i < n; ++i)
    if (open_material[field.material[i]]) open[i] = side::all;
}

/// Cycle by cycle: what is looked at together lies together.
void Neighbours::look_up(const CentreField& field, std::vector<std::uint8_t>& open) const {
  const Surfaces s = surfaces_of(field);
  const auto channels = static_cast<std::int64_t>(above_.size()),
             cycles = static_cast<std::int64_t>(field.size()) / channels;
  for (std::int64_t k = 0; k < cycles; ++k)
    for (std::int64_t c = 0; c < channels; ++c) {
      const auto i = static_cast<std::size_t>(k * channels + c);
      if (nothing_below_[static_cast<std::size_t>(c)]) open[i] |= side::below;
      const Above& above = above_[static_cast<std::size_t>(c)];
      if (above.channel < 0) {
        open[i] |= side::above;
        continue;
      }
      const std::int64_t other = k + above.cycles;
      if (const std::int64_t under = k - above.cycles; under < 0 || under >= cycles)
        open[static_cast<std::size_t>(k * channels + above.channel)] |= side::below;
      const bool there = other >= 0 && other < cycles;
      const auto j = static_cast<std::size_t>(there ? other * channels + above.channel : 0);
      if (there && ((s.t_m[i] <= 0 && s.t_m[j] <= 0) || !differ(s, i, j))) continue;
      open[i] |= side::above;
      if (there) open[j] |= side::below;
    }
}

}  // namespace tarmac::sim::lidar
