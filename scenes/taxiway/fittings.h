/// What stands along taxiways and runways: lights, signs, drains. Each in its own frame: origin on the ground, z up, x
/// where it faces. Feet reach below the ground, as their concrete bases do.
#pragma once

#include <string>
#include <vector>

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Elevated light, 0.35 m tall, with a lens of the given material.
void add_edge_light(MeshBuilder& b, MaterialId lens);
/// Light set into the pavement, 13 mm proud.
void add_inset_light(MeshBuilder& b, MaterialId lens);
/// Reflecting cylinder, 0.36 m tall.
void add_edge_marker(MeshBuilder& b);
/// Pair of lamps at a runway's holding position, 0.7 m tall.
void add_guard_light(MeshBuilder& b);

enum class SignStyle { location, direction, mandatory };  ///< yellow on black, black on yellow, white on red
struct SignPanel {
  std::string text;  ///< of A-H, R, W, digits, '-', '<', '>'; two or three characters look best
  SignStyle style;
};
/// Panels side by side as read from the front: faces 0.6 m tall, top at 0.9 m; on legs on a concrete base. Faces and
/// characters are retro-reflecting sheeting. Throws std::invalid_argument for a character that has no shape.
void add_sign(MeshBuilder& b, const std::vector<SignPanel>& panels);

void add_papi_unit(MeshBuilder& b);      ///< 0.9 wide, 1.1 long, 0.75 tall
void add_windsock(MeshBuilder& b);       ///< mast of 6 m, sock of 3.6 m
void add_catch_pit(MeshBuilder& b);      ///< concrete frame 1.0 m square with a grating
void add_equipment_hut(MeshBuilder& b);  ///< 4 x 3 x 2.8
void add_stop_sign(MeshBuilder& b);      ///< for roads: disc of 0.6 m at 2 m on a post

}  // namespace tarmac::scenes
