#include <cmath>
#include <numbers>

#include "scenes/buildings/cargo_shed.h"
#include "scenes/buildings/hangar.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using enum MaterialId;

Terminal make_stand_terminal(double z0_m) {
  return make_terminal({.west_m = layout::terminal_west_m,
                        .east_m = layout::terminal_east_m,
                        .facade_y_m = layout::facade_y_m,
                        .back_y_m = layout::terminal_back_y_m,
                        .boarding_floor_m = layout::boarding_floor_z_m,
                        .portals_x_m = {layout::rotunda_x_m},
                        .displays_x_m = {0},
                        .plant_x_m = {-90, -66, -31, -8, 19, 52, 84}},
                       place(0, 0, z0_m));
}

Mesh make_hangar(double z0_m) {
  MeshBuilder b("hangar");
  b.at(place(118, -47, z0_m));
  add_hangar_shell(b, {.width_m = 54, .depth_m = 31});
  return std::move(b).build();
}

Mesh make_cargo_shed(double z0_m) {
  MeshBuilder b("cargo_shed");
  b.at(place(-124, -65, z0_m));
  add_cargo_shed(b, {.length_m = 54, .depth_m = 25});
  return std::move(b).build();
}

Mesh make_blast_fence(const Ground& ground) {
  MeshBuilder b("blast_fence");
  constexpr double west = -72, east = -12, y = -98, bay = 3, height = 3.4;
  constexpr int vanes = 7;
  // Curved away from the aircraft: the profile bends from upright at the foot to 45 degrees at the top.
  const auto profile = [](double s) { return Eigen::Vector2d(-1.6 * s * s, 0.25 + (height - 0.25) * s); };
  for (double x = west; x <= east + 1e-9; x += bay) {
    const double z = ground.height_m(x, y);
    b.use(galvanised_steel);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector2d p = profile(k / 6.0), q = profile((k + 1) / 6.0);
      add_beam(b, {x, y + p.x(), z + p.y()}, {x, y + q.x(), z + q.y() + 0.02}, 0.12, 0.16);
    }
    add_beam(b, {x, y - 2.2, z - 0.1}, {x, y - 0.9, z + 2.45}, 0.12, 0.14);  // strut
    add_box(b, {x - 0.12, y - 2.4, z - 0.4}, {x + 0.12, y + 0.25, z + 0.3});
    if (x + bay > east + 1e-9) break;
    const double z1 = ground.height_m(x + bay, y);
    for (int k = 0; k < vanes; ++k) {
      const Eigen::Vector2d p = profile((k + 0.2) / vanes), q = profile((k + 0.95) / vanes);
      std::vector<Ring> rings;
      for (const auto& [end, ground_z] : {std::pair{x + 0.02, z}, {x + bay - 0.02, z1}}) {
        rings.push_back({{end, y + p.x(), ground_z + p.y()},
                         {end, y + p.x() + 0.05, ground_z + p.y()},
                         {end, y + q.x() + 0.13, ground_z + q.y()},
                         {end, y + q.x() + 0.08, ground_z + q.y()}});
      }
      add_loft(b, rings);
    }
  }
  return std::move(b).build();
}

}  // namespace tarmac::scenes
