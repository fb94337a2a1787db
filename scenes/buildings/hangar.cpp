#include "scenes/buildings/hangar.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double foot_m = -1.5;                        ///< walls begin below the ground
constexpr double front_m = 0.8, wall_m = 0.4;          ///< the front wall stands behind the door's rails
constexpr double column_m = 0.4, column_gap_m = 0.05;  ///< steel columns, and how far they stand from the wall
constexpr double rail_pitch_m = 0.32;                  ///< of the rails of an open door

void add_leaf(MeshBuilder& b, const HangarSpec& s, double x, double y, double width) {
  b.use(facade_panel_dark);
  add_box(b, {x, y, 0.05}, {x + 0.25, y + width + 0.2, s.door_height_m + 0.2});
  b.use(galvanised_steel);
  for (const double z : {3.0, 6.5, 10.0}) add_box(b, {x - 0.08, y + 0.3, z}, {x, y + width - 0.1, z + 0.2});
}

/// Closed: two rails, one in front of the other. Open: half of the leaves stacked at either side.
void add_door(MeshBuilder& b, const HangarSpec& s) {
  const double width = s.door_width_m / s.door_leaves, south = -s.door_width_m / 2;
  for (int k = 0; k < s.door_leaves; ++k) {
    if (!s.open) {
      add_leaf(b, s, k % 2 == 0 ? 0.0 : 0.35, south + k * width, width);
      continue;
    }
    const bool at_south = k < s.door_leaves / 2;
    const int rail = at_south ? k : s.door_leaves - 1 - k;
    add_leaf(b, s, 0.35 - rail_pitch_m * rail, at_south ? south - width - 0.3 : -south + 0.1, width);
  }
}

void add_solid_roof(MeshBuilder& b, const HangarSpec& s) {
  const double half = s.width_m / 2;
  std::vector<Ring> rings;
  for (const double x : {0.3, s.depth_m + 0.5}) {
    rings.push_back({{x, -half - 0.6, s.eaves_m},
                     {x, half + 0.6, s.eaves_m},
                     {x, half + 0.6, s.eaves_m + 0.4},
                     {x, 0, s.ridge_m},
                     {x, -half - 0.6, s.eaves_m + 0.4}});
  }
  add_loft(b, rings);
}

/// Two skins that meet at the ridge, and the triangles of the gables.
void add_hollow_roof(MeshBuilder& b, const HangarSpec& s) {
  const double half = s.width_m / 2, thick = 0.3;
  for (const double side : {-1.0, 1.0}) {
    std::vector<Ring> rings;
    for (const double x : {0.3, s.depth_m + 0.5}) {
      rings.push_back({{x, side * (half + 0.6), s.eaves_m},
                       {x, 0, s.ridge_m - thick},
                       {x, 0, s.ridge_m},
                       {x, side * (half + 0.6), s.eaves_m + thick}});
    }
    add_loft(b, rings);
  }
  for (const double x : {front_m, s.depth_m - wall_m}) {
    Ring near, far;
    for (const auto& [y, z] : {std::pair{-half, s.eaves_m - 0.1}, {half, s.eaves_m - 0.1}, {0.0, s.ridge_m - thick}}) {
      near.emplace_back(x, y, z);
      far.emplace_back(x + wall_m, y, z);
    }
    add_loft(b, {near, far});
  }
}

/// An H section along z or x: web and two flanges.
void add_column(MeshBuilder& b, double x, double y, double top) {
  const double h = column_m / 2;
  add_box(b, {x - h, y - h, -0.1}, {x + h, y - h + 0.03, top});
  add_box(b, {x - h, y + h - 0.03, -0.1}, {x + h, y + h, top});
  add_box(b, {x - 0.02, y - h + 0.03, -0.1}, {x + 0.02, y + h - 0.03, top});
  b.use(concrete_wall);
  add_box(b, {x - 0.35, y - 0.35, -0.3}, {x + 0.35, y + 0.35, 0.25});  // plinth
  b.use(painted_steel);
}

