#include "sim/raycast/tracer.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "sim/raycast/tracer_state.h"

namespace tarmac::sim::raycast {
namespace {

using core::Duration;
using core::SE3;
using core::Time;
using Eigen::Vector3d;

// Origins are rounded to this grid to find the base. Single precision decides only which triangle is met, within 15
// micrometres at half a cell; a stand or a pier lies in one cell and is built once.
constexpr double base_grid_m = 512;
constexpr int max_motion_steps = 129;
constexpr int least_knots = 4;  // a cubic's

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

}  // namespace

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

/// Exact poses at equidistant times over the sweep; one where the actor stands still, none where it is out of reach.
std::vector<SE3> Tracer::State::knots(const scenes::Actor& actor, Time begin, Time end, const Vector3d& origin,
                                      double reach_m, double acceleration_m_s2) const {
  const SE3 first = actor.motion->T_world_actor(begin), last = actor.motion->T_world_actor(end);
  const Vector3d p0 = first.translation(), p1 = last.translation();
  // It stays within the bow of its acceleration around the chord between its first and last position.
  const double T = core::to_s(end - begin), bow = acceleration_m_s2 * T * T / 8;
  const double radius = actor.radius_m + 0.5 * (p1 - p0).norm() + bow;
  if ((0.5 * (p0 + p1) - origin).norm() >= reach_m + radius) return {};
  if (acceleration_m_s2 == 0 && last.matrix() == first.matrix()) return {first};
  const int count = std::max(least_knots, motion_steps(acceleration_m_s2, end - begin));
  if (count > max_motion_steps)
    throw core::InputError(
        fmt::format("{}{}scene {}: actor {} needs {} motion steps in a sweep of {} s; at most {} are possible: let it "
                    "move more smoothly or sweep faster",
                    actor.where, actor.where.empty() ? "" : ": ", scene->name, actor.name, count, T, max_motion_steps));
  std::vector<SE3> poses{first};
  for (int k = 1; k + 1 < count; ++k)
    poses.push_back(actor.motion->T_world_actor(begin + k * (end - begin) / (count - 1)));
  poses.push_back(last);
  return poses;
}

namespace {

StaticTriangles static_triangles(const scenes::Scene& scene, const std::vector<MeshData>& meshes,
                                 const std::vector<Frame>& T_world_mesh) {
  StaticTriangles still;
  still.planes.push_back({Vector3d::Zero(), 0});
  still.surface.push_back(0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scenes::Instance& instance = scene.instances[i];
    still.first.push_back(instance.actor >= 0 ? 0 : static_cast<std::uint32_t>(still.planes.size()));
    if (instance.actor >= 0) continue;
    for (const TrianglePlane& plane : meshes[instance.mesh].planes) {
      const Vector3d normal = T_world_mesh[i].R * plane.normal;
      still.planes.push_back({normal, plane.offset_m + normal.dot(T_world_mesh[i].p)});
    }
    for (const std::uint16_t material : scene.meshes[instance.mesh].materials) {
      const bool relief = scene.relief != nullptr && scene.materials[material].has_relief;
      still.surface.push_back(material | (relief ? StaticTriangles::relief_bit : 0u));
    }
  }
  return still;
}

}  // namespace

Tracer::Tracer(std::shared_ptr<const scenes::Scene> scene, const TracerSettings& settings)
    : state_(std::make_unique<State>()) {
  check_references(*scene);
  state_->scene = std::move(scene);
  state_->isa = choose_isa(settings.fast);
  state_->device = new_device(fmt::format("isa={},threads={}", state_->isa, std::max(1, settings.threads)));
  for (const scenes::Instance& instance : state_->scene->instances)
    state_->T_parent_mesh.push_back(frame_of(instance.T_parent_mesh));
  std::vector<bool> moves(state_->scene->meshes.size(), false);
  state_->carried.resize(state_->scene->actors.size());
  for (std::uint32_t i = 0; i < state_->scene->instances.size(); ++i) {
    const scenes::Instance& instance = state_->scene->instances[i];
    if (instance.actor < 0) continue;
    moves[instance.mesh] = true;
    state_->carried[static_cast<std::size_t>(instance.actor)].push_back(i);
  }
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const scenes::Mesh& mesh = state_->scene->meshes[k];
    state_->meshes.push_back(
        {moves[k] ? mesh_scene(state_->device.get(), mesh) : nullptr, bounds_of(mesh), planes_of(mesh)});
  }
  state_->still = static_triangles(*state_->scene, state_->meshes, state_->T_parent_mesh);
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
    const double acceleration_m_s2 = actor.motion->acceleration_bound_m_s2(begin, end, actor.radius_m);
    const std::vector<SE3> knots = state_->knots(actor, begin, end, origin_world, reach_m, acceleration_m_s2);
    if (knots.empty()) continue;
    ++sweep.actors;
    for (const std::uint32_t i : state_->carried[a]) {
      const scenes::Instance& instance = scene.instances[i];
      std::vector<SE3> T_world_mesh = knots;
      for (SE3& T : T_world_mesh) T = T * instance.T_parent_mesh;
      const MeshData& mesh = state_->meshes[instance.mesh];
      sweep.parts.push_back(
          {i, mesh.scene.get(), mesh.bounds, PoseTrack(T_world_mesh, sweep.span_ns), acceleration_m_s2});
    }
  }
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

}  // namespace tarmac::sim::raycast
