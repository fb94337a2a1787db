#include "sim/lidar/beam_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vector_loop.h"
#include "sim/lidar/thread_clock.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using raycast::Hits;
using raycast::Rays;
using raycast::SweepTracer;

constexpr double light_m_per_ns = 0.299792458;
constexpr double halo_within_m = 30;
constexpr float halo_from_signal = 100;
// Outer rays are traced in portions of a fixed size: which rays share a packet may decide a tie between two triangles.
constexpr std::size_t split_rays = 1024;
constexpr std::uint32_t halo_slot = 15;  // beyond what a footprint's rays can make

/// Where outer rays meet the plane that their centre ray met: t n'd = t0 n'd0, for they leave from one point.
TARMAC_VECTOR_LOOP void meet_plane(std::size_t count, const double* __restrict t0_m, const float* __restrict relief_m,
                                   const float* __restrict nx, const float* __restrict ny, const float* __restrict nz,
                                   const double* __restrict dx0, const double* __restrict dy0,
                                   const double* __restrict dz0, const double* __restrict dx,
                                   const double* __restrict dy, const double* __restrict dz, double* __restrict t_m,
                                   float* __restrict cosine) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(nx[i]), y = static_cast<double>(ny[i]), z = static_cast<double>(nz[i]);
    const double nd0 = x * dx0[i] + y * dy0[i] + z * dz0[i], nd = x * dx[i] + y * dy[i] + z * dz[i];
    t_m[i] = (t0_m[i] - static_cast<double>(relief_m[i])) * nd0 / nd;
    const float c = static_cast<float>(-nd);
    cosine[i] = c > 1 ? 1 : c;
  }
}

TARMAC_VECTOR_LOOP void begin_mean(std::size_t count, float weight, const float* __restrict signal,
                                   const double* __restrict t_m, double* __restrict sum, double* __restrict moment) {
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(weight * signal[i]);
    sum[i] = s;
    moment[i] = s * t_m[i];
  }
}

TARMAC_VECTOR_LOOP void add_to_mean(std::size_t count, float weight, const float* __restrict signal,
                                    const double* __restrict t_m, double* __restrict sum, double* __restrict moment) {
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(weight * signal[i]);
    sum[i] += s;
    moment[i] += s * t_m[i];
  }
}

void pad_to_tiles(std::size_t n, std::vector<std::uint32_t>& order) {
  order.assign((n + SweepTracer::tile - 1) / SweepTracer::tile * SweepTracer::tile, SweepTracer::no_ray);
  for (std::size_t k = 0; k < n; ++k) order[k] = static_cast<std::uint32_t>(k);
}

void copy_ray(const Rays& from, std::size_t i, Rays& to, std::size_t j) {
  to.ox[j] = from.ox[i], to.oy[j] = from.oy[i], to.oz[j] = from.oz[i];
  to.dx[j] = from.dx[i], to.dy[j] = from.dy[i], to.dz[j] = from.dz[i];
  to.t_ns[j] = from.t_ns[i];
}

double half_angle_rad(const Profile& p) {
  return p.divergence_mrad.empty() ? 0 : 1e-3 * std::max(p.divergence_mrad[0], p.divergence_mrad[1]);
}

std::vector<scenes::Material> materials_for(const scenes::Scene& scene, const BeamOptions& o, const Profile& p) {
  if (!o.glass) return scene.materials;
  return seen_by_a_beam(scene.materials, half_angle_rad(p), o.pane_flatness_deg * std::numbers::pi / 180);
}

}  // namespace

