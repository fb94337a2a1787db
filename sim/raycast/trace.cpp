// Rays through Embree and what is made of its hits.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/vector_loop.h"
#include "sim/raycast/tracer_state.h"

namespace tarmac::sim::raycast {
namespace {

using Eigen::Vector3d;

constexpr std::size_t tile = SweepTracer::tile;
// Embree's own distance is off by its rounding, divided by the cosine of incidence; a
// recomputed distance that is farther off than this belongs to a triangle seen edge-on, and Embree's is kept.
constexpr double max_correction_m = 0.05;

struct PackedTile {
  RTCRayHit16 packet;
  alignas(64) int valid[tile];
};

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

struct RayArrays {
  const double *ox, *oy, *oz, *dx, *dy, *dz;
};

RayArrays arrays_of(const Rays& rays) {
  return {rays.ox.data(), rays.oy.data(), rays.oz.data(), rays.dx.data(), rays.dy.data(), rays.dz.data()};
}

struct HitArrays {
  double* t_m;
  float *nx, *ny, *nz, *cos_incidence, *nd;
};

TARMAC_VECTOR_LOOP void load_rays(const std::uint32_t* lanes, const RayArrays rays, RTCRay16& ray) {
#pragma GCC ivdep
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const std::uint32_t i = lanes[lane];
    ray.org_x[lane] = static_cast<float>(rays.ox[i]);
    ray.org_y[lane] = static_cast<float>(rays.oy[i]);
    ray.org_z[lane] = static_cast<float>(rays.oz[i]);
    ray.dir_x[lane] = static_cast<float>(rays.dx[i]);
    ray.dir_y[lane] = static_cast<float>(rays.dy[i]);
    ray.dir_z[lane] = static_cast<float>(rays.dz[i]);
  }
}

/// Where each ray meets its plane. `planes` holds x, y, z of the normals and the offsets n'x, in the world; base is
/// where the rays' origins count from.
TARMAC_VECTOR_LOOP void meet_planes(std::size_t count, const RayArrays rays, const double* __restrict base,
                                    const double* __restrict planes, const float* __restrict t_embree_m,
                                    const HitArrays hits) {
  const double bx = base[0], by = base[1], bz = base[2];
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    const double nx = planes[4 * k], ny = planes[4 * k + 1], nz = planes[4 * k + 2], offset = planes[4 * k + 3];
    const double nd = nx * rays.dx[k] + ny * rays.dy[k] + nz * rays.dz[k];
    const double from_plane = offset - (nx * (bx + rays.ox[k]) + ny * (by + rays.oy[k]) + nz * (bz + rays.oz[k]));
    // The comparison is false as well when the plane holds the ray, or when there is none (not a number).
    const double embree = static_cast<double>(t_embree_m[k]), exact = from_plane / nd, off = exact - embree;
    const double size = off < 0 ? -off : off;
    hits.t_m[k] = size < max_correction_m ? exact : embree;
    const float turn = nd > 0 ? -1.0f : 1.0f;
    const float turned = turn * static_cast<float>(nd), cosine = 0.0f - turned;
    hits.nd[k] = turned;
    hits.cos_incidence[k] = cosine > 1 ? 1 : cosine;
    hits.nx[k] = turn * static_cast<float>(nx);
    hits.ny[k] = turn * static_cast<float>(ny);
    hits.nz[k] = turn * static_cast<float>(nz);
  }
}

}  // namespace

void Rays::resize(std::size_t n) {
  for (std::vector<double>* v : {&ox, &oy, &oz, &dx, &dy, &dz}) v->resize(n);
  t_ns.resize(n);
}

void Hits::resize(std::size_t n) {
  t_m.resize(n);
  for (std::vector<float>* v : {&nx, &ny, &nz, &cos_incidence, &relief_m}) v->resize(n);
  instance.resize(n);
  material.resize(n);
}

void TraceScratch::resize(std::size_t rays) {
  triangle.assign(rays, 0);
  t_embree_m.assign(rays, std::numeric_limits<float>::infinity());
  planes.resize(rays);
  nd.resize(rays);
  surface.resize(rays);
  moving.clear();
  relief_rays.clear();
  relief.clear();
  relief.reserve(rays);
}

