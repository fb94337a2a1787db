#include <cmath>
#include <numbers>

#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using enum MaterialId;

Mesh make_hangar(double z0_m) {
  MeshBuilder b("hangar");
  b.at(place(0, 0, z0_m));
  constexpr double west = 118, east = 149, south = -74, north = -20, eaves = 16, ridge = 19, door_top = 13.5;
  constexpr double door_south = -67, door_north = -27, foot = -1.5;
  b.use(facade_panel);
  add_box(b, {west + 0.8, door_north, foot}, {west + 1.4, north, eaves});
  add_box(b, {west + 0.8, south, foot}, {west + 1.4, door_south, eaves});
  add_box(b, {west + 0.8, door_south, door_top}, {west + 1.4, door_north, eaves});
  for (const double y : {south, north - 0.4}) add_box(b, {west + 1.4, y, foot}, {east, y + 0.4, eaves});
  add_box(b, {east - 0.4, south + 0.4, foot}, {east, north - 0.4, eaves});
  constexpr int leaves = 8;  // sliding leaves on two rails, one in front of the other
  for (int k = 0; k < leaves; ++k) {
    const double width = (door_north - door_south) / leaves, y = door_south + k * width,
                 x = west + (k % 2 == 0 ? 0.0 : 0.35);
    b.use(facade_panel_dark);
    add_box(b, {x, y, 0.05}, {x + 0.25, y + width + 0.2, door_top + 0.2});
    b.use(galvanised_steel);
    for (const double z : {3.0, 6.5, 10.0}) add_box(b, {x - 0.08, y + 0.3, z}, {x, y + width - 0.1, z + 0.2});
  }
  b.use(facade_panel);  // roof: gable over the doors, ridge running east
  const double mid = (south + north) / 2;
  std::vector<Ring> rings;
  for (const double x : {west + 0.3, east + 0.5}) {
    rings.push_back({{x, south - 0.6, eaves},
                     {x, north + 0.6, eaves},
                     {x, north + 0.6, eaves + 0.4},
                     {x, mid, ridge},
                     {x, south - 0.6, eaves + 0.4}});
  }
  add_loft(b, rings);
  b.use(concrete_wall);
  for (double y = south; y <= north; y += 9) add_box(b, {west + 0.5, y - 0.25, foot}, {west + 0.8, y + 0.25, eaves});
  return std::move(b).build();
}

Mesh make_cargo_shed(double z0_m) {
  MeshBuilder b("cargo_shed");
  b.at(place(0, 0, z0_m));
  constexpr double west = -149, east = -124, south = -92, north = -38, top = 13, foot = -1.5;
  b.use(facade_panel);
  add_box(b, {west, south, foot}, {east, north, top});
  b.use(facade_panel_dark);
  add_box(b, {west - 0.3, south - 0.3, top}, {east + 0.3, north + 0.3, top + 0.9});
  add_box(b, {east, south + 2, 5.2}, {east + 4.5, north - 2, 5.6});  // canopy over the docks
  for (double y = south + 4; y + 4 < north; y += 7.5) {
    b.use(galvanised_steel);
    add_frustum(b, {east + 4.2, y - 0.5, foot}, {east + 4.2, y - 0.5, 5.2}, 0.15, 0.15, 14);
    b.use(roller_shutter);
    add_box(b, {east + 0.01, y + 0.8, 0.05}, {east + 0.08, y + 4.8, 4.4});
    b.use(galvanised_steel);
    add_box(b, {east + 0.01, y + 0.55, -0.3}, {east + 0.2, y + 0.8, 4.6});
    add_box(b, {east + 0.01, y + 4.8, -0.3}, {east + 0.2, y + 5.05, 4.6});
  }
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