/// Bottom chord at the eaves, top chords under the roof, posts and diagonals between.
void add_truss(MeshBuilder& b, const HangarSpec& s, double x) {
  const double half = hangar_clear_width_m(s) / 2 + column_m, low = s.eaves_m - 0.8;
  const auto top_at = [&](double y) {
    const double rise = (s.ridge_m - 0.3 - s.eaves_m) / (s.width_m / 2 + 0.6);
    return s.ridge_m - 0.3 - rise * std::abs(y) - 0.25;
  };
  add_beam(b, {x, -half, low}, {x, half, low}, 0.25, 0.25);
  for (const double side : {-1.0, 1.0}) add_beam(b, {x, side * half, top_at(half)}, {x, 0, top_at(0)}, 0.25, 0.25);
  const int panels = 2 * std::max(2, static_cast<int>(std::round(half / 4)));
  for (int k = 0; k < panels; ++k) {
    const double y0 = half * (2.0 * k / panels - 1), y1 = half * (2.0 * (k + 1) / panels - 1);
    if (k > 0) add_beam(b, {x, y0, low}, {x, y0, top_at(y0)}, 0.12, 0.12);
    const bool up = k < panels / 2;
    add_beam(b, {x, up ? y0 : y1, low}, {x, up ? y1 : y0, top_at(up ? y1 : y0)}, 0.12, 0.12);
  }
}

/// Where columns and trusses stand along x.
struct Frames {
  explicit Frames(const HangarSpec& s)
      : from(front_m + 0.6 + column_m),
        to(s.depth_m - wall_m - column_gap_m - column_m / 2),
        column_y(s.width_m / 2 - wall_m - column_gap_m - column_m / 2),
        count(std::max(2, static_cast<int>(std::round((to - from) / s.frame_pitch_m)) + 1)) {}
  double x(int k) const { return from + (to - from) * k / (count - 1); }
  double from, to, column_y;
  int count;
};

}  // namespace

double hangar_clear_width_m(const HangarSpec& spec) {
  return spec.width_m - 2 * (wall_m + column_gap_m + column_m);
}

double hangar_clear_depth_m(const HangarSpec& spec) {
  return spec.depth_m - wall_m - column_gap_m - column_m;
}

void add_hangar_shell(MeshBuilder& b, const HangarSpec& s) {
  const double half = s.width_m / 2, door = s.door_width_m / 2;
  b.use(facade_panel);
  add_box(b, {front_m, door, foot_m}, {front_m + 0.6, half, s.eaves_m});
  add_box(b, {front_m, -half, foot_m}, {front_m + 0.6, -door, s.eaves_m});
  add_box(b, {front_m, -door, s.door_height_m}, {front_m + 0.6, door, s.eaves_m});
  for (const double y : {-half, half - wall_m})
    add_box(b, {front_m + 0.6, y, foot_m}, {s.depth_m, y + wall_m, s.eaves_m});
  add_box(b, {s.depth_m - wall_m, -half + wall_m, foot_m}, {s.depth_m, half - wall_m, s.eaves_m});
  add_door(b, s);
  b.use(facade_panel);
  if (!s.hollow) add_solid_roof(b, s);
  b.use(concrete_wall);
  for (double y = -half; y <= half; y += 9) {
    if (s.open && std::abs(y) < door + 0.5) continue;  // nothing stands in an open door
    add_box(b, {0.5, y - 0.25, foot_m}, {front_m, y + 0.25, s.eaves_m});
  }
}

void add_hangar_columns(MeshBuilder& b, const HangarSpec& s) {
  const Frames f(s);
  b.use(painted_steel);
  for (int k = 0; k < f.count; ++k) {
    for (const double side : {-1.0, 1.0}) add_column(b, f.x(k), side * f.column_y, s.eaves_m - 0.7);
  }
  const int posts = std::max(1, static_cast<int>(std::round(s.width_m / 9)));
  for (int k = 1; k < posts; ++k) add_column(b, f.to, -f.column_y + 2 * f.column_y * k / posts, s.eaves_m - 0.95);
  b.use(galvanised_steel);
  const double half = s.width_m / 2 - wall_m, back = s.depth_m - wall_m;
  for (double z = 2.4; z < s.eaves_m - 1; z += 2.4) {
    for (const double side : {-1.0, 1.0})
      add_beam(b, {front_m + 0.6, side * (half - 0.03), z}, {back, side * (half - 0.03), z}, 0.06, 0.16);
    add_beam(b, {back - 0.03, -half, z}, {back - 0.03, half, z}, 0.06, 0.16);
  }
}

void add_hangar_roof(MeshBuilder& b, const HangarSpec& s) {
  b.use(facade_panel);
  add_hollow_roof(b, s);
  b.use(painted_steel);
  const Frames f(s);
  for (int k = 0; k < f.count; ++k) add_truss(b, s, f.x(k));
}

}  // namespace tarmac::scenes
