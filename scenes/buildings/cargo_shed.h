/// A cargo shed with a row of docks under a canopy. Frame: x out of the docks' side, which is the plane x = 0; y along
/// it, 0 in the middle; z up from the ground in front.
#pragma once

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

struct CargoShedSpec {
  double length_m = 54, depth_m = 25, height_m = 13;
  double dock_pitch_m = 7.5, dock_width_m = 4, dock_height_m = 4.4;
  double canopy_height_m = 5.2, canopy_depth_m = 4.5;  ///< clear height; how far it reaches out
  bool with_bumpers = false;                           ///< rubber buffers and a guard post at both sides of each dock
};

void add_cargo_shed(MeshBuilder& b, const CargoShedSpec& spec);
/// Number of docks, and where the middle of dock `k` is along y.
int dock_count(const CargoShedSpec& spec);
double dock_y_m(const CargoShedSpec& spec, int k);

}  // namespace tarmac::scenes
