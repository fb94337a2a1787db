/// Town houses in a row. Frame: x along the façade, its face in the plane y = 0, the house at y > 0, z = 0 the
/// sidewalk.
#pragma once

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

inline constexpr double house_depth_m = 10;

/// Houses side by side from x = 0 to `length_m`, each with its own width, storeys and windows; walls and roofs go to
/// `walls`, panes to `glass`. `row` names the draws. Houses reach 1 m into the ground.
void add_house_row(MeshBuilder& walls, MeshBuilder& glass, double length_m, double storeys, int row,
                   std::uint64_t seed);

}  // namespace tarmac::scenes
