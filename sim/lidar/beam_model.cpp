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
// Outer rays are traced in portions of a fixed size: which rays share a packet may decide a tie between two triangles.
constexpr std::size_t split_rays = 1024;
constexpr float settled_on_relief_m = 0.001f;  // of outer rays: see ReliefBatch
// So near to the centre's plane a ray is on it: half as far as two parts are from each other where they are one echo.
constexpr float one_plane_m = 0.025f;
constexpr float one_normal = 0.996f;  // cosine of 5 degrees

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

/// Of the rays that are on no open side.
TARMAC_VECTOR_LOOP void add_to_mean(std::size_t count, float weight, int sides, const std::uint8_t* __restrict open,
                                    const float* __restrict signal, const double* __restrict t_m,
                                    double* __restrict sum, double* __restrict moment) {
  for (std::size_t i = 0; i < count; ++i) {
    const float counts = (open[i] & sides) != 0 ? 0.0f : weight;
    const double s = static_cast<double>(counts * signal[i]);
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

/// Of the macro surface that a ray met, from its origin.
float plane_distance_m(const Hits& h, const Rays& rays, std::size_t j) {
  const double facing = -(static_cast<double>(h.nx[j]) * rays.dx[j] + static_cast<double>(h.ny[j]) * rays.dy[j] +
                          static_cast<double>(h.nz[j]) * rays.dz[j]);
  return static_cast<float>((h.t_m[j] - static_cast<double>(h.relief_m[j])) * facing);
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
      channels_(firing.channels()),
      split_cycles_(std::max<std::size_t>(1, split_rays / (SweepTracer::tile * firing.channels())) *
                    SweepTracer::tile) {
  for (const scenes::Material& m : scene_->materials) {
    relief_material_.push_back(scene_->relief && m.has_relief);
    pane_material_.push_back(options.glass && m.transmission > 0);
  }
  if (!firing.beams_change())
    for (std::size_t k = 0; k < footprint_.around(); ++k) outer_.push_back(footprint_.table(aim.beams(), k));
  for (std::size_t k = 0; k < footprint_.around(); ++k) sides_.push_back(footprint_.sides(k));
  if (adaptive_) neighbours_.set(beams_above(firing, aim.beams()));
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
  // A beam that is a line has no outer rays, and no sides.
  if (footprint_.around() == 0) {
    w.open.resize(w.centre.size());
    for (std::size_t i = 0; i < w.open.size(); ++i) w.open[i] = pane_material_[w.centre.material[i]];
  } else if (adaptive_) {
    neighbours_.look(w.centre, pane_material_, w.open);
  } else {
    w.open.assign(w.centre.size(), side::all);
  }
  for_batches(split_cycles_, [&](std::size_t first) {
    w.blocked.assign(w.rays.size(), 0);
    if (body_) meet_own_body(firing, aim, span, motion, static_cast<std::int64_t>(first), first * channels, w);
    find_split(first * channels, w);
    place_outer(aim, first * channels, tracer.base(), w);
    put_whole(first * channels, w);
    add_split(tracer, first * channels, w, trace_cpu_s);
  });
  if (options_.halo) add_halos(w);
  std::stable_sort(w.echoes.others.begin(), w.echoes.others.end(),
                   [](const auto& a, const auto& b) { return a.firing < b.firing; });
}

/// Beams that have an open side. Channel by channel: edges are long and mostly level, and rays that follow one look the
/// same way.
void BeamModel::find_split(std::size_t first, BeamWorkspace& w) const {
  w.split.clear();
  for (std::size_t channel = 0; channel < channels_; ++channel)
    for (std::size_t i = channel; i < w.rays.size(); i += channels_)
      if (w.open[first + i] && !w.blocked[i]) w.split.push_back(static_cast<std::uint32_t>(i));
}

/// Lists of the beams that ask for more than a plane, and room for what is traced: beam after beam, for the rays of one
/// look the same way.
void BeamModel::prepare_outer(std::size_t first, BeamWorkspace& w) const {
  const CentreField& c = w.centre;
  w.rough.clear();
  for (std::size_t i = 0; i < w.rays.size() && footprint_.around() > 0; ++i) {
    const std::size_t f = first + i;
    if (scene_->relief && c.t_m[f] > 0 && relief_material_[c.material[f]])
      w.rough.push_back(static_cast<std::uint32_t>(i));
  }
  w.first_channel = channels_;
  w.last_channel = 0;
  for (std::size_t i = 0; i < w.rays.size(); i += channels_)
    for (std::size_t channel = 0; channel < channels_; ++channel)
      if (c.t_m[first + i + channel] > 0) {
        w.first_channel = std::min(w.first_channel, channel);
        w.last_channel = std::max(w.last_channel, channel + 1);
      }
  std::uint32_t traced = 0;
  w.outer_end.clear();
  for (const std::uint32_t i : w.split) {
    w.outer_end.push_back(traced);  // queue_outer() moves it on
    for (const std::uint8_t sides : sides_) traced += (w.open[first + i] & sides) != 0;
    w.split_beams += traced != w.outer_end.back();
  }
  w.outer.resize(traced);
  w.outer_ray.resize(traced);
}

/// Calls work(first beam, count) for the channels of every cycle that have met something: the sky needs no work.
template <class Work>
void BeamModel::for_met(const BeamWorkspace& w, const Work& work) const {
  if (w.first_channel >= w.last_channel) return;
  for (std::size_t i = 0; i < w.rays.size(); i += channels_)
    work(i + w.first_channel, w.last_channel - w.first_channel);
}

/// The outer rays, one of the footprint after the other over all beams: on the plane that their centre met, with its
/// relief, without tracing; or, on an open side, noted for tracing.
void BeamModel::place_outer(const Aim& aim, std::size_t first, const Vector3d& base, BeamWorkspace& w) const {
  const std::size_t n = w.rays.size(), around = footprint_.around();
  const CentreField& c = w.centre;
  for (auto* v : {&w.moment, &w.sum, &w.dx, &w.dy, &w.dz}) v->resize(n);
  w.t_m.resize(around * n);
  w.cosine.resize(around * n);
  w.signal.resize((around + 1) * n);
  prepare_outer(first, w);
  reflectance_.signals(n, &c.material[first], &c.cos_incidence[first], w.signal.data());
  begin_mean(n, static_cast<float>(footprint_.weight()[0]), w.signal.data(), &c.t_m[first], w.sum.data(),
             w.moment.data());
  for (std::size_t k = 0; k < around; ++k) {
    double* t_m = &w.t_m[k * n];
    float *cosine = &w.cosine[k * n], *signal = &w.signal[(k + 1) * n];
    point_outer(aim, k, w);
    for_met(w, [&](std::size_t i, std::size_t count) {
      const std::size_t f = first + i;
      meet_plane(count, &c.t_m[f], &c.relief_m[f], &c.nx[f], &c.ny[f], &c.nz[f], &w.rays.dx[i], &w.rays.dy[i],
                 &w.rays.dz[i], &w.dx[i], &w.dy[i], &w.dz[i], t_m + i, cosine + i);
    });
    if (!w.rough.empty()) meet_relief(k, first, base, w);
    for_met(w, [&](std::size_t i, std::size_t count) {
      reflectance_.signals(count, &c.material[first + i], cosine + i, signal + i);
      add_to_mean(count, static_cast<float>(footprint_.weight()[k + 1]), sides_[k], &w.open[first + i], signal + i,
                  t_m + i, &w.sum[i], &w.moment[i]);
    });
    queue_outer(k, first, w);
  }
}

void BeamModel::point_outer(const Aim& aim, std::size_t k, BeamWorkspace& w) const {
  if (outer_.empty())
    aim.directions(w.aimed, footprint_.table(w.aimed.own, k), w.dx.data(), w.dy.data(), w.dz.data());
  else
    aim.directions(w.aimed, outer_[k], w.dx.data(), w.dy.data(), w.dz.data());
}

void BeamModel::meet_relief(std::size_t k, std::size_t first, const Vector3d& base, BeamWorkspace& w) const {
  const CentreField& c = w.centre;
  double* t_m = &w.t_m[k * w.rays.size()];
  float* cosine = &w.cosine[k * w.rays.size()];
  w.on_relief.clear();
  w.relief.clear();
  w.relief.reserve(w.rays.size());
  for (const std::uint32_t i : w.rough) {
    const std::size_t f = first + i;
    const double nd = -static_cast<double>(cosine[i]);
    if ((w.open[f] & sides_[k]) != 0 || !raycast::ReliefBatch::applies(nd)) continue;
    w.relief.push_back(base.x() + w.rays.ox[i] + t_m[i] * w.dx[i], base.y() + w.rays.oy[i] + t_m[i] * w.dy[i],
                       static_cast<float>(w.dx[i]), static_cast<float>(w.dy[i]), c.nx[f], c.ny[f], c.nz[f],
                       static_cast<float>(nd));
    w.on_relief.push_back(i);
  }
  w.relief.solve(*scene_->relief, settled_on_relief_m);
  for (std::size_t r = 0; r < w.on_relief.size(); ++r) {
    const std::uint32_t i = w.on_relief[r];
    t_m[i] += static_cast<double>(w.relief.s_m()[r]);
    cosine[i] = w.relief.cos_incidence()[r];
  }
}

/// The k-th rays of beams for which that is on an open side are to be traced.
void BeamModel::queue_outer(std::size_t k, std::size_t first, BeamWorkspace& w) const {
  for (std::size_t b = 0; b < w.split.size(); ++b) {
    const std::size_t i = w.split[b];
    if ((w.open[first + i] & sides_[k]) == 0) continue;
    const std::size_t j = w.outer_end[b]++;
    copy_ray(w.rays, i, w.outer, j);
    w.outer.dx[j] = w.dx[i], w.outer.dy[j] = w.dy[i], w.outer.dz[j] = w.dz[i];
    w.outer_ray[j] = static_cast<std::uint16_t>(k + 1);
  }
}

/// One echo of the surface that the centre ray met.
void BeamModel::put_mean(std::size_t f, double sum, double moment, BeamWorkspace& w) const {
  const CentreField& c = w.centre;
  const bool mean = footprint_.around() > 0 && sum > 0;
  w.echoes.put(f, {mean ? moment / sum : c.t_m[f], static_cast<float>(sum), c.cos_incidence[f], c.nx[f], c.ny[f],
                   c.nz[f], c.instance[f], ReturnKind::surface});
}

/// Beams without an open side.
void BeamModel::put_whole(std::size_t first, BeamWorkspace& w) const {
  for (std::size_t i = 0; i < w.rays.size(); ++i)
    if (!w.open[first + i] && !w.blocked[i] && w.centre.t_m[first + i] > 0)
      put_mean(first + i, w.sum[i], w.moment[i], w);
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

/// Beams with an open side: their rays on that side traced, and where those met something else, their parts told apart.
void BeamModel::add_split(const SweepTracer& tracer, std::size_t first, BeamWorkspace& w, double& trace_cpu_s) const {
  w.mixed.clear();
  w.panes.clear();
  if (w.outer.size() > 0) trace_outer(tracer, w, trace_cpu_s);
  for (std::size_t b = 0, begin = 0; b < w.split.size(); begin = w.outer_end[b++])
    if (!put_if_one(w.split[b], begin, w.outer_end[b], first, w))
      add_parts(w.split[b], begin, w.outer_end[b], first, w);
  if (w.panes.size() > 0) {
    w.found.clear();
    const double before_s = thread_cpu_s();
    w.traced_rays += glass_.follow(tracer, w.panes, w.found);
    trace_cpu_s += thread_cpu_s() - before_s;
    for (const PartOfBeam& found : w.found) w.parts[found.beam].push_back(found.part);
  }
  for (std::size_t m = 0; m < w.mixed.size(); ++m) {
    if (w.parts[m].empty()) continue;
    tell_apart(w.parts[m], separation_m_, w.train);
    put_strongest(first + w.mixed[m], w);
  }
}

void BeamModel::trace_outer(const SweepTracer& tracer, BeamWorkspace& w, double& trace_cpu_s) const {
  const std::size_t count = w.outer.size();
  pad_to_tiles(count, w.order);
  const double before_s = thread_cpu_s();
  tracer.trace(w.outer, w.order, w.hits);
  trace_cpu_s += thread_cpu_s() - before_s;
  w.traced_rays += count;
  for (std::size_t j = 0; j < count; ++j)
    if (w.hits.instance[j] == Hits::nothing) w.hits.material[j] = 0;
  w.outer_signal.resize(count);
  reflectance_.signals(count, w.hits.material.data(), w.hits.cos_incidence.data(), w.outer_signal.data());
}

/// Whether all rays of a beam met the plane that its centre ray met, or nothing as that did: then they are one echo, or
/// none, as tell_apart() would have it. outer[begin, end) are those that were traced.
bool BeamModel::put_if_one(std::size_t i, std::size_t begin, std::size_t end, std::size_t first,
                           BeamWorkspace& w) const {
  const std::size_t f = first + i;
  const CentreField& c = w.centre;
  const Hits& h = w.hits;
  if (pane_material_[c.material[f]]) return false;
  if (c.t_m[f] <= 0)
    return std::all_of(h.instance.data() + begin, h.instance.data() + end, [](auto id) { return id == Hits::nothing; });
  const auto plane_m =
      static_cast<float>((c.t_m[f] - static_cast<double>(c.relief_m[f])) * static_cast<double>(c.facing[f]));
  double sum = w.sum[i], moment = w.moment[i];
  for (std::size_t j = begin; j < end; ++j) {
    const float along = c.nx[f] * h.nx[j] + c.ny[f] * h.ny[j] + c.nz[f] * h.nz[j];
    const float off_m = plane_distance_m(h, w.outer, j) - plane_m;
    if (h.instance[j] != c.instance[f] || !(std::abs(off_m) < one_plane_m) || along < one_normal ||
        pane_material_[h.material[j]])
      return false;
    const double s = footprint_.weight()[w.outer_ray[j]] * static_cast<double>(w.outer_signal[j]);
    sum += s;
    moment += s * h.t_m[j];
  }
  put_mean(f, sum, moment, w);
  return true;
}

/// A beam's parts: of the centre ray, of those on its plane, of those that were traced.
void BeamModel::add_parts(std::size_t i, std::size_t begin, std::size_t end, std::size_t first,
                          BeamWorkspace& w) const {
  const std::size_t f = first + i, n = w.rays.size(), beam = w.mixed.size();
  const CentreField& c = w.centre;
  w.mixed.push_back(static_cast<std::uint32_t>(i));
  if (w.parts.size() <= beam) w.parts.emplace_back();
  w.parts[beam].clear();
  if (c.t_m[f] > 0) {
    const double macro_m = c.t_m[f] - static_cast<double>(c.relief_m[f]);
    Part part{c.t_m[f],
              w.signal[i],
              c.cos_incidence[f],
              static_cast<float>(macro_m * static_cast<double>(c.facing[f])),
              c.nx[f],
              c.ny[f],
              c.nz[f],
              c.instance[f],
              0,
              ReturnKind::surface};
    add_part(w, beam, part, c.material[f], w.rays, i);
    for (std::size_t k = 0; k < footprint_.around(); ++k) {
      if ((w.open[f] & sides_[k]) != 0) continue;
      part.ray = static_cast<std::uint16_t>(k + 1);
      part.t_m = w.t_m[k * n + i];
      part.cos_incidence = w.cosine[k * n + i];
      part.signal = w.signal[(k + 1) * n + i] * static_cast<float>(footprint_.weight()[k + 1]);
      w.parts[beam].push_back(part);
    }
  }
  const Hits& h = w.hits;
  for (std::size_t j = begin; j < end; ++j) {
    if (h.instance[j] == Hits::nothing) continue;
    add_part(w, beam,
             {h.t_m[j], w.outer_signal[j], h.cos_incidence[j], plane_distance_m(h, w.outer, j), h.nx[j], h.ny[j],
              h.nz[j], h.instance[j], w.outer_ray[j], ReturnKind::surface},
             h.material[j], w.outer, j);
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

}  // namespace tarmac::sim::lidar