BeamModel::BeamModel(const Profile& profile, const FiringTable& firing, const Aim& aim, const BeamOptions& options,
                     std::shared_ptr<const OwnBody> body, std::shared_ptr<const scenes::Scene> scene)
    : options_(options),
      footprint_(profile, options.rays),
      adaptive_(options.footprint == "adaptive" && !firing.beams_change()),
      separation_m_(light_m_per_ns * (options.pulse_length_ns > 0 ? options.pulse_length_ns : profile.pulse_length_ns) /
                    2),
      reflectance_(materials_for(*scene, options, profile)),
      glass_(scene->materials, options.ghosts, reflectance_),
      detection_(profile, 0, "strength"),
      body_(std::move(body)),
      scene_(std::move(scene)),
      range_offset_m_(firing.range_offset_m()),
      split_cycles_(std::max<std::size_t>(1, split_rays / (SweepTracer::tile * firing.channels())) *
                    SweepTracer::tile) {
  for (const scenes::Material& m : scene_->materials) {
    relief_material_.push_back(scene_->relief && m.has_relief);
    pane_material_.push_back(options.glass && m.transmission > 0);
  }
  if (!firing.beams_change())
    for (std::size_t k = 0; k < footprint_.around(); ++k) outer_.push_back(footprint_.table(aim.beams(), k));
  std::vector<std::int64_t> cycles;
  std::vector<std::int32_t> channels;
  if (adaptive_)
    for (const Above& above : beams_above(firing, aim.beams())) {
      cycles.push_back(above.cycles);
      channels.push_back(above.channel);
    }
  neighbours_.set(firing.channels(), cycles, channels);
  if (options.halo) beside_ = beams_beside(firing, aim.beams(), profile);
}

void BeamModel::echoes(const FiringTable& firing, const Aim& aim, const SweepSpan& span, const SweepMotion& motion,
                       const SweepTracer& tracer, const Batches& batches, BeamWorkspace& w, double& trace_cpu_s) const {
  const std::size_t channels = firing.channels(), cycles = static_cast<std::size_t>(span.cycles);
  w.centre.resize(cycles * channels);
  w.echoes.resize(cycles * channels);
  w.traced_rays = w.centre.size();
  w.split_beams = 0;
  const auto for_batches = [&](std::size_t size, const auto& work) {
    for (std::size_t first = 0; first < cycles; first += size) {
      aim.cycles(firing, span, motion, static_cast<std::int64_t>(first), std::min(size, cycles - first), tracer.base(),
                 w.aimed);
      aim.rays(firing, w.aimed, w.rays);
      work(first);
    }
  };
  for_batches(batches.cycles, [&](std::size_t first) {
    const double before_s = thread_cpu_s();
    if (w.aimed.cycles.size() == batches.cycles)
      tracer.trace(w.rays, batches.tiles, w.hits);
    else
      tracer.trace(w.rays, firing.tiles(w.aimed.cycles.size()), w.hits);
    trace_cpu_s += thread_cpu_s() - before_s;
    w.centre.keep(first * channels, w.rays, w.hits);
  });
  // A beam that is a line has no outer rays to settle.
  if (footprint_.around() == 0) {
    w.settled.assign(w.centre.size(), 1);
    for (std::size_t i = 0; i < w.settled.size(); ++i) w.settled[i] = !pane_material_[w.centre.material[i]];
  } else if (adaptive_) {
    neighbours_.settle(w.centre, pane_material_, w.settled);
  } else {
    w.settled.assign(w.centre.size(), 0);
  }
  for_batches(split_cycles_, [&](std::size_t first) {
    w.blocked.assign(w.rays.size(), 0);
    if (body_) meet_own_body(firing, aim, span, motion, static_cast<std::int64_t>(first), first * channels, w);
    point_outer(aim, w);
    settle_outer(first * channels, tracer.base(), w);
    const double before_s = thread_cpu_s();
    add_split(tracer, first * channels, w);
    trace_cpu_s += thread_cpu_s() - before_s;
  });
  if (options_.halo) add_halos(w);
  std::stable_sort(w.echoes.others.begin(), w.echoes.others.end(),
                   [](const auto& a, const auto& b) { return a.firing < b.firing; });
}

void BeamModel::point_outer(const Aim& aim, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size();
  for (auto* v : {&w.dx, &w.dy, &w.dz}) v->resize(footprint_.around() * n);
  for (std::size_t k = 0; k < footprint_.around(); ++k) {
    const std::size_t at = k * n;
    if (outer_.empty())
      aim.directions(w.aimed, footprint_.table(w.aimed.own, k), &w.dx[at], &w.dy[at], &w.dz[at]);
    else
      aim.directions(w.aimed, outer_[k], &w.dx[at], &w.dy[at], &w.dz[at]);
  }
}