/// What a part's own scene says of a tile, taken over into the tile: instID tells the part.
static void take_over(const RTCRayHit16& local, const int* valid, std::uint32_t part, RTCRayHit16& packet) {
  for (std::size_t lane = 0; lane < tile; ++lane) {
    if (valid[lane] == 0 || local.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
    packet.ray.tfar[lane] = local.ray.tfar[lane];
    packet.hit.geomID[lane] = 0;
    packet.hit.primID[lane] = local.hit.primID[lane];
    packet.hit.instID[0][lane] = part;
  }
}

void SweepTracer::State::cast_shades(const Rays& rays, Shades& shades) {
  shades.clear();
  if (parts.empty() || rays.size() == 0) return;
  const BatchBounds batch = bounds_of(rays, base);
  // Rays that begin metres apart, behind panes, are never near one place: they must not drop what the others share.
  if (!whereabouts.holds(batch) && batch.radius_m <= Whereabouts::near_m)
    whereabouts = whereabouts_of(parts, batch.centre_m, span_ns);
  raycast::cast_shades(parts, whereabouts, batch, static_cast<double>(reach_m), shades);
}

template <class Meet>
void SweepTracer::State::meet_parts(const Rays& rays, std::span<const std::uint32_t> lanes, Shades& shades,
                                    std::vector<std::uint32_t>& candidates, RTCRayHit16& packet, const int* valid,
                                    const Meet& meet) const {
  candidates_of(packet.ray, valid, shades, candidates);
  if (candidates.empty()) return;
  float farthest = 0;
  for (std::size_t lane = 0; lane < tile; ++lane) farthest = std::max(farthest, packet.ray.tfar[lane]);
  TileView view;
  LaneRays loaded;
  bool has_view = false, has_rays = false;
  RTCRayHit16 local;
  alignas(64) int inside[tile];
  for (const std::uint32_t index : candidates) {
    Shade& shade = shades.all[index];
    if (shade.nearest_m > farthest) continue;
    if (!has_view) view = view_of(packet.ray, valid, rays, lanes.data());
    has_view = true;
    if (!shade.covers(view)) continue;
    if (!has_rays) load_lanes(view, base, rays, lanes.data(), loaded);
    has_rays = true;
    std::copy_n(valid, tile, inside);
    const MovingPart& part = parts[shade.part];
    if (!to_part(part, shade, view, loaded, packet, local, inside)) continue;
    meet(part, local, inside);
    take_over(local, inside, shade.part, packet);
  }
}

void SweepTracer::trace(const Rays& rays, std::span<const std::uint32_t> order, Hits& hits) const {
  State& s = *state_;
  hits.resize(rays.size());
  std::fill(hits.instance.begin(), hits.instance.end(), Hits::nothing);
  std::fill(hits.relief_m.begin(), hits.relief_m.end(), 0.0f);
  s.scratch.resize(rays.size());
  RTCIntersectContext context = coherent_context();
  // A few tiles at a time: packed, traced, kept. One by one, Embree would wait for the packing's stores to land.
  constexpr std::size_t group = 8;
  PackedTile tiles[group];
  for (PackedTile& t : tiles) s.set_up(t.packet);
  s.cast_shades(rays, s.scratch.shades);
  const std::size_t count = order.size() / tile;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t here = std::min(group, count - first);
    for (std::size_t k = 0; k < here; ++k)
      s.load(rays, order.subspan((first + k) * tile, tile), tiles[k].packet, tiles[k].valid);
    for (std::size_t k = 0; k < here; ++k) rtcIntersect16(tiles[k].valid, s.static_scene, &context, &tiles[k].packet);
    // tfar now stands at the static hit: an actor replaces it only where it is nearer.
    if (!s.scratch.shades.empty())
      for (std::size_t k = 0; k < here; ++k)
        s.meet_parts(rays, order.subspan((first + k) * tile, tile), s.scratch.shades, s.scratch.candidates,
                     tiles[k].packet, tiles[k].valid,
                     [&](const MovingPart& part, RTCRayHit16& local, const int* valid) {
                       rtcIntersect16(valid, part.mesh, &context, &local);
                     });
    for (std::size_t k = 0; k < here; ++k) s.keep(order.subspan((first + k) * tile, tile), tiles[k].packet, hits);
  }
  s.finish_static(rays, hits);
  s.finish_moving(rays, hits);
}

/// A tile's rays in the frame of a part that they may meet.
struct PackedPart {
  PackedTile rays;
  std::size_t index = 0;  ///< of its tile in PackedTiles::State::tiles
  std::uint32_t part = 0;
  RTCScene mesh = nullptr;
};

struct PackedTiles::State {
  RTCScene static_scene = nullptr;
  float reach_m = 0;
  std::vector<PackedTile> tiles;
  std::vector<PackedPart> parts;  ///< in the order in which trace() meets them
  std::size_t rays = 0;
};

PackedTiles::PackedTiles() : state_(std::make_unique<State>()) {}
PackedTiles::PackedTiles(PackedTiles&&) noexcept = default;
PackedTiles& PackedTiles::operator=(PackedTiles&&) noexcept = default;
PackedTiles::~PackedTiles() = default;

std::size_t PackedTiles::rays() const {
  return state_->rays;
}

