/// How something on wheels stands on the ground.
#pragma once

#include "core/lie.h"
#include "scenes/actors/trailers.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// Where a mesh touches the ground, in the mesh's frame: two points on the rear axle's line, one in the middle in
/// front.
struct Footing {
  double rear_x_m = 0, front_x_m = 0;
  double half_track_m = 0;
  double wheelbase_m() const { return front_x_m - rear_x_m; }
};

/// Read off the mesh: what lies within `thickness_m` of z = 0 are its wheels (or its base).
Footing footing_of(const Mesh& mesh, double thickness_m = 0.02);

/// Pose of a body whose origin is the ground point under the middle of its rear axle (x forward, y left), with both
/// rear points and the middle of its front on the ground: the plane through the three. Function class: that of the
/// ground (C-infinity) as a function of place and heading.
core::SE3 stand_on(const Ground& ground, const Footing& footing, const PlanarPose& rear_axle);

/// Of a sphere around `centre_m` that holds the mesh.
double radius_about(const Mesh& mesh, const Eigen::Vector3d& centre_m);

}  // namespace tarmac::scenes
