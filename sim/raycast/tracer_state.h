/// What Tracer and SweepTracer hold. Private to sim/raycast.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "sim/raycast/embree_scenes.h"
#include "sim/raycast/movers.h"
#include "sim/raycast/relief.h"
#include "sim/raycast/scene_frames.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::raycast {

struct MeshData {
  EmbreeScene scene;  // of what actors carry; null for scenery
  Bounds bounds;
  std::vector<TrianglePlane> planes;
};

/// The triangles of everything that stands still, instance after instance, in the world. Entry 0 is no triangle: rays
/// that met nothing, or an actor, stand there, so that loops over rays need not ask.
struct StaticTriangles {
  static constexpr std::uint32_t relief_bit = 1u << 16;
  std::vector<std::uint32_t> first;  ///< of each instance; 0 for what actors carry
  std::vector<TrianglePlane> planes;
  std::vector<std::uint32_t> surface;  ///< material, with relief_bit where the relief applies
};

using Cell = std::array<long, 3>;

struct Tracer::State {
  std::shared_ptr<const scenes::Scene> scene;
  std::string isa;
  Device device;
  std::vector<MeshData> meshes;
  std::vector<Frame> T_parent_mesh;                 // of each instance
  std::vector<std::vector<std::uint32_t>> carried;  // instances of each actor
  StaticTriangles still;
  std::mutex mutex;
  std::map<Cell, EmbreeScene> static_scenes;  // built when a sweep first starts in the cell, kept

  RTCScene static_scene(const Cell& cell);
  std::vector<core::SE3> knots(const scenes::Actor& actor, core::Time begin, core::Time end,
                               const Eigen::Vector3d& origin, double reach_m, double acceleration_m_s2) const;
};

/// One call's arrays, kept between calls.
struct TraceScratch {
  std::vector<std::uint32_t> triangle;  ///< index into StaticTriangles, by ray
  std::vector<float> t_embree_m;
  std::vector<TrianglePlane> planes;   ///< of `triangle`: rows side by side are quicker to walk than gathers
  std::vector<float> nd;               ///< normal times direction, negative
  std::vector<std::uint32_t> surface;  ///< of StaticTriangles
  struct Moving {
    std::uint32_t ray, part, triangle;
    float t_m;
  };
  std::vector<Moving> moving;
  std::vector<std::uint32_t> relief_rays;
  ReliefBatch relief;
  Shades shades;
  std::vector<std::uint32_t> candidates;
  void resize(std::size_t rays);
};

struct SweepTracer::State {
  Tracer::State* tracer = nullptr;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  core::Time begin;
  double span_ns = 1;
  float reach_m = 0;
  RTCScene static_scene = nullptr;
  std::vector<MovingPart> parts;  ///< of actors in range
  Whereabouts whereabouts;        ///< of parts, made by the first rays that need it
  std::size_t actors = 0;
  TraceScratch scratch;

  void set_up(RTCRayHit16& packet) const;
  void load(const Rays& rays, std::span<const std::uint32_t> lanes, RTCRayHit16& packet, int* valid) const;
  void cast_shades(const Rays& rays, Shades& shades);
  /// Calls meet(part, local packet, valid lanes) for every part that a tile's rays may meet, after what stands still
  /// has been met; it puts what it finds into the tile's packet.
  template <class Meet>
  void meet_parts(const Rays& rays, std::span<const std::uint32_t> lanes, Shades& shades,
                  std::vector<std::uint32_t>& candidates, RTCRayHit16& packet, const int* valid,
                  const Meet& meet) const;
  void keep(std::span<const std::uint32_t> lanes, const RTCRayHit16& packet, Hits& hits);
  void finish_static(const Rays& rays, Hits& hits);
  void finish_moving(const Rays& rays, Hits& hits);
};

}  // namespace tarmac::sim::raycast
