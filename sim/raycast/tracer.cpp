#include "sim/raycast/tracer.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "sim/raycast/embree_scenes.h"
#include "sim/raycast/relief.h"
#include "sim/raycast/scene_frames.h"

namespace tarmac::sim::raycast {
namespace {

using core::Duration;
using core::SE3;
using core::Time;
using Eigen::Vector3d;

// Origins are rounded to this grid to find the base. Single precision decides only which triangle is met, within 15
// micrometres at half a cell; a stand or a pier lies in one cell and is built once.
constexpr double base_grid_m = 512;
constexpr int max_motion_steps = 129;  // Embree's limit
// Embree's own distance is off by its rounding and by the motion steps, both divided by the cosine of incidence; a
// recomputed distance that is farther off than this belongs to a triangle seen edge-on, and Embree's is kept.
constexpr double max_correction_m = 0.05;

using Cell = std::array<long, 3>;

Cell cell_of(const Eigen::Vector3d& p) {
  return {std::lround(p.x() / base_grid_m), std::lround(p.y() / base_grid_m), std::lround(p.z() / base_grid_m)};
}

Eigen::Vector3d centre_of(const Cell& cell) {
  return base_grid_m *
         Eigen::Vector3d(static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2]));
}

SE3 relative_to(const Eigen::Vector3d& base, SE3 T_world_mesh) {
  T_world_mesh.translation() -= base;
  return T_world_mesh;
}

std::string choose_isa(bool fast) {
  if (fast && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq"))
    return "avx512";
  if (__builtin_cpu_supports("avx2")) return "avx2";
  if (fast) return "sse4.2";
  throw core::InputError(
      "this processor has no AVX2, which reproducible recordings are pinned to; --fast takes what there is");
}

struct Frame {
  Eigen::Matrix3d R;
  Vector3d p;
};

Frame frame_of(const SE3& T) {
  return {T.linear(), T.translation()};
}

struct MeshData {
  EmbreeScene scene;  // of what actors carry; null for scenery
  std::vector<TrianglePlane> planes;
};

}  // namespace

void Rays::resize(std::size_t n) {
  for (std::vector<double>* v : {&ox, &oy, &oz, &dx, &dy, &dz}) v->resize(n);
  t_ns.resize(n);
}

void Hits::resize(std::size_t n) {
  t_m.resize(n);
  for (std::vector<float>* v : {&nx, &ny, &nz, &cos_incidence}) v->resize(n);
  instance.resize(n);
  material.resize(n);
}

struct Tracer::State {
  std::shared_ptr<const scenes::Scene> scene;
  std::string isa;
  Device device;
  std::vector<MeshData> meshes;
  std::vector<Frame> T_parent_mesh;  // of each instance
  std::mutex mutex;
  std::map<Cell, EmbreeScene> static_scenes;  // built when a sweep first starts in the cell, kept

  RTCScene static_scene(const Cell& cell);
  bool may_meet(const scenes::Actor& actor, Time begin, Time end, const Eigen::Vector3d& origin, double reach_m) const;
};

struct SweepTracer::State {
  Tracer::State* tracer = nullptr;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  Time begin;
  double span_ns = 1;
  float reach_m = 0;
  RTCScene static_scene = nullptr;
  EmbreeScene moving_scene;  // null when no actor is in range
  std::size_t actors = 0;

  using PoseCache = std::unordered_map<std::uint64_t, Frame>;  // by instance and time
  void load(const Rays& rays, std::span<const std::uint32_t> lanes, RTCRayHit16& packet, int* valid) const;
  void finish(const Rays& rays, const RTCRayHit16& packet, std::size_t lane, std::size_t i, PoseCache& poses,
              Hits& hits) const;
  const Frame& T_world_mesh(std::uint32_t id, std::int32_t t_ns, PoseCache& poses) const;
};