/// Beams on one plane: their outer rays are put on it, with its relief, without tracing.
void BeamModel::settle_outer(std::size_t first, const Vector3d& base, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size(), around = footprint_.around();
  const CentreField& c = w.centre;
  for (auto* v : {&w.moment, &w.sum}) v->resize(n);
  w.t_m.resize(around * n);
  w.cosine.resize(around * n);
  w.signal.resize(n);
  for (std::size_t k = 0; k < around; ++k)
    meet_plane(n, &c.t_m[first], &c.relief_m[first], &c.nx[first], &c.ny[first], &c.nz[first], w.rays.dx.data(),
               w.rays.dy.data(), w.rays.dz.data(), &w.dx[k * n], &w.dy[k * n], &w.dz[k * n], &w.t_m[k * n],
               &w.cosine[k * n]);
  if (scene_->relief && around > 0) meet_relief(first, base, w);

  reflectance_.signals(n, &c.material[first], &c.cos_incidence[first], w.signal.data());
  begin_mean(n, static_cast<float>(footprint_.weight()[0]), w.signal.data(), &c.t_m[first], w.sum.data(),
             w.moment.data());
  for (std::size_t k = 0; k < around; ++k) {
    reflectance_.signals(n, &c.material[first], &w.cosine[k * n], w.signal.data());
    add_to_mean(n, static_cast<float>(footprint_.weight()[k + 1]), w.signal.data(), &w.t_m[k * n], w.sum.data(),
                w.moment.data());
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t f = first + i;
    if (!w.settled[f] || w.blocked[i] || c.t_m[f] <= 0) continue;
    const bool mean = around > 0 && w.sum[i] > 0;
    w.echoes.put(f, {mean ? w.moment[i] / w.sum[i] : c.t_m[f], static_cast<float>(w.sum[i]), c.cos_incidence[f],
                     c.nx[f], c.ny[f], c.nz[f], c.instance[f], ReturnKind::surface});
  }
}

void BeamModel::meet_relief(std::size_t first, const Vector3d& base, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size();
  const CentreField& c = w.centre;
  w.rough.clear();
  w.relief.clear();
  w.relief.reserve(footprint_.around() * n);
  for (std::size_t k = 0; k < footprint_.around(); ++k)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t f = first + i, at = k * n + i;
      if (!w.settled[f] || !relief_material_[c.material[f]] || c.t_m[f] <= 0) continue;
      const double nd = -static_cast<double>(w.cosine[at]);
      if (!raycast::ReliefBatch::applies(nd)) continue;
      w.relief.push_back(base.x() + w.rays.ox[i] + w.t_m[at] * w.dx[at], base.y() + w.rays.oy[i] + w.t_m[at] * w.dy[at],
                         static_cast<float>(w.dx[at]), static_cast<float>(w.dy[at]), c.nx[f], c.ny[f], c.nz[f],
                         static_cast<float>(nd));
      w.rough.push_back(static_cast<std::uint32_t>(at));
    }
  w.relief.solve(*scene_->relief);
  for (std::size_t k = 0; k < w.rough.size(); ++k) {
    w.t_m[w.rough[k]] += static_cast<double>(w.relief.s_m()[k]);
    w.cosine[w.rough[k]] = w.relief.cos_incidence()[k];
  }
}

void BeamModel::add_part(BeamWorkspace& w, std::size_t beam, Part part, std::uint16_t material, const Rays& rays,
                         std::size_t index) const {
  const double weight = footprint_.weight()[part.ray];
  if (pane_material_[material]) {
    part.kind = glass_.own_kind(material, part.signal, part.cos_incidence);
    const std::size_t at = w.panes.size();
    w.panes.rays.resize(at + 1);
    copy_ray(rays, index, w.panes.rays, at);
    w.panes.beam.push_back(static_cast<std::uint32_t>(beam));
    w.panes.ray.push_back(part.ray);
    w.panes.weight.push_back(weight);
    w.panes.t_m.push_back(part.t_m);
    w.panes.nx.push_back(part.nx);
    w.panes.ny.push_back(part.ny);
    w.panes.nz.push_back(part.nz);
    w.panes.material.push_back(material);
  }
  part.signal *= static_cast<float>(weight);
  w.parts[beam].push_back(part);
}