void PackedTiles::reset() {
  const auto forget = [&](PackedTile& t) {
    for (std::size_t lane = 0; lane < SweepTracer::tile; ++lane) {
      t.packet.ray.tfar[lane] = state_->reach_m;
      t.packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      t.packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  };
  for (PackedTile& t : state_->tiles) forget(t);
  for (PackedPart& p : state_->parts) forget(p.rays);
}

void PackedTiles::intersect() {
  RTCIntersectContext context = coherent_context();
  for (PackedTile& t : state_->tiles) rtcIntersect16(t.valid, state_->static_scene, &context, &t.packet);
  for (PackedPart& p : state_->parts) {
    PackedTile& t = state_->tiles[p.index];
    std::copy_n(t.packet.ray.tfar, tile, p.rays.packet.ray.tfar);
    rtcIntersect16(p.rays.valid, p.mesh, &context, &p.rays.packet);
    take_over(p.rays.packet, p.rays.valid, p.part, t.packet);
  }
}

std::size_t PackedTiles::hits() const {
  std::size_t count = 0;
  for (const PackedTile& t : state_->tiles)
    for (std::size_t lane = 0; lane < SweepTracer::tile; ++lane)
      count += t.valid[lane] != 0 && t.packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
  return count;
}

PackedTiles SweepTracer::pack(const Rays& rays, std::span<const std::uint32_t> order) const {
  PackedTiles packed;
  PackedTiles::State& p = *packed.state_;
  p.static_scene = state_->static_scene;
  p.reach_m = state_->reach_m;
  p.tiles.resize(order.size() / tile);
  for (std::size_t k = 0; k < p.tiles.size(); ++k) {
    state_->set_up(p.tiles[k].packet);
    state_->load(rays, order.subspan(k * tile, tile), p.tiles[k].packet, p.tiles[k].valid);
    for (const int valid : p.tiles[k].valid) p.rays += valid != 0;
  }
  Shades shades;
  std::vector<std::uint32_t> candidates;
  state_->cast_shades(rays, shades);
  RTCIntersectContext context = coherent_context();
  for (std::size_t k = 0; k < p.tiles.size() && !shades.empty(); ++k) {
    PackedTile& t = p.tiles[k];
    rtcIntersect16(t.valid, p.static_scene, &context, &t.packet);
    const auto pack_part = [&](const MovingPart& part, RTCRayHit16& local, const int* valid) {
      PackedPart& packed_part = p.parts.emplace_back();
      packed_part.rays.packet = local;
      std::copy_n(valid, tile, packed_part.rays.valid);
      packed_part.index = k;
      packed_part.part = static_cast<std::uint32_t>(&part - state_->parts.data());
      packed_part.mesh = part.mesh;
      rtcIntersect16(valid, part.mesh, &context, &local);
    };
    state_->meet_parts(rays, order.subspan(k * tile, tile), shades, candidates, t.packet, t.valid, pack_part);
  }
  packed.reset();
  return packed;
}

/// What Embree leaves as it is.
void SweepTracer::State::set_up(RTCRayHit16& packet) const {
  std::fill_n(packet.ray.tnear, tile, 0.0f);
  std::fill_n(packet.ray.mask, tile, ~0u);
  std::fill_n(packet.ray.id, tile, 0u);
  std::fill_n(packet.ray.flags, tile, 0u);
}

void SweepTracer::State::load(const Rays& rays, std::span<const std::uint32_t> lanes, RTCRayHit16& packet,
                              int* valid) const {
  const float per_ns = static_cast<float>(1 / span_ns);
  std::uint32_t ray[tile];
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const bool used = lanes[lane] != no_ray;
    valid[lane] = used ? -1 : 0;
    ray[lane] = used ? lanes[lane] : lanes[0];  // a real ray in idle lanes: no stray numbers
    // The last ray of a sweep fires at its end: rounding must not put it beyond.
    packet.ray.time[lane] = std::min(1.0f, static_cast<float>(rays.t_ns[ray[lane]]) * per_ns);
  }
  load_rays(ray, arrays_of(rays), packet.ray);
  std::fill_n(packet.ray.tfar, tile, reach_m);
  std::fill_n(packet.hit.geomID, tile, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(packet.hit.instID[0], tile, RTC_INVALID_GEOMETRY_ID);
}

void SweepTracer::State::keep(std::span<const std::uint32_t> lanes, const RTCRayHit16& packet, Hits& hits) {
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const std::uint32_t i = lanes[lane], id = packet.hit.geomID[lane], triangle = packet.hit.primID[lane];
    if (i == no_ray || id == RTC_INVALID_GEOMETRY_ID) continue;
    const std::uint32_t carried = packet.hit.instID[0][lane];
    if (carried == RTC_INVALID_GEOMETRY_ID) {
      const std::uint32_t row = tracer->still.first[id] + triangle;
      // Wanted when all tiles are traced; fetched while Embree works on the next.
      __builtin_prefetch(&tracer->still.planes[row]);
      __builtin_prefetch(&tracer->still.surface[row]);
      hits.instance[i] = id;
      scratch.triangle[i] = row;
      scratch.t_embree_m[i] = packet.ray.tfar[lane];
    } else {
      scratch.moving.push_back({i, carried, triangle, packet.ray.tfar[lane]});
    }
  }
}