RTCScene Tracer::State::static_scene(const Cell& cell) {
  const std::lock_guard lock(mutex);
  EmbreeScene& built = static_scenes[cell];
  if (built) return built.get();
  EmbreeScene whole = empty_scene(device.get());
  const Eigen::Vector3d base = centre_of(cell);
  for (std::size_t i = 0; i < scene->instances.size(); ++i) {
    const scenes::Instance& instance = scene->instances[i];
    if (instance.actor >= 0) continue;
    add_mesh(device.get(), whole.get(), scene->meshes[instance.mesh], relative_to(base, instance.T_parent_mesh),
             static_cast<unsigned>(i));
  }
  commit(whole.get());
  built = std::move(whole);
  return built.get();
}

// An actor stays within the bow of its acceleration around the chord between its first and last position.
bool Tracer::State::may_meet(const scenes::Actor& actor, Time begin, Time end, const Eigen::Vector3d& origin,
                             double reach_m) const {
  const Eigen::Vector3d p0 = actor.motion->T_world_actor(begin).translation();
  const Eigen::Vector3d p1 = actor.motion->T_world_actor(end).translation();
  const double T = core::to_s(end - begin);
  const double bow = actor.motion->acceleration_bound_m_s2(begin, end, actor.radius_m) * T * T / 8;
  const double radius = actor.radius_m + 0.5 * (p1 - p0).norm() + bow;
  return (0.5 * (p0 + p1) - origin).norm() < reach_m + radius;
}

Tracer::Tracer(std::shared_ptr<const scenes::Scene> scene, const TracerSettings& settings)
    : state_(std::make_unique<State>()) {
  check_references(*scene);
  state_->scene = std::move(scene);
  state_->isa = choose_isa(settings.fast);
  state_->device = new_device(fmt::format("isa={},threads={}", state_->isa, std::max(1, settings.threads)));
  for (const scenes::Instance& instance : state_->scene->instances)
    state_->T_parent_mesh.push_back(frame_of(instance.T_parent_mesh));
  std::vector<bool> moves(state_->scene->meshes.size(), false);
  for (const scenes::Instance& instance : state_->scene->instances)
    if (instance.actor >= 0) moves[instance.mesh] = true;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const scenes::Mesh& mesh = state_->scene->meshes[k];
    state_->meshes.push_back({moves[k] ? mesh_scene(state_->device.get(), mesh) : nullptr, planes_of(mesh)});
  }
}

Tracer::~Tracer() = default;

const std::string& Tracer::isa() const {
  return state_->isa;
}

SweepTracer Tracer::sweep(Time begin, Time end, const Eigen::Vector3d& origin_world, double reach_m) const {
  SweepTracer result;
  SweepTracer::State& sweep = *result.state_;
  const Cell cell = cell_of(origin_world);
  sweep.tracer = state_.get();
  sweep.base = centre_of(cell);
  sweep.begin = begin;
  sweep.span_ns = std::max(1.0, static_cast<double>((end - begin).count()));
  sweep.reach_m = static_cast<float>(reach_m);
  sweep.static_scene = state_->static_scene(cell);

  const scenes::Scene& scene = *state_->scene;
  for (std::size_t a = 0; a < scene.actors.size(); ++a) {
    const scenes::Actor& actor = scene.actors[a];
    if (!state_->may_meet(actor, begin, end, origin_world, reach_m)) continue;
    const int steps = motion_steps(actor.motion->acceleration_bound_m_s2(begin, end, actor.radius_m), end - begin);
    if (steps > max_motion_steps)
      throw core::InputError(
          fmt::format("scene {}: actor {} needs {} motion steps in a sweep of {} s; at most {} are "
                      "possible: let it move more smoothly or sweep faster",
                      scene.name, actor.name, steps, core::to_s(end - begin), max_motion_steps));
    std::vector<SE3> T_world_actor;
    for (int k = 0; k < steps; ++k)
      T_world_actor.push_back(actor.motion->T_world_actor(begin + k * (end - begin) / (steps - 1)));
    if (!sweep.moving_scene) sweep.moving_scene = empty_scene(state_->device.get());
    ++sweep.actors;
    std::vector<SE3> poses(T_world_actor.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const scenes::Instance& instance = scene.instances[i];
      if (instance.actor != static_cast<std::int32_t>(a)) continue;
      for (std::size_t k = 0; k < poses.size(); ++k)
        poses[k] = relative_to(sweep.base, T_world_actor[k] * instance.T_parent_mesh);
      add_instance(state_->device.get(), sweep.moving_scene.get(), state_->meshes[instance.mesh].scene.get(),
                   static_cast<unsigned>(i), poses);
    }
  }
  if (sweep.moving_scene) commit(sweep.moving_scene.get());
  return result;
}