/// Beams whose outer rays may meet something else than their centre: traced, told apart.
void BeamModel::add_split(const SweepTracer& tracer, std::size_t first, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size(), around = footprint_.around();
  const CentreField& c = w.centre;
  w.split.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (!w.settled[first + i] && !w.blocked[i]) w.split.push_back(static_cast<std::uint32_t>(i));
  if (w.split.empty()) return;
  w.split_beams += w.split.size();
  if (w.parts.size() < w.split.size()) w.parts.resize(w.split.size());
  w.panes.clear();
  reflectance_.signals(n, &c.material[first], &c.cos_incidence[first], w.signal.data());
  for (std::size_t b = 0; b < w.split.size(); ++b) {
    const std::size_t i = w.split[b], f = first + i;
    w.parts[b].clear();
    if (c.t_m[f] <= 0) continue;
    const double macro_m = c.t_m[f] - static_cast<double>(c.relief_m[f]);
    add_part(w, b,
             {c.t_m[f], w.signal[i], c.cos_incidence[f], static_cast<float>(macro_m * static_cast<double>(c.facing[f])),
              c.nx[f], c.ny[f], c.nz[f], c.instance[f], 0, ReturnKind::surface},
             c.material[f], w.rays, i);
  }
  if (around > 0) trace_outer(tracer, w);
  if (w.panes.size() > 0) {
    w.found.clear();
    w.traced_rays += glass_.follow(tracer, w.panes, w.found);
    for (const PartOfBeam& found : w.found) w.parts[found.beam].push_back(found.part);
  }
  for (std::size_t b = 0; b < w.split.size(); ++b) {
    if (w.parts[b].empty()) continue;
    tell_apart(w.parts[b], separation_m_, w.train);
    put_strongest(first + w.split[b], w);
  }
}

void BeamModel::trace_outer(const SweepTracer& tracer, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size(), around = footprint_.around(), count = around * w.split.size();
  Rays& outer = w.outer;
  outer.resize(count);
  for (std::size_t b = 0, j = 0; b < w.split.size(); ++b)
    for (std::size_t k = 0; k < around; ++k, ++j) {
      const std::size_t i = w.split[b], at = k * n + i;
      copy_ray(w.rays, i, outer, j);
      outer.dx[j] = w.dx[at], outer.dy[j] = w.dy[at], outer.dz[j] = w.dz[at];
    }
  pad_to_tiles(count, w.order);
  tracer.trace(outer, w.order, w.hits);
  w.traced_rays += count;
  for (std::size_t j = 0; j < count; ++j)
    if (w.hits.instance[j] == Hits::nothing) w.hits.material[j] = 0;
  w.signal.resize(std::max(w.signal.size(), count));
  reflectance_.signals(count, w.hits.material.data(), w.hits.cos_incidence.data(), w.signal.data());
  const Hits& h = w.hits;
  for (std::size_t j = 0; j < count; ++j) {
    if (h.instance[j] == Hits::nothing) continue;
    const double facing = -(static_cast<double>(h.nx[j]) * outer.dx[j] + static_cast<double>(h.ny[j]) * outer.dy[j] +
                            static_cast<double>(h.nz[j]) * outer.dz[j]);
    add_part(w, j / around,
             {h.t_m[j], w.signal[j], h.cos_incidence[j],
              static_cast<float>((h.t_m[j] - static_cast<double>(h.relief_m[j])) * facing), h.nx[j], h.ny[j], h.nz[j],
              h.instance[j], static_cast<std::uint16_t>(j % around + 1), ReturnKind::surface},
             h.material[j], outer, j);
  }
}

