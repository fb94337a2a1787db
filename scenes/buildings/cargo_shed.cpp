#include "scenes/buildings/cargo_shed.h"

#include <cmath>

namespace tarmac::scenes {

using enum MaterialId;

namespace {

constexpr double foot_m = -1.5;  ///< walls begin below the ground
constexpr double end_m = 4;      ///< from the building's end to a dock's column
constexpr double column_to_door_m = 0.8;

}  // namespace

int dock_count(const CargoShedSpec& spec) {
  return static_cast<int>(std::ceil((spec.length_m - 2 * end_m) / spec.dock_pitch_m - 1e-9));
}

double dock_y_m(const CargoShedSpec& spec, int k) {
  return -spec.length_m / 2 + end_m + k * spec.dock_pitch_m + column_to_door_m + spec.dock_width_m / 2;
}

void add_cargo_shed(MeshBuilder& b, const CargoShedSpec& s) {
  const double half = s.length_m / 2, top = s.height_m;
  b.use(facade_panel);
  add_box(b, {-s.depth_m, -half, foot_m}, {0, half, top});
  b.use(facade_panel_dark);
  add_box(b, {-s.depth_m - 0.3, -half - 0.3, top}, {0.3, half + 0.3, top + 0.9});
  add_box(b, {0, -half + 2, s.canopy_height_m}, {s.canopy_depth_m, half - 2, s.canopy_height_m + 0.4});
  for (int k = 0; k < dock_count(s); ++k) {
    const double y0 = dock_y_m(s, k) - s.dock_width_m / 2, y1 = y0 + s.dock_width_m, h = s.dock_height_m;
    const double column_y = y0 - column_to_door_m - 0.5, column_x = s.canopy_depth_m - 0.3;
    b.use(galvanised_steel);
    add_frustum(b, {column_x, column_y, foot_m}, {column_x, column_y, s.canopy_height_m}, 0.15, 0.15, 14);
    b.use(roller_shutter);
    add_box(b, {0.01, y0, 0.05}, {0.08, y1, h});
    b.use(galvanised_steel);
    add_box(b, {0.01, y0 - 0.25, -0.3}, {0.2, y0, h + 0.2});
    add_box(b, {0.01, y1, -0.3}, {0.2, y1 + 0.25, h + 0.2});
    if (!s.with_bumpers) continue;
    b.use(tyre_rubber);
    for (const double y : {y0 - 0.22, y1 + 0.02}) add_box(b, {0.2, y, 0.5}, {0.38, y + 0.2, 1.1});
    b.use(gse_paint_yellow);
    for (const double y : {y0 - 0.5, y1 + 0.5}) add_frustum(b, {0.7, y, -0.3}, {0.7, y, 1.1}, 0.09, 0.09, 12);
  }
}

}  // namespace tarmac::scenes
