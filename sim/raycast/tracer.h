/// Rays against a scene whose actors move: the nearest hit of each ray at the ray's own time.
///
/// Embree finds which triangle a ray meets (single precision, packets of 16); where on it is computed again in double
/// from the triangle and the exact pose of what carries it, so that the range neither loses digits nor depends on the
/// instruction set. Static scenery and actors live in separate scenes that are traced one after the other.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/time.h"
#include "scenes/scene.h"

namespace tarmac::sim::raycast {

struct TracerSettings {
  int threads = 1;    ///< for building the acceleration structures
  bool fast = false;  ///< the best instruction set of this machine instead of the pinned AVX2
};

/// Rays as arrays of equal length. Origins [m] are relative to SweepTracer::base(), directions are unit vectors, both
/// along the world's axes.
struct Rays {
  std::vector<double> ox, oy, oz, dx, dy, dz;
  std::vector<std::int32_t> t_ns;  ///< firing time from the sweep's begin
  std::size_t size() const { return t_ns.size(); }
  void resize(std::size_t n);
};

/// What each ray met, in the order of the rays.
struct Hits {
  static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();
  std::vector<double> t_m;              ///< distance along the ray, relief included; infinity where nothing was met
  std::vector<float> relief_m;          ///< how much of t_m is the relief's: the macro surface is at t_m - relief_m
  std::vector<float> nx, ny, nz;        ///< unit normal of the macro surface in the world, turned towards the sensor
  std::vector<float> cos_incidence;     ///< of the ray with the surface's normal, relief included; in (0, 1]
  std::vector<std::uint32_t> instance;  ///< index into Scene::instances; `nothing` where nothing was met
  std::vector<std::uint16_t> material;  ///< index into Scene::materials
  std::size_t size() const { return t_m.size(); }
  void resize(std::size_t n);
};

/// Rays packed as Embree takes them, for timing Embree alone: the same tiles, scenes and misses as SweepTracer::trace.
/// Lives no longer than the SweepTracer that packed it.
class PackedTiles {
 public:
  PackedTiles(PackedTiles&&) noexcept;
  PackedTiles& operator=(PackedTiles&&) noexcept;
  ~PackedTiles();
  std::size_t rays() const;
  /// Forgets the hits; needed before every intersect().
  void reset();
  void intersect();
  /// How many rays met something in the last intersect().
  std::size_t hits() const;

 private:
  friend class SweepTracer;
  PackedTiles();
  struct State;
  std::unique_ptr<State> state_;
};

/// Traces the rays of one sweep. Cheap to make, one a sweep; const and usable by one thread at a time.
class SweepTracer {
 public:
  static constexpr std::uint32_t no_ray = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t tile = 16;  ///< rays that are traced at once

  SweepTracer(SweepTracer&&) noexcept;
  SweepTracer& operator=(SweepTracer&&) noexcept;
  ~SweepTracer();

  /// Where rays' origins count from [m, world].
  const Eigen::Vector3d& base() const;
  /// Traces rays tile by tile: `order` holds tiles of 16 indices into `rays`, neighbours in direction together (that is
  /// what makes packets fast); `no_ray` fills up a tile. Rays that `order` leaves out meet nothing.
  void trace(const Rays& rays, std::span<const std::uint32_t> order, Hits& hits) const;
  /// The rays of trace(), packed.
  PackedTiles pack(const Rays& rays, std::span<const std::uint32_t> order) const;
  /// How many actors are near enough to be met.
  std::size_t actors_in_range() const;

 private:
  friend class Tracer;
  SweepTracer();
  struct State;
  std::unique_ptr<State> state_;
};

class Tracer {
 public:
  /// Throws InputError when the processor lacks AVX2 and `fast` is not set, or when the scene refers to what it has
  /// not.
  Tracer(std::shared_ptr<const scenes::Scene> scene, const TracerSettings& settings);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Instruction set in use: "avx2", with `fast` also "avx512" or "sse4.2".
  const std::string& isa() const;
  /// For rays fired in [begin, end] from within a few metres of `origin_world`, of which nothing farther than `reach_m`
  /// matters. May be called from several threads. Throws InputError when an actor jerks beyond what 129 motion steps
  /// resolve.
  SweepTracer sweep(core::Time begin, core::Time end, const Eigen::Vector3d& origin_world, double reach_m) const;

 private:
  friend class SweepTracer;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarmac::sim::raycast
