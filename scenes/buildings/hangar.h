/// A hangar with sliding doors. Frame: x into the hangar, the door's outer rail at x = 0, y = 0 in the door's middle, z
/// up from the ground in front of the door.
#pragma once

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

struct HangarSpec {
  double width_m = 54, depth_m = 31;  ///< outside
  double eaves_m = 16, ridge_m = 19;  ///< the ridge runs along x
  double door_width_m = 40, door_height_m = 13.5;
  int door_leaves = 8;
  bool open = false;    ///< leaves stacked at both sides of the opening, each on a rail of its own
  bool hollow = false;  ///< for a hangar that is seen from inside: no roof from add_hangar_shell, see add_hangar_roof
  double frame_pitch_m = 8;  ///< of columns and trusses
};

/// Outer walls, doors and, unless hollow, a solid roof.
void add_hangar_shell(MeshBuilder& b, const HangarSpec& spec);
/// Inside, of a hollow one: columns along the walls, posts at the back, rails that carry the cladding.
void add_hangar_columns(MeshBuilder& b, const HangarSpec& spec);
/// Roof of a hollow one: two skins over open gables, and a truss over each pair of columns.
void add_hangar_roof(MeshBuilder& b, const HangarSpec& spec);
/// Free width between the columns [m], and free length between door and wind posts.
double hangar_clear_width_m(const HangarSpec& spec);
double hangar_clear_depth_m(const HangarSpec& spec);

}  // namespace tarmac::scenes
