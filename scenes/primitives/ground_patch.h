/// Meshes that follow a smooth ground.
#pragma once

#include <Eigen/Core>

#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// A rectangle of the ground in cells of at most `cell_m`, `lift_m` above it; faces up. The diagonals alternate, so
/// that no direction of the mesh is preferred.
void add_ground_patch(MeshBuilder& b, const Ground& ground, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                      double cell_m, double lift_m = 0);

/// Height of a curve of that curvature over a chord of `cell_m`: how far facets leave a smooth ground.
inline double sagitta_m(double cell_m, double curvature_per_m) {
  return curvature_per_m * cell_m * cell_m / 8;
}

}  // namespace tarmac::scenes
