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

/// What a part hides from a batch of rays: outside of this no ray meets it.
struct Shade {
  std::uint32_t part = 0;
  float angle = 0, angle_low = 0, angle_high = 0;
  float z_low = 0, z_high = 0;
  float nearest_m = 0;
  bool all_round = false;  ///< the rays start within it or beside it
  bool covers(const TileView& view) const;
};

/// Angle in the plane, 0 to 4 in the sense of atan2, monotone with it and much cheaper; a turn is 4.
float diamond_angle(float x, float y);

/// Origins and times of a batch of rays.
struct BatchBounds {
  Eigen::Vector3d centre_m{0, 0, 0};  ///< world
  double radius_m = 0;
  double t_first_ns = 0, t_last_ns = 0;
};

/// Those parts that rays of the batch may meet within reach.
void cast_shades(const std::vector<MovingPart>& parts, const BatchBounds& batch, double reach_m,
                 std::vector<Shade>& shades);

/// `lanes` are indices into `rays`, `valid` tells which of them count.
TileView view_of(const RTCRay16& packed, const int* valid, const Rays& rays, const std::uint32_t* lanes);

/// Rays of a tile in a part's own frame, each at its own time. `valid` is cleared where a ray misses the part's bounds
/// or has met something nearer; returns whether any is left.
bool to_part(const MovingPart& part, const TileView& view, const Eigen::Vector3d& base, const Rays& rays,
             const std::uint32_t* lanes, const RTCRayHit16& world, RTCRayHit16& local, int* valid);

}  // namespace tarmac::sim::raycast
