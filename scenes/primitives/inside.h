/// Inside or outside of a closed surface.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "scenes/scene.h"

namespace tarmac::scenes {

/// How often the mesh winds around a point of its frame: 1 inside a closed solid whose normals point outward, 2 where
/// two of them overlap, -1 inside a room whose walls face inward, 0 outside. Near an open surface it is in between. The
/// sum of the triangles' solid angles over 4 pi (Van Oosterom and Strackee 1983).
double winding_number(const Mesh& mesh, const Eigen::Vector3d& p);
Eigen::AlignedBox3f bounds_of(const Mesh& mesh);
/// In a solid part of the mesh: a closed surface with outward normals. What stands in a room, a hangar or a cabin is
/// not in its walls.
bool is_inside(const Mesh& mesh, const Eigen::Vector3d& p);

}  // namespace tarmac::scenes
