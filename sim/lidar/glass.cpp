#include "sim/lidar/glass.h"

#include <algorithm>
#include <cmath>

namespace tarmac::sim::lidar {

using Eigen::Vector3d;
using raycast::Hits;
using raycast::Rays;
using raycast::SweepTracer;

namespace {

constexpr double refractive_index = 1.52;
constexpr int max_panes = 3;
// Where a ray goes on behind a pane: single precision finds triangles within a few hundredths of a millimetre here.
constexpr double leave_m = 1e-3;

std::vector<std::uint32_t> tiles_of(std::size_t n) {
  std::vector<std::uint32_t> order((n + SweepTracer::tile - 1) / SweepTracer::tile * SweepTracer::tile,
                                   SweepTracer::no_ray);
  for (std::size_t k = 0; k < n; ++k) order[k] = static_cast<std::uint32_t>(k);
  return order;
}

double of_two_faces(double face) {
  return 2 * face / (1 + face);
}

}  // namespace

PaneShares clear_pane(double cos_incidence) {
  const double c = std::clamp(cos_incidence, 1e-6, 1.0), n = refractive_index;
  const double inside = std::sqrt(1 - (1 - c * c) / (n * n));
  const double s = std::pow((c - n * inside) / (c + n * inside), 2),
               p = std::pow((n * c - inside) / (n * c + inside), 2);
  const double reflected = 0.5 * (of_two_faces(s) + of_two_faces(p));
  return {reflected, 1 - reflected};
}

PaneShares pane_shares(const scenes::Material& material, double cos_incidence) {
  const PaneShares clear = clear_pane(cos_incidence), square = clear_pane(1);
  const double r0 = of_two_faces(material.specular_f0);
  return {r0 + (1 - r0) * (clear.reflected - square.reflected) / square.transmitted,
          material.transmission * clear.transmitted / square.transmitted};
}

void PaneRays::clear() {
  rays.resize(0);
  beam.clear();
  ray.clear();
  weight.clear();
  t_m.clear();
  for (auto* v : {&nx, &ny, &nz}) v->clear();
  material.clear();
}

/// One ray on its way after a pane.
struct Glass::Path {
  Vector3d origin, direction;
  std::int32_t t_ns;
  std::uint32_t beam;
  std::uint16_t ray;
  double power, way_m;  // share of the beam's energy that will be back, and way so far
  int panes;
  bool mirrored;
};

Glass::Glass(const std::vector<scenes::Material>& materials, bool ghosts, const Reflectance& reflectance)
    : materials_(materials), ghosts_(ghosts), reflectance_(reflectance) {
  for (const scenes::Material& m : materials) pane_.push_back(m.transmission > 0 ? 1 : 0);
}

ReturnKind Glass::own_kind(std::uint16_t material, float signal, float cos_incidence) const {
  const double dirt = materials_[material].diffuse * static_cast<double>(cos_incidence);
  return static_cast<double>(signal) > 2 * dirt ? ReturnKind::glint : ReturnKind::dirt;
}

std::size_t Glass::follow(const SweepTracer& tracer, const PaneRays& first, std::vector<PartOfBeam>& parts) const {
  std::vector<Path> paths;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Rays& r = first.rays;
    const Vector3d o(r.ox[i], r.oy[i], r.oz[i]), d(r.dx[i], r.dy[i], r.dz[i]), n(first.nx[i], first.ny[i], first.nz[i]);
    const Vector3d met = o + first.t_m[i] * d;
    const double cosine = -n.dot(d);
    const PaneShares shares = pane_shares(materials_[first.material[i]], cosine);
    const Path through{met + leave_m * d,
                       d,
                       r.t_ns[i],
                       first.beam[i],
                       first.ray[i],
                       first.weight[i] * shares.transmitted * shares.transmitted,
                       first.t_m[i] + leave_m,
                       1,
                       false};
    paths.push_back(through);
    if (!ghosts_) continue;
    const Vector3d off = (d + 2 * cosine * n).normalized();
    paths.push_back({met + leave_m * off, off, r.t_ns[i], first.beam[i], first.ray[i],
                     first.weight[i] * shares.reflected * shares.reflected, first.t_m[i] + leave_m, 1, true});
  }
  std::size_t traced = 0;
  while (!paths.empty()) {
    traced += paths.size();
    meet(tracer, paths, parts);
  }
  return traced;
}

/// One step on all paths; those that met a pane and go on are left in `paths`.
void Glass::meet(const SweepTracer& tracer, std::vector<Path>& paths, std::vector<PartOfBeam>& parts) const {
  Rays rays;
  rays.resize(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Path& p = paths[i];
    rays.ox[i] = p.origin.x(), rays.oy[i] = p.origin.y(), rays.oz[i] = p.origin.z();
    rays.dx[i] = p.direction.x(), rays.dy[i] = p.direction.y(), rays.dz[i] = p.direction.z();
    rays.t_ns[i] = p.t_ns;
  }
  Hits hits;
  tracer.trace(rays, tiles_of(rays.size()), hits);
  std::vector<float> signal(hits.size());
  reflectance_.signals(hits.size(), hits.material.data(), hits.cos_incidence.data(), signal.data());
  std::vector<Path> on;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (hits.instance[i] == Hits::nothing) continue;
    const Path& p = paths[i];
    const bool pane = is_pane(hits.material[i]);
    const ReturnKind kind = p.mirrored ? ReturnKind::ghost
                            : pane     ? own_kind(hits.material[i], signal[i], hits.cos_incidence[i])
                                       : ReturnKind::transmitted;
    Part part{.t_m = p.way_m + hits.t_m[i],
              .signal = static_cast<float>(p.power) * signal[i],
              .cos_incidence = hits.cos_incidence[i],
              .plane_m = static_cast<float>((p.way_m + hits.t_m[i]) * static_cast<double>(hits.cos_incidence[i])),
              .nx = hits.nx[i],
              .ny = hits.ny[i],
              .nz = hits.nz[i],
              .instance = hits.instance[i],
              .ray = p.ray,
              .kind = kind};
    parts.push_back({p.beam, part});
    if (!pane || p.mirrored || p.panes == max_panes) continue;
    const double through =
        pane_shares(materials_[hits.material[i]], static_cast<double>(hits.cos_incidence[i])).transmitted;
    const double step_m = hits.t_m[i] + leave_m;
    on.push_back({p.origin + step_m * p.direction, p.direction, p.t_ns, p.beam, p.ray, p.power * through * through,
                  p.way_m + step_m, p.panes + 1, false});
  }
  paths = std::move(on);
}

std::vector<scenes::Material> seen_by_a_beam(std::vector<scenes::Material> materials, double divergence_rad,
                                             double flatness_rad) {
  for (scenes::Material& m : materials)
    if (m.transmission > 0 && m.ggx_alpha > 0)
      m.ggx_alpha =
          std::sqrt(m.ggx_alpha * m.ggx_alpha + divergence_rad * divergence_rad / 4 + flatness_rad * flatness_rad);
  return materials;
}

}  // namespace tarmac::sim::lidar