SweepTracer::SweepTracer() : state_(std::make_unique<State>()) {}
SweepTracer::SweepTracer(SweepTracer&&) noexcept = default;
SweepTracer& SweepTracer::operator=(SweepTracer&&) noexcept = default;
SweepTracer::~SweepTracer() = default;

const Eigen::Vector3d& SweepTracer::base() const {
  return state_->base;
}
std::size_t SweepTracer::actors_in_range() const {
  return state_->actors;
}

void SweepTracer::trace(const Rays& rays, std::span<const std::uint32_t> order, Hits& hits) const {
  const State& s = *state_;
  hits.resize(rays.size());
  State::PoseCache poses;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit16 packet;
  alignas(64) int valid[tile];
  for (std::size_t first = 0; first + tile <= order.size(); first += tile) {
    const std::span<const std::uint32_t> lanes = order.subspan(first, tile);
    s.load(rays, lanes, packet, valid);
    rtcIntersect16(valid, s.static_scene, &context, &packet);
    // tfar now stands at the static hit: an actor replaces it only where it is nearer.
    if (s.moving_scene) rtcIntersect16(valid, s.moving_scene.get(), &context, &packet);
    for (std::size_t lane = 0; lane < tile; ++lane)
      if (lanes[lane] != no_ray) s.finish(rays, packet, lane, lanes[lane], poses, hits);
  }
}

