/// What moves, during one sweep. Private to sim/raycast.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "sim/raycast/embree_scenes.h"
#include "sim/raycast/pose_track.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::raycast {

/// Axis-aligned, in a mesh's frame.
struct Bounds {
  Eigen::Vector3f low{0, 0, 0}, high{0, 0, 0};
};
Bounds bounds_of(const scenes::Mesh& mesh);

/// An instance that an actor carries.
struct MovingPart {
  std::uint32_t instance = 0;
  RTCScene mesh = nullptr;
  Bounds bounds;
  PoseTrack track;
  double acceleration_m_s2 = 0;  ///< at most, of any of its points
};

/// Rays as a tile has them, and the part of the sky that they look at.
struct TileView {
  double t_first_ns = 0, t_last_ns = 0;
  float angle = 0, angle_low = 0, angle_high = 0;  ///< diamond angle of one ray, and of all relative to it
  float z_low = 0, z_high = 0;                     ///< of the unit directions
};

/// Rows of R, then p, at one time, and what they change by until another: poses of a tile's rays lie in between.
struct TileFrames {
  double t_first_ns = -1, t_last_ns = -1;  ///< of the tile that they were made for; many tiles share their times
  double first[12] = {}, change[12] = {};
};

/// What a part hides from a batch of rays: outside of this no ray meets it.
struct Shade {
  std::uint32_t part = 0;
  float angle = 0, angle_low = 0, angle_high = 0;
  float z_low = 0, z_high = 0;
  float nearest_m = 0;
  bool all_round = false;  ///< the rays start within it or beside it
  std::uint64_t z_bins = 0;
  TileFrames frames;
  bool covers(const TileView& view) const;
};

/// Origins and times of a batch of rays.
struct BatchBounds {
  Eigen::Vector3d centre_m{0, 0, 0};  ///< world
  double radius_m = 0;
  double t_first_ns = 0, t_last_ns = 0;
  std::uint64_t sectors = ~std::uint64_t{0};  ///< that its rays look into
};
/// Of rays whose origins count from `base`.
BatchBounds bounds_of(const Rays& rays, const Eigen::Vector3d& base);

/// Where each part may be seen at all during the sweep, from anywhere near a place: what most batches, which look one
/// way only, need not cast a shade for.
struct Whereabouts {
  static constexpr double near_m = 2;
  Eigen::Vector3d centre_m{0, 0, 0};
  std::vector<std::uint64_t> sectors;  ///< of each part, a bit each; empty = not made yet
  bool holds(const BatchBounds& batch) const {
    return !sectors.empty() && (batch.centre_m - centre_m).norm() + batch.radius_m <= near_m;
  }
};

/// The shades of a batch, by 64 sectors of the plane.
struct Shades {
  static constexpr int sectors = 64;
  std::vector<Shade> all;
  std::array<std::vector<std::uint32_t>, sectors> in_sector;
  std::array<std::uint64_t, sectors> z_bins{};  ///< of all shades of the sector
  std::vector<std::uint32_t> seen_by;           ///< number of the last tile that looked at each
  std::uint32_t tile = 0;
  bool empty() const { return all.empty(); }
  void clear();
};

/// Angle in the plane, 0 to 4 in the sense of atan2, monotone with it and much cheaper; a turn is 4.
float diamond_angle(float x, float y);

Whereabouts whereabouts_of(const std::vector<MovingPart>& parts, const Eigen::Vector3d& centre_m, double span_ns);
/// Those parts that rays of the batch may meet within reach.
void cast_shades(const std::vector<MovingPart>& parts, const Whereabouts& whereabouts, const BatchBounds& batch,
                 double reach_m, Shades& shades);

/// Shades that the rays of a tile may lie in, judged by sectors and bins of height; each once.
void candidates_of(const RTCRay16& packed, const int* valid, Shades& shades, std::vector<std::uint32_t>& candidates);

/// `lanes` are indices into `rays`, `valid` tells which of them count.
TileView view_of(const RTCRay16& packed, const int* valid, const Rays& rays, const std::uint32_t* lanes);

/// Rays of a tile as they are turned into one part's frame after the other.
struct LaneRays {
  alignas(64) double ox[SweepTracer::tile], oy[SweepTracer::tile], oz[SweepTracer::tile];
  alignas(64) double dx[SweepTracer::tile], dy[SweepTracer::tile], dz[SweepTracer::tile];
  alignas(64) double share[SweepTracer::tile];  ///< of the tile's time, 0 at its first ray
};
void load_lanes(const TileView& view, const Eigen::Vector3d& base, const Rays& rays, const std::uint32_t* lanes,
                LaneRays& loaded);

/// Rays in a part's own frame, each at its own time. `valid` is cleared where a ray misses the part's bounds or has met
/// something nearer; returns whether any is left.
bool to_part(const MovingPart& part, Shade& shade, const TileView& view, const LaneRays& rays, const RTCRayHit16& world,
             RTCRayHit16& local, int* valid);

}  // namespace tarmac::sim::raycast