/// The own vehicle ends beams, whatever their other rays might pass.
void BeamModel::meet_own_body(const FiringTable& firing, const Aim& aim, const SweepSpan& span,
                              const SweepMotion& motion, std::int64_t first_cycle, std::size_t first,
                              BeamWorkspace& w) const {
  aim.body_cycles(firing, span, first_cycle, w.aimed.cycles.size(), w.body_aimed);
  aim.rays(firing, w.body_aimed, w.body_rays);
  body_->meet(w.body_rays, w.self);
  for (const OwnBody::Hit& hit : w.self) {
    const std::size_t f = first + hit.ray;
    if (w.centre.t_m[f] > 0 && w.centre.t_m[f] < hit.t_m) continue;
    w.blocked[hit.ray] = 1;
    const core::Time t = w.aimed.cycles[hit.ray / firing.channels()].t;
    const Eigen::Vector3f n =
        (motion.at(t).R_world_body *
         Vector3d(static_cast<double>(hit.nx), static_cast<double>(hit.ny), static_cast<double>(hit.nz)))
            .cast<float>();
    w.echoes.put(f, {hit.t_m, hit.signal, hit.cos_incidence, n.x(), n.y(), n.z(), Hits::nothing, ReturnKind::self});
  }
}

void BeamModel::put_strongest(std::size_t firing, BeamWorkspace& w) const {
  if (w.train.size() == 1) {
    w.echoes.put(firing, w.train.front());
    return;
  }
  const auto strength = [&](const Echo& e) {
    return detection_.snr(static_cast<double>(e.signal), e.t_m + range_offset_m_);
  };
  std::stable_sort(w.train.begin(), w.train.end(),
                   [&](const Echo& a, const Echo& b) { return strength(a) > strength(b); });
  w.echoes.put(firing, w.train.front());
  for (std::size_t k = 1; k < w.train.size(); ++k)
    w.echoes.others.push_back({static_cast<std::uint32_t>(firing), static_cast<std::uint32_t>(k), w.train[k]});
}

/// Very bright targets near by reach the beams beside theirs. A beam keeps what it has as another echo.
void BeamModel::add_halos(BeamWorkspace& w) const {
  const auto channels = static_cast<std::int64_t>(beside_.size()),
             cycles = static_cast<std::int64_t>(w.echoes.size()) / channels;
  std::vector<EchoField::Other> halos;
  for (std::size_t f = 0; f < w.echoes.size(); ++f) {
    const Echo source = w.echoes.at(f);
    if (source.t_m <= 0 || source.t_m > halo_within_m || source.signal < halo_from_signal ||
        source.kind == ReturnKind::self)
      continue;
    const std::int64_t cycle = static_cast<std::int64_t>(f) / channels;
    for (const Beside& beside : beside_[f % beside_.size()]) {
      const std::int64_t other = cycle + beside.cycles;
      if (other < 0 || other >= cycles) continue;
      Echo halo = source;
      halo.signal *= beside.share;
      halo.kind = ReturnKind::retro_halo;
      halos.push_back({static_cast<std::uint32_t>(other * channels + beside.channel), 0, halo});
    }
  }
  merge_halos(halos, w);
}

/// Of several halos the strongest; none where the beam's own echo is so near that the two are one, or where the beam
/// ends on the own vehicle.
void BeamModel::merge_halos(std::vector<EchoField::Other>& halos, BeamWorkspace& w) const {
  std::stable_sort(halos.begin(), halos.end(), [](const auto& a, const auto& b) {
    return a.firing != b.firing ? a.firing < b.firing : a.echo.signal > b.echo.signal;
  });
  EchoField& e = w.echoes;
  for (std::size_t k = 0; k < halos.size(); ++k) {
    EchoField::Other& halo = halos[k];
    const std::uint32_t f = halo.firing;
    if (k > 0 && halos[k - 1].firing == f) continue;
    if (e.t_m[f] <= 0) {
      e.put(f, halo.echo);
      continue;
    }
    if (std::abs(e.t_m[f] - halo.echo.t_m) <= separation_m_ || e.kind[f] == ReturnKind::self) continue;
    const auto strength = [&](double signal, double t_m) { return detection_.snr(signal, t_m + range_offset_m_); };
    halo.slot = halo_slot;
    if (strength(static_cast<double>(halo.echo.signal), halo.echo.t_m) >
        strength(static_cast<double>(e.signal[f]), e.t_m[f])) {
      const Echo own = e.at(f);
      e.put(f, halo.echo);
      halo.echo = own;
    }
    e.others.push_back(halo);
  }
}

}  // namespace tarmac::sim::lidar
