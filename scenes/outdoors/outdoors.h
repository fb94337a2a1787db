/// What stands beside roads and in the open country, each in its own frame: origin on the ground, x forward (traffic
/// faces -x), z up. Shapes that are drawn take a seed and a number: the same pair gives the same shape.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

enum class CarShape { hatchback, saloon, van };
/// Origin in the middle of the footprint. Hatchback 4.1 x 1.76 x 1.48, saloon 4.6 x 1.82 x 1.46, van 5.3 x 2.0 x 2.25.
void add_car(MeshBuilder& b, CarShape shape, MaterialId paint);

/// Trunk, main branches and a crown of loose leaves (open quads, one cluster of leaves each).
struct TreeShape {
  double height_m = 8, crown_radius_m = 2.2, crown_from_m = 2.8;  ///< the crown begins crown_from_m up
  double trunk_radius_m = 0.16;
  int leaves = 700;
  double leaf_m = 0.24;
  bool conifer = false;  ///< the crown a cone instead of an ellipsoid
};
void add_tree(MeshBuilder& b, const TreeShape& shape, std::uint64_t seed, int number);
/// A lump of about `radius_m`, sunk by a third; closed.
void add_rock(MeshBuilder& b, double radius_m, std::uint64_t seed, int number);

void add_street_lamp(MeshBuilder& b, double height_m, double reach_m);  ///< pole with an arm towards +x
void add_round_sign(MeshBuilder& b);                                    ///< 0.6 disc at 2.2 m, facing -x
/// A panel on two posts, facing -x: `width_m` across y, its lower edge `foot_m` up.
void add_panel_sign(MeshBuilder& b, double width_m, double height_m, double foot_m);
void add_bollard(MeshBuilder& b);     ///< 0.95 tall
void add_litter_bin(MeshBuilder& b);  ///< 0.4 x 0.4 x 1.0
void add_bench(MeshBuilder& b);       ///< 1.8 along y, its back at -x
void add_delineator(MeshBuilder& b);  ///< post of 1.05 with a reflector to -x and to +x
/// W-beam of 0.31 along `rail` (the middle of its height), its face to the left of the line, 0.08 deep; closed.
void add_w_beam(MeshBuilder& b, const std::vector<Eigen::Vector3d>& rail);

}  // namespace tarmac::scenes
