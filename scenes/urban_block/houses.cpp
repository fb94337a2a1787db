#include "scenes/urban_block/houses.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double kWall_m = 0.35, kRecess_m = 0.2, kRoom_m = 3.0, kFoot_m = -1.0;
constexpr double kGroundStorey_m = 3.8, kStorey_m = 3.1;

/// One house: its numbers, all drawn.
struct House {
  double x_m, width_m, top_m;
  int storeys, windows;
  double window_width_m, window_height_m, sill_m;
  MaterialId wall;
  bool shop, balconies;
};

struct Builders {
  MeshBuilder &walls, &glass;
};

void add_pane(Builders b, double x0, double x1, double z0, double z1) {
  const double y = kRecess_m;
  add_patch(b.glass, {x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
}

/// Wall with `count` equal openings between z0 and z1, sill and lintel at `sill` and `head`; each holds a pane with a
/// bar in its middle.
void add_windows(Builders b, const House& h, double z0, double z1, double sill, double head, int count, double width) {
  const double left = h.x_m, right = h.x_m + h.width_m, pitch = h.width_m / count;
  b.walls.use(h.wall);
  add_box(b.walls, {left, 0, z0}, {right, kWall_m, sill});
  add_box(b.walls, {left, 0, head}, {right, kWall_m, z1});
  double from = left;
  for (int k = 0; k < count; ++k) {
    const double x0 = left + (k + 0.5) * pitch - width / 2, x1 = x0 + width;
    b.walls.use(h.wall);
    add_box(b.walls, {from, 0, sill}, {x0, kWall_m, head});
    b.walls.use(concrete_wall);
    add_box(b.walls, {x0 - 0.05, -0.06, sill - 0.06}, {x1 + 0.05, 0.0, sill});
    b.walls.use(gse_paint_white);
    add_box(b.walls, {x0 + width / 2 - 0.03, kRecess_m - 0.02, sill}, {x0 + width / 2 + 0.03, kRecess_m + 0.04, head});
    add_pane(b, x0, x0 + width / 2 - 0.03, sill, head);
    add_pane(b, x0 + width / 2 + 0.03, x1, sill, head);
    from = x1;
  }
  b.walls.use(h.wall);
  add_box(b.walls, {from, 0, sill}, {right, kWall_m, head});
}

/// A door in a deep recess, with a step; the rest of the ground storey is a shop's window or windows.
void add_ground_storey(Builders b, const House& h) {
  constexpr double door_m = 1.2, head_m = 2.7, recess_m = 0.5;
  const double door = h.x_m + 0.6, rest = door + door_m + 0.4;
  b.walls.use(h.wall);
  add_box(b.walls, {h.x_m, 0, kFoot_m}, {door, kWall_m, kGroundStorey_m});
  add_box(b.walls, {door, 0, head_m}, {door + door_m, kWall_m, kGroundStorey_m});
  add_box(b.walls, {door + door_m, 0, kFoot_m}, {rest, kWall_m, kGroundStorey_m});
  b.walls.use(wood);
  add_box(b.walls, {door, recess_m, kFoot_m}, {door + door_m, recess_m + 0.06, head_m});
  b.walls.use(concrete_wall);
  add_box(b.walls, {door, 0, kFoot_m}, {door + door_m, recess_m, 0.14});
  add_box(b.walls, {door - 0.12, -0.05, head_m}, {door + door_m + 0.12, 0, head_m + 0.2});
  House part = h;
  part.x_m = rest;
  part.width_m = h.x_m + h.width_m - rest;
  if (h.shop) {
    add_windows(b, part, kFoot_m, kGroundStorey_m, 0.5, 2.9, 1, part.width_m - 0.8);
  } else {
    const int count = std::max(1, static_cast<int>(part.width_m / 2.4));
    add_windows(b, part, kFoot_m, kGroundStorey_m, 1.2, 2.8, count, std::min(1.2, 0.6 * part.width_m / count));
  }
}

void add_balcony(MeshBuilder& b, double x0, double x1, double z) {
  b.use(concrete_wall);
  add_box(b, {x0, -1.1, z - 0.15}, {x1, 0, z});
  b.use(painted_steel);
  for (const double y : {-1.08, -0.06}) {
    for (const double x : {x0 + 0.02, x1 - 0.05}) add_box(b, {x, y, z}, {x + 0.03, y + 0.03, z + 1.0});
  }
  add_box(b, {x0, -1.1, z + 1.0}, {x1, -1.04, z + 1.05});
  for (double x = x0 + 0.2; x < x1 - 0.1; x += 0.25) add_box(b, {x, -1.075, z}, {x + 0.02, -1.055, z + 1.0});
}

/// Rooms: what is seen through the panes. Floors and party walls up to the back of the front rooms, and the solid rest.
void add_inside(MeshBuilder& b, const House& h) {
  const double left = h.x_m, right = h.x_m + h.width_m;
  b.use(interior_wall);
  add_box(b, {left, kRoom_m, kFoot_m}, {right, kRoom_m + 0.1, h.top_m});
  for (const double x : {left, right - 0.15}) add_box(b, {x, kWall_m, kFoot_m}, {x + 0.15, kRoom_m, h.top_m});
  for (int k = 0; k <= h.storeys - 1; ++k) {
    const double z = k == 0 ? 0.1 : kGroundStorey_m + (k - 1) * kStorey_m;
    add_box(b, {left + 0.15, kWall_m, z - 0.25}, {right - 0.15, kRoom_m, z});
  }
  b.use(h.wall);
  add_box(b, {left, kRoom_m + 0.1, kFoot_m}, {right, house_depth_m, h.top_m});
}

/// Eaves along the street, ridge in the middle; gable ends closed.
void add_roof(MeshBuilder& b, const House& h, double rise_m) {
  b.use(concrete_wall);
  add_box(b, {h.x_m, -0.3, h.top_m}, {h.x_m + h.width_m, house_depth_m, h.top_m + 0.25});
  b.use(brick);
  std::vector<Ring> rings;
  for (const double x : {h.x_m, h.x_m + h.width_m}) {
    rings.push_back({{x, -0.25, h.top_m + 0.25},
                     {x, house_depth_m, h.top_m + 0.25},
                     {x, house_depth_m / 2, h.top_m + 0.25 + rise_m}});
  }
  add_loft(b, rings);
}

void add_house(Builders b, const House& h, double rise_m) {
  add_ground_storey(b, h);
  for (int k = 1; k < h.storeys; ++k) {
    const double z = kGroundStorey_m + (k - 1) * kStorey_m;
    add_windows(b, h, z, z + kStorey_m, z + h.sill_m, z + h.sill_m + h.window_height_m, h.windows, h.window_width_m);
    const double pitch = h.width_m / h.windows, middle = h.x_m + (h.windows / 2 + 0.5) * pitch;
    if (h.balconies) add_balcony(b.walls, middle - 0.9, middle + 0.9, z + 0.05);
  }
  add_inside(b.walls, h);
  add_roof(b.walls, h, rise_m);
}

}  // namespace

void add_house_row(MeshBuilder& walls, MeshBuilder& glass, double length_m, double storeys, int row,
                   std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/urban_block/houses");
  constexpr MaterialId facings[] = {plaster, brick, concrete_wall, plaster};
  glass.use(glass_clear_float_pane);
  double x = 0;
  for (std::uint64_t n = 0; length_m - x > 1; ++n) {
    const auto draw = [&](std::uint32_t j) { return random.uniform((static_cast<std::uint64_t>(row) << 16) + n, j); };
    House h{};
    h.x_m = x;
    h.width_m = 8 + 7 * draw(0);
    if (length_m - x - h.width_m < 8) h.width_m = length_m - x;  // the last one takes what is left
    h.storeys = std::max(2, static_cast<int>(std::floor(storeys - 1 + 3 * draw(1))));
    h.top_m = kGroundStorey_m + (h.storeys - 1) * kStorey_m;
    h.windows = std::max(2, static_cast<int>(h.width_m / (2.1 + 0.8 * draw(2))));
    h.window_width_m = std::min(1.0 + 0.5 * draw(3), 0.6 * h.width_m / h.windows);
    h.window_height_m = 1.4 + 0.5 * draw(4);
    h.sill_m = 0.75 + 0.2 * draw(5);
    h.wall = facings[static_cast<std::size_t>(4 * draw(6))];
    h.shop = draw(7) < 0.4;
    h.balconies = draw(8) < 0.3;
    add_house({walls, glass}, h, 2 + 2 * draw(9));
    x += h.width_m;
  }
}

}  // namespace tarmac::scenes
