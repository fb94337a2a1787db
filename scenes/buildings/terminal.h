/// The airside front of a terminal or pier: a recessed apron level behind columns, a boarding level of glass, a
/// clerestory and a roof set back behind it, and stair towers. Frame: x along the façade, its outside towards -y, z up
/// from the ground in front of it.
#pragma once

#include <vector>

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

struct TerminalSpec {
  double west_m = -112.5, east_m = 112.5;             ///< whole bays of bay_m
  double facade_y_m = 46.5;                           ///< plane of the boarding level's glass
  double back_y_m = 62;                               ///< at least 9 m behind the façade
  double bay_m = 7.5;                                 ///< columns
  double boarding_floor_m = 5.0;                      ///< above the ground; facts: 4.5 to 5.5
  double top_m = 14.0;                                ///< upper edge of the clerestory
  double high_top_m = 16.5, high_half_length_m = 45;  ///< the higher middle, |x| below that; 0: none
  std::vector<int> tower_bays{3, 10, 17, 24};         ///< stair towers, bays counted from the west
  double roof_overhang_m = 0.5;                       ///< over the back wall
  std::vector<double> portals_x_m{-24};               ///< where fixed walkways enter the boarding level
  std::vector<double> displays_x_m{0};                ///< docking displays over lead-in lines
  std::vector<double> plant_x_m;                      ///< western ends of the plant on the roof
};

/// Walls, columns, slabs and roofs, and apart from them the panes (label glass).
struct Terminal {
  Mesh building, glass;
};
Terminal make_terminal(const TerminalSpec& spec, const core::SE3& T_mesh_terminal);

}  // namespace tarmac::scenes