void SweepTracer::State::finish_static(const Rays& rays, Hits& hits) {
  const StaticTriangles& still = tracer->still;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t triangle = scratch.triangle[i], surface = still.surface[triangle];
    scratch.planes[i] = still.planes[triangle];
    scratch.surface[i] = surface;
    hits.material[i] = static_cast<std::uint16_t>(surface);
  }
  static_assert(sizeof(TrianglePlane) == 4 * sizeof(double));
  meet_planes(
      rays.size(), arrays_of(rays), base.data(), scratch.planes.front().normal.data(), scratch.t_embree_m.data(),
      {hits.t_m.data(), hits.nx.data(), hits.ny.data(), hits.nz.data(), hits.cos_incidence.data(), scratch.nd.data()});
  if (!tracer->scene->relief) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if ((scratch.surface[i] & StaticTriangles::relief_bit) == 0 || !ReliefBatch::applies(scratch.nd[i])) continue;
    const double t = hits.t_m[i];
    scratch.relief.push_back(base.x() + rays.ox[i] + t * rays.dx[i], base.y() + rays.oy[i] + t * rays.dy[i],
                             static_cast<float>(rays.dx[i]), static_cast<float>(rays.dy[i]), hits.nx[i], hits.ny[i],
                             hits.nz[i], scratch.nd[i]);
    scratch.relief_rays.push_back(static_cast<std::uint32_t>(i));
  }
  scratch.relief.solve(*tracer->scene->relief);
  for (std::size_t k = 0; k < scratch.relief_rays.size(); ++k) {
    const std::uint32_t i = scratch.relief_rays[k];
    hits.relief_m[i] = scratch.relief.s_m()[k];
    hits.t_m[i] += static_cast<double>(hits.relief_m[i]);
    hits.cos_incidence[i] = scratch.relief.cos_incidence()[k];
  }
}

void SweepTracer::State::finish_moving(const Rays& rays, Hits& hits) {
  const scenes::Scene& scene = *tracer->scene;
  // Neighbours on an actor share their times, column by column: the last few frames serve most of them.
  struct Kept {
    std::uint32_t part = no_ray;
    std::int32_t t_ns = 0;
    Frame T{Eigen::Matrix3d::Identity(), Vector3d::Zero()};
  };
  std::array<Kept, 8> kept;
  std::size_t oldest = 0;
  const auto frame_at = [&](std::uint32_t part, std::int32_t t_ns) -> const Frame& {
    for (const Kept& k : kept)
      if (k.t_ns == t_ns && k.part == part) return k.T;
    Kept& k = kept[oldest++ % kept.size()];
    k = {part, t_ns, parts[part].track.at(t_ns)};
    return k.T;
  };
  for (const TraceScratch::Moving& met : scratch.moving) {
    const std::uint32_t i = met.ray;
    const MovingPart& part = parts[met.part];
    const scenes::Instance& instance = scene.instances[part.instance];
    const Frame& T = frame_at(met.part, rays.t_ns[i]);
    const TrianglePlane& plane = tracer->meshes[instance.mesh].planes[met.triangle];
    const Vector3d o(rays.ox[i], rays.oy[i], rays.oz[i]), d(rays.dx[i], rays.dy[i], rays.dz[i]);
    Vector3d n = T.R * plane.normal;
    double nd = n.dot(d);
    double t = met.t_m;
    const double exact = (plane.offset_m + n.dot(T.p - (base + o))) / nd;
    if (std::abs(exact - t) < max_correction_m) t = exact;  // false as well when the plane holds the ray
    if (nd > 0) {
      n = -n;
      nd = -nd;
    }
    double cosine = -nd;
    const std::uint16_t material = scene.meshes[instance.mesh].materials[met.triangle];
    if (scene.relief && scene.materials[material].has_relief) {
      const ReliefHit relief = meet_relief(*scene.relief, base + o + t * d, d, n, t);
      hits.relief_m[i] = static_cast<float>(relief.t_m - t);
      t = relief.t_m;
      cosine = relief.cos_incidence;
    }
    hits.t_m[i] = t;
    hits.nx[i] = static_cast<float>(n.x());
    hits.ny[i] = static_cast<float>(n.y());
    hits.nz[i] = static_cast<float>(n.z());
    hits.cos_incidence[i] = static_cast<float>(std::min(1.0, cosine));
    hits.instance[i] = part.instance;
    hits.material[i] = material;
  }
}

}  // namespace tarmac::sim::raycast
