#include <algorithm>
#include <cmath>

#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;
namespace l = layout;

namespace {

constexpr double bay_m = 7.5, foot_m = -0.8;
constexpr double floor_z = l::boarding_floor_z_m, glass_top_z = 9.6, roof_z = 10.8;
constexpr double recess_y = l::facade_y_m + 2.2, clerestory_y = l::facade_y_m + 6.5, inner_wall_y = l::facade_y_m + 8.5;

/// Every seventh bay is a stair tower; the middle of the building is higher.
bool is_tower(int bay) {
  return bay % 7 == 3;
}
double top_of(double x_m) {
  return std::abs(x_m) < 45 ? 16.5 : 14.0;
}

struct Builders {
  MeshBuilder& solid;
  MeshBuilder& glass;
};

void add_pane(MeshBuilder& glass, double x0, double x1, double y, double z0, double z1) {
  add_patch(glass, {x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
}

/// Wall of the apron level, by turns with a roller shutter, a door with a louvre, or bare.
void add_apron_level(MeshBuilder& b, int bay, double x) {
  b.use(concrete_wall);
  add_box(b, {x, recess_y, foot_m}, {x + bay_m, recess_y + 0.3, floor_z - 0.45});
  const double mid = x + bay_m / 2;
  switch (bay % 4) {
    case 0:
      b.use(roller_shutter);
      add_box(b, {mid - 2, recess_y - 0.06, 0.02}, {mid + 2, recess_y - 0.01, 3.6});
      b.use(galvanised_steel);
      add_box(b, {mid - 2.25, recess_y - 0.16, -0.2}, {mid - 2.0, recess_y, 3.6});
      add_box(b, {mid + 2.0, recess_y - 0.16, -0.2}, {mid + 2.25, recess_y, 3.6});
      add_box(b, {mid - 2.25, recess_y - 0.35, 3.6}, {mid + 2.25, recess_y, 4.05});
      break;
    case 1:
      b.use(painted_steel);
      add_box(b, {mid - 2.4, recess_y - 0.08, 0.02}, {mid - 1.4, recess_y - 0.01, 2.15});
      for (int k = 0; k < 8; ++k) {  // louvre blades
        add_beam(b, {mid + 0.2, recess_y - 0.1, 1.0 + 0.25 * k}, {mid + 2.8, recess_y - 0.1, 1.0 + 0.25 * k}, 0.16,
                 0.03);
      }
      break;
    case 2:
      b.use(painted_steel);
      add_box(b, {mid - 0.6, recess_y - 0.08, 0.02}, {mid + 0.6, recess_y - 0.01, 2.15});
      add_box(b, {mid + 1.4, recess_y - 0.5, -0.2}, {mid + 2.6, recess_y - 0.01, 1.7});  // switch cabinet
      break;
    default:
      break;
  }
  b.use(concrete_wall);
  add_frustum(b, {x, l::facade_y_m + 0.5, foot_m}, {x, l::facade_y_m + 0.5, floor_z - 0.45}, 0.36, 0.36, 24);
  b.use(gse_paint_yellow);
  add_frustum(b, {x, l::facade_y_m + 0.5, 0.05}, {x, l::facade_y_m + 0.5, 1.1}, 0.375, 0.375, 24);
}

/// True where the walkway of the jet bridge enters.
bool is_portal(double x0, double x1) {
  return x1 > l::rotunda_x_m - 1.5 && x0 < l::rotunda_x_m + 1.5;
}

/// Glass between floor and spandrel: five panes a bay in two rows, mullions and a transom.
void add_boarding_level(Builders b, double x) {
  constexpr double pane_m = bay_m / 5, y = l::facade_y_m, transom_z = 7.2;
  b.solid.use(facade_panel_dark);
  for (int k = 0; k < 5; ++k) {
    const double x0 = x + k * pane_m, x1 = x0 + pane_m;
    add_box(b.solid, {x0 - 0.03, y - 0.13, floor_z}, {x0 + 0.03, y + 0.05, glass_top_z});
    if (is_portal(x0, x1)) {
      add_box(b.solid, {x0 + 0.03, y - 0.04, floor_z}, {x1 - 0.03, y + 0.04, glass_top_z});
    } else {
      add_pane(b.glass, x0 + 0.03, x1 - 0.03, y, floor_z + 0.05, transom_z - 0.03);
      add_pane(b.glass, x0 + 0.03, x1 - 0.03, y, transom_z + 0.03, glass_top_z);
      add_box(b.solid, {x0 + 0.03, y - 0.06, transom_z - 0.03}, {x1 - 0.03, y + 0.04, transom_z + 0.03});
    }
  }
  b.solid.use(facade_panel);
  add_box(b.solid, {x, y - 0.18, glass_top_z}, {x + bay_m, y + 0.3, roof_z - 0.25});
}

void add_upper_level(Builders b, double x) {
  const double top = top_of(x + bay_m / 2);
  b.solid.use(facade_panel);
  add_box(b.solid, {x, clerestory_y, roof_z + 0.1}, {x + bay_m, clerestory_y + 0.25, roof_z + 0.9});
  add_box(b.solid, {x, clerestory_y - 0.1, top - 1.2}, {x + bay_m, clerestory_y + 0.25, top});
  b.solid.use(facade_panel_dark);
  add_box(b.solid, {x - 0.06, clerestory_y - 0.12, roof_z + 0.9}, {x + 0.06, clerestory_y + 0.1, top - 1.2});
  add_box(b.solid, {x + bay_m / 2 - 0.04, clerestory_y - 0.1, roof_z + 0.9},
          {x + bay_m / 2 + 0.04, clerestory_y + 0.1, top - 1.2});
  add_pane(b.glass, x + 0.06, x + bay_m / 2 - 0.04, clerestory_y, roof_z + 0.9, top - 1.2);
  add_pane(b.glass, x + bay_m / 2 + 0.04, x + bay_m - 0.06, clerestory_y, roof_z + 0.9, top - 1.2);
}

/// A stair tower: closed, in front of the façade's plane, with a slot of glass.
void add_tower(Builders b, double x) {
  const double y = l::facade_y_m - 0.9, top = top_of(x + bay_m / 2) + 1.2, mid = x + bay_m / 2;
  b.solid.use(facade_panel_dark);
  add_box(b.solid, {x + 0.2, y, foot_m}, {mid - 0.8, clerestory_y + 2, top});
  add_box(b.solid, {mid + 0.8, y, foot_m}, {x + bay_m - 0.2, clerestory_y + 2, top});
  add_box(b.solid, {mid - 0.8, y + 0.6, foot_m}, {mid + 0.8, clerestory_y + 2, 2.4});
  add_box(b.solid, {mid - 0.8, y, top - 1.5}, {mid + 0.8, clerestory_y + 2, top});
  b.solid.use(interior_wall);
  add_box(b.solid, {mid - 0.8, y + 3.2, 2.4}, {mid + 0.8, y + 3.4, top - 1.5});
  b.solid.use(facade_panel);
  for (const double z : {4.8, 7.2, 9.6, 12.0})
    add_box(b.solid, {mid - 0.8, y + 0.02, z - 0.05}, {mid + 0.8, y + 0.25, z + 0.05});
  add_pane(b.glass, mid - 0.8, mid + 0.8, y + 0.3, 2.4, top - 1.5);
  b.solid.use(painted_steel);
  add_box(b.solid, {mid - 0.5, y + 0.52, 0.0}, {mid + 0.5, y + 0.59, 2.1});
}

/// Slabs and what stands behind the glass, over the whole length.
void add_body(MeshBuilder& b) {
  const double w = l::terminal_west_m, e = l::terminal_east_m, back = l::terminal_back_y_m;
  b.use(facade_panel);
  add_box(b, {w, l::facade_y_m - 0.35, floor_z - 0.45}, {e, back, floor_z});
  add_box(b, {w - 0.6, l::facade_y_m - 1.3, roof_z - 0.25}, {e + 0.6, clerestory_y + 0.3, roof_z + 0.1});
  b.use(interior_wall);
  add_box(b, {w, inner_wall_y, floor_z}, {e, inner_wall_y + 0.2, top_of(w) - 0.4});
  for (double x = w + bay_m; x < e; x += 2 * bay_m) {  // columns of the lounge and desks
    add_frustum(b, {x, inner_wall_y - 3, floor_z}, {x, inner_wall_y - 3, roof_z - 0.25}, 0.3, 0.3, 16);
    add_box(b, {x + 2.5, inner_wall_y - 2.2, floor_z}, {x + 5.5, inner_wall_y - 1.4, floor_z + 1.1});
  }
  b.use(facade_panel_dark);  // rows of seats
  for (double x = w + 3; x + 4 < e; x += 6) {
    add_box(b, {x, l::facade_y_m + 2.2, floor_z + 0.3}, {x + 4, l::facade_y_m + 2.8, floor_z + 0.45});
    add_box(b, {x, l::facade_y_m + 2.8, floor_z + 0.3}, {x + 4, l::facade_y_m + 2.9, floor_z + 0.95});
  }
  b.use(facade_panel);
  for (const auto& [x0, x1] : {std::pair{w, -45.0}, {-45.0, 45.0}, {45.0, e}}) {  // roofs, gables, back wall
    const double top = top_of((x0 + x1) / 2);
    add_box(b, {x0, clerestory_y - 0.8, top}, {x1, back + 0.5, top + 0.3});
    add_box(b, {x0, back - 0.3, foot_m}, {x1, back, top});
  }
  for (const double x : {w, e - 0.3}) add_box(b, {x, l::facade_y_m + 0.3, foot_m}, {x + 0.3, back, roof_z - 0.25});
  for (const double x : {w, -45.0, 44.7, e - 0.3}) {
    add_box(b, {x, clerestory_y, roof_z - 0.25}, {x + 0.3, back, std::max(top_of(x), top_of(x + 0.3))});
  }
  b.use(galvanised_steel);  // plant on the roof
  for (const double x : {-90.0, -66.0, -31.0, -8.0, 19.0, 52.0, 84.0}) {
    add_box(b, {x, clerestory_y + 2.5, top_of(x) + 0.3}, {x + 5, clerestory_y + 5.5, top_of(x) + 2.2});
  }
}

/// Docking guidance display over the lead-in line.
void add_docking_display(MeshBuilder& b) {
  const double y = l::facade_y_m - 0.5;
  b.use(painted_steel);
  add_box(b, {-0.8, y - 0.35, 6.0}, {0.8, y + 0.25, 7.3});
  add_box(b, {-0.1, y + 0.25, 6.5}, {0.1, l::facade_y_m, 6.7});
  b.use(gse_chassis);
  add_box(b, {-0.7, y - 0.37, 6.1}, {0.7, y - 0.35, 7.2});
}

}  // namespace

Terminal make_terminal(double z0_m) {
  MeshBuilder solid("terminal"), glass("terminal_glass");
  solid.at(place(0, 0, z0_m));
  glass.at(place(0, 0, z0_m));
  glass.use(glass_coated_double);
  const int bays = static_cast<int>(std::round((l::terminal_east_m - l::terminal_west_m) / bay_m));
  for (int bay = 0; bay < bays; ++bay) {
    const double x = l::terminal_west_m + bay * bay_m;
    if (is_tower(bay)) {
      add_tower({solid, glass}, x);
      continue;
    }
    add_apron_level(solid, bay, x);
    add_boarding_level({solid, glass}, x);
    add_upper_level({solid, glass}, x);
  }
  add_body(solid);
  add_docking_display(solid);
  return {std::move(solid).build(), std::move(glass).build()};
}

}  // namespace tarmac::scenes