struct PackedTiles::State {
  struct Tile {
    RTCRayHit16 packet;
    alignas(64) int valid[SweepTracer::tile];
  };
  RTCScene static_scene = nullptr, moving_scene = nullptr;
  float reach_m = 0;
  std::vector<Tile> tiles;
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
  for (State::Tile& t : state_->tiles)
    for (std::size_t lane = 0; lane < SweepTracer::tile; ++lane) {
      t.packet.ray.tfar[lane] = state_->reach_m;
      t.packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      t.packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

void PackedTiles::intersect() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (State::Tile& t : state_->tiles) {
    rtcIntersect16(t.valid, state_->static_scene, &context, &t.packet);
    if (state_->moving_scene) rtcIntersect16(t.valid, state_->moving_scene, &context, &t.packet);
  }
}

std::size_t PackedTiles::hits() const {
  std::size_t count = 0;
  for (const State::Tile& t : state_->tiles)
    for (std::size_t lane = 0; lane < SweepTracer::tile; ++lane)
      count += t.valid[lane] != 0 && t.packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
  return count;
}

PackedTiles SweepTracer::pack(const Rays& rays, std::span<const std::uint32_t> order) const {
  PackedTiles packed;
  PackedTiles::State& p = *packed.state_;
  p.static_scene = state_->static_scene;
  p.moving_scene = state_->moving_scene.get();
  p.reach_m = state_->reach_m;
  p.tiles.resize(order.size() / tile);
  for (std::size_t k = 0; k < p.tiles.size(); ++k) {
    state_->load(rays, order.subspan(k * tile, tile), p.tiles[k].packet, p.tiles[k].valid);
    for (const int valid : p.tiles[k].valid) p.rays += valid != 0;
  }
  return packed;
}

void SweepTracer::State::load(const Rays& rays, std::span<const std::uint32_t> lanes, RTCRayHit16& packet,
                              int* valid) const {
  const float per_ns = static_cast<float>(1 / span_ns);
  for (std::size_t lane = 0; lane < tile; ++lane) {
    const bool used = lanes[lane] != no_ray;
    const std::size_t i = used ? lanes[lane] : lanes[0];  // a real ray in idle lanes: no stray numbers
    valid[lane] = used ? -1 : 0;
    packet.ray.org_x[lane] = static_cast<float>(rays.ox[i]);
    packet.ray.org_y[lane] = static_cast<float>(rays.oy[i]);
    packet.ray.org_z[lane] = static_cast<float>(rays.oz[i]);
    packet.ray.dir_x[lane] = static_cast<float>(rays.dx[i]);
    packet.ray.dir_y[lane] = static_cast<float>(rays.dy[i]);
    packet.ray.dir_z[lane] = static_cast<float>(rays.dz[i]);
    packet.ray.tnear[lane] = 0;
    packet.ray.tfar[lane] = reach_m;
    packet.ray.time[lane] = static_cast<float>(rays.t_ns[i]) * per_ns;
    packet.ray.mask[lane] = ~0u;
    packet.ray.id[lane] = 0;
    packet.ray.flags[lane] = 0;
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

const Frame& SweepTracer::State::T_world_mesh(std::uint32_t id, std::int32_t t_ns, PoseCache& poses) const {
  const scenes::Instance& instance = tracer->scene->instances[id];
  if (instance.actor < 0) return tracer->T_parent_mesh[id];
  const std::uint64_t key = (static_cast<std::uint64_t>(id) << 32) | static_cast<std::uint32_t>(t_ns);
  const auto [entry, is_new] = poses.try_emplace(key);
  if (is_new) {
    const scenes::Actor& actor = tracer->scene->actors[static_cast<std::size_t>(instance.actor)];
    entry->second = frame_of(actor.motion->T_world_actor(begin + Duration(t_ns)) * instance.T_parent_mesh);
  }
  return entry->second;
}

void SweepTracer::State::finish(const Rays& rays, const RTCRayHit16& packet, std::size_t lane, std::size_t i,
                                PoseCache& poses, Hits& hits) const {
  if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
    hits.t_m[i] = std::numeric_limits<double>::infinity();
    hits.instance[i] = Hits::nothing;
    hits.nx[i] = hits.ny[i] = hits.nz[i] = hits.cos_incidence[i] = 0;
    hits.material[i] = 0;
    return;
  }
  const scenes::Scene& scene = *tracer->scene;
  const std::uint32_t actor_instance = packet.hit.instID[0][lane];
  const std::uint32_t id = actor_instance == RTC_INVALID_GEOMETRY_ID ? packet.hit.geomID[lane] : actor_instance;
  const std::uint32_t triangle = packet.hit.primID[lane];
  const scenes::Instance& instance = scene.instances[id];
  const Frame& T = T_world_mesh(id, rays.t_ns[i], poses);
  const TrianglePlane& plane = tracer->meshes[instance.mesh].planes[triangle];

  const Eigen::Vector3d o(rays.ox[i], rays.oy[i], rays.oz[i]), d(rays.dx[i], rays.dy[i], rays.dz[i]);
  Eigen::Vector3d n = T.R * plane.normal;
  double nd = n.dot(d);
  double t = packet.ray.tfar[lane];
  const double exact = (plane.offset_m + n.dot(T.p - (base + o))) / nd;
  if (std::abs(exact - t) < max_correction_m) t = exact;  // false as well when the plane holds the ray (not a number)
  if (nd > 0) {
    n = -n;
    nd = -nd;
  }
  double cosine = -nd;
  const std::uint16_t material = scene.meshes[instance.mesh].materials[triangle];
  if (scene.relief && scene.materials[material].has_relief) {
    const ReliefHit relief = meet_relief(*scene.relief, base + o + t * d, d, n, t);
    t = relief.t_m;
    cosine = relief.cos_incidence;
  }
  hits.t_m[i] = t;
  hits.nx[i] = static_cast<float>(n.x());
  hits.ny[i] = static_cast<float>(n.y());
  hits.nz[i] = static_cast<float>(n.z());
  hits.cos_incidence[i] = static_cast<float>(std::min(1.0, cosine));
  hits.instance[i] = id;
  hits.material[i] = material;
}

}  // namespace tarmac::sim::raycast
