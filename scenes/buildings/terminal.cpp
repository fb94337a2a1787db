#include "scenes/buildings/terminal.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double foot_m = -0.8;          ///< walls begin below the ground, which is not level along them
constexpr double glass_height_m = 4.6;   ///< of the boarding level, above its floor
constexpr double storey_height_m = 5.8;  ///< its roof's lower edge, above its floor

class Builder {
 public:
  Builder(const TerminalSpec& spec, const core::SE3& T_mesh_terminal)
      : s_(spec),
        solid_("terminal"),
        glass_("terminal_glass"),
        floor_z_(spec.boarding_floor_m),
        glass_top_z_(floor_z_ + glass_height_m),
        roof_z_(floor_z_ + storey_height_m),
        recess_y_(spec.facade_y_m + 2.2),
        clerestory_y_(spec.facade_y_m + 6.5),
        inner_wall_y_(spec.facade_y_m + 8.5) {
    solid_.at(T_mesh_terminal);
    glass_.at(T_mesh_terminal);
    glass_.use(glass_coated_double);
  }

  Terminal build() && {
    const int bays = static_cast<int>(std::round((s_.east_m - s_.west_m) / s_.bay_m));
    for (int bay = 0; bay < bays; ++bay) {
      const double x = s_.west_m + bay * s_.bay_m;
      if (is_tower(bay)) {
        add_tower(x);
        continue;
      }
      add_apron_level(bay, x);
      add_boarding_level(x);
      add_upper_level(x);
    }
    add_slabs();
    add_lounge();
    add_roofs();
    for (const double x : s_.displays_x_m) add_docking_display(x);
    return {std::move(solid_).build(), std::move(glass_).build()};
  }

 private:
  bool is_tower(int bay) const { return std::ranges::find(s_.tower_bays, bay) != s_.tower_bays.end(); }
  double top_of(double x_m) const { return std::abs(x_m) < s_.high_half_length_m ? s_.high_top_m : s_.top_m; }
  /// True where a walkway enters.
  bool is_portal(double x0, double x1) const {
    return std::any_of(s_.portals_x_m.begin(), s_.portals_x_m.end(),
                       [&](double x) { return x1 > x - 1.5 && x0 < x + 1.5; });
  }
  void add_pane(double x0, double x1, double y, double z0, double z1) {
    add_patch(glass_, {x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
  }

  void add_apron_level(int bay, double x);
  void add_boarding_level(double x);
  void add_upper_level(double x);
  void add_tower(double x);
  void add_slabs();
  void add_lounge();
  void add_roofs();
  void add_docking_display(double x);

  const TerminalSpec& s_;
  MeshBuilder solid_, glass_;
  double floor_z_, glass_top_z_, roof_z_, recess_y_, clerestory_y_, inner_wall_y_;
};

/// Wall of the apron level, by turns with a roller shutter, a door with a louvre, a door with a cabinet, or bare.
void Builder::add_apron_level(int bay, double x) {
  MeshBuilder& b = solid_;
  b.use(concrete_wall);
  add_box(b, {x, recess_y_, foot_m}, {x + s_.bay_m, recess_y_ + 0.3, floor_z_ - 0.45});
  const double mid = x + s_.bay_m / 2;
  switch (bay % 4) {
    case 0:
      b.use(roller_shutter);
      add_box(b, {mid - 2, recess_y_ - 0.06, 0.02}, {mid + 2, recess_y_ - 0.01, 3.6});
      b.use(galvanised_steel);
      add_box(b, {mid - 2.25, recess_y_ - 0.16, -0.2}, {mid - 2.0, recess_y_, 3.6});
      add_box(b, {mid + 2.0, recess_y_ - 0.16, -0.2}, {mid + 2.25, recess_y_, 3.6});
      add_box(b, {mid - 2.25, recess_y_ - 0.35, 3.6}, {mid + 2.25, recess_y_, 4.05});
      break;
    case 1:
      b.use(painted_steel);
      add_box(b, {mid - 2.4, recess_y_ - 0.08, 0.02}, {mid - 1.4, recess_y_ - 0.01, 2.15});
      for (int k = 0; k < 8; ++k) {  // louvre blades
        add_beam(b, {mid + 0.2, recess_y_ - 0.1, 1.0 + 0.25 * k}, {mid + 2.8, recess_y_ - 0.1, 1.0 + 0.25 * k}, 0.16,
                 0.03);
      }
      break;
    case 2:
      b.use(painted_steel);
      add_box(b, {mid - 0.6, recess_y_ - 0.08, 0.02}, {mid + 0.6, recess_y_ - 0.01, 2.15});
      add_box(b, {mid + 1.4, recess_y_ - 0.5, -0.2}, {mid + 2.6, recess_y_ - 0.01, 1.7});  // switch cabinet
      break;
    default:
      break;
  }
  b.use(concrete_wall);
  add_frustum(b, {x, s_.facade_y_m + 0.5, foot_m}, {x, s_.facade_y_m + 0.5, floor_z_ - 0.45}, 0.36, 0.36, 24);
  b.use(gse_paint_yellow);
  add_frustum(b, {x, s_.facade_y_m + 0.5, 0.05}, {x, s_.facade_y_m + 0.5, 1.1}, 0.375, 0.375, 24);
}

/// Glass between floor and spandrel: five panes a bay in two rows, mullions and a transom.
void Builder::add_boarding_level(double x) {
  const double pane_m = s_.bay_m / 5, y = s_.facade_y_m, transom_z = floor_z_ + 2.2;
  solid_.use(facade_panel_dark);
  for (int k = 0; k < 5; ++k) {
    const double x0 = x + k * pane_m, x1 = x0 + pane_m;
    add_box(solid_, {x0 - 0.03, y - 0.13, floor_z_}, {x0 + 0.03, y + 0.05, glass_top_z_});
    if (is_portal(x0, x1)) {
      add_box(solid_, {x0 + 0.03, y - 0.04, floor_z_}, {x1 - 0.03, y + 0.04, glass_top_z_});
    } else {
      add_pane(x0 + 0.03, x1 - 0.03, y, floor_z_ + 0.05, transom_z - 0.03);
      add_pane(x0 + 0.03, x1 - 0.03, y, transom_z + 0.03, glass_top_z_);
      add_box(solid_, {x0 + 0.03, y - 0.06, transom_z - 0.03}, {x1 - 0.03, y + 0.04, transom_z + 0.03});
    }
  }
  solid_.use(facade_panel);
  add_box(solid_, {x, y - 0.18, glass_top_z_}, {x + s_.bay_m, y + 0.3, roof_z_ - 0.25});
}

void Builder::add_upper_level(double x) {
  const double bay = s_.bay_m, top = top_of(x + bay / 2), y = clerestory_y_;
  solid_.use(facade_panel);
  add_box(solid_, {x, y, roof_z_ + 0.1}, {x + bay, y + 0.25, roof_z_ + 0.9});
  add_box(solid_, {x, y - 0.1, top - 1.2}, {x + bay, y + 0.25, top});
  solid_.use(facade_panel_dark);
  add_box(solid_, {x - 0.06, y - 0.12, roof_z_ + 0.9}, {x + 0.06, y + 0.1, top - 1.2});
  add_box(solid_, {x + bay / 2 - 0.04, y - 0.1, roof_z_ + 0.9}, {x + bay / 2 + 0.04, y + 0.1, top - 1.2});
  add_pane(x + 0.06, x + bay / 2 - 0.04, y, roof_z_ + 0.9, top - 1.2);
  add_pane(x + bay / 2 + 0.04, x + bay - 0.06, y, roof_z_ + 0.9, top - 1.2);
}

/// A stair tower: closed, in front of the façade's plane, with a slot of glass.
void Builder::add_tower(double x) {
  const double bay = s_.bay_m, y = s_.facade_y_m - 0.9, top = top_of(x + bay / 2) + 1.2, mid = x + bay / 2,
               back = clerestory_y_ + 2;
  solid_.use(facade_panel_dark);
  add_box(solid_, {x + 0.2, y, foot_m}, {mid - 0.8, back, top});
  add_box(solid_, {mid + 0.8, y, foot_m}, {x + bay - 0.2, back, top});
  add_box(solid_, {mid - 0.8, y + 0.6, foot_m}, {mid + 0.8, back, 2.4});
  add_box(solid_, {mid - 0.8, y, top - 1.5}, {mid + 0.8, back, top});
  solid_.use(interior_wall);
  add_box(solid_, {mid - 0.8, y + 3.2, 2.4}, {mid + 0.8, y + 3.4, top - 1.5});
  solid_.use(facade_panel);
  for (const double z : {4.8, 7.2, 9.6, 12.0})
    add_box(solid_, {mid - 0.8, y + 0.02, z - 0.05}, {mid + 0.8, y + 0.25, z + 0.05});
  add_pane(mid - 0.8, mid + 0.8, y + 0.3, 2.4, top - 1.5);
  solid_.use(painted_steel);
  add_box(solid_, {mid - 0.5, y + 0.52, 0.0}, {mid + 0.5, y + 0.59, 2.1});
}

/// Floor of the boarding level and the roof over it.
void Builder::add_slabs() {
  const double w = s_.west_m, e = s_.east_m;
  solid_.use(facade_panel);
  add_box(solid_, {w, s_.facade_y_m - 0.35, floor_z_ - 0.45}, {e, s_.back_y_m, floor_z_});
  add_box(solid_, {w - 0.6, s_.facade_y_m - 1.3, roof_z_ - 0.25}, {e + 0.6, clerestory_y_ + 0.3, roof_z_ + 0.1});
}

/// What stands behind the glass: a wall, columns, desks, rows of seats.
void Builder::add_lounge() {
  const double w = s_.west_m, e = s_.east_m;
  solid_.use(interior_wall);
  add_box(solid_, {w, inner_wall_y_, floor_z_}, {e, inner_wall_y_ + 0.2, top_of(w) - 0.4});
  for (double x = w + s_.bay_m; x < e; x += 2 * s_.bay_m) {
    add_frustum(solid_, {x, inner_wall_y_ - 3, floor_z_}, {x, inner_wall_y_ - 3, roof_z_ - 0.25}, 0.3, 0.3, 16);
    add_box(solid_, {x + 2.5, inner_wall_y_ - 2.2, floor_z_}, {x + 5.5, inner_wall_y_ - 1.4, floor_z_ + 1.1});
  }
  solid_.use(facade_panel_dark);
  for (double x = w + 3; x + 4 < e; x += 6) {
    add_box(solid_, {x, s_.facade_y_m + 2.2, floor_z_ + 0.3}, {x + 4, s_.facade_y_m + 2.8, floor_z_ + 0.45});
    add_box(solid_, {x, s_.facade_y_m + 2.8, floor_z_ + 0.3}, {x + 4, s_.facade_y_m + 2.9, floor_z_ + 0.95});
  }
}

/// Roofs, gables, back wall; the plant on the roofs.
void Builder::add_roofs() {
  const double w = s_.west_m, e = s_.east_m, back = s_.back_y_m, half = s_.high_half_length_m;
  std::vector<std::pair<double, double>> stretches{{w, e}};
  std::vector<double> gables{w, e - 0.3};
  if (half > 0) {
    stretches = {{w, -half}, {-half, half}, {half, e}};
    gables = {w, -half, half - 0.3, e - 0.3};
  }
  solid_.use(facade_panel);
  for (const auto& [x0, x1] : stretches) {
    const double top = top_of((x0 + x1) / 2);
    add_box(solid_, {x0, clerestory_y_ - 0.8, top}, {x1, back + s_.roof_overhang_m, top + 0.3});
    add_box(solid_, {x0, back - 0.3, foot_m}, {x1, back, top});
  }
  for (const double x : {w, e - 0.3})
    add_box(solid_, {x, s_.facade_y_m + 0.3, foot_m}, {x + 0.3, back, roof_z_ - 0.25});
  for (const double x : gables)
    add_box(solid_, {x, clerestory_y_, roof_z_ - 0.25}, {x + 0.3, back, std::max(top_of(x), top_of(x + 0.3))});
  solid_.use(galvanised_steel);
  for (const double x : s_.plant_x_m) {
    add_box(solid_, {x, clerestory_y_ + 2.5, top_of(x) + 0.3}, {x + 5, clerestory_y_ + 5.5, top_of(x) + 2.2});
  }
}

/// Docking guidance display over a lead-in line.
void Builder::add_docking_display(double x) {
  const double y = s_.facade_y_m - 0.5;
  solid_.use(painted_steel);
  add_box(solid_, {x - 0.8, y - 0.35, 6.0}, {x + 0.8, y + 0.25, 7.3});
  add_box(solid_, {x - 0.1, y + 0.25, 6.5}, {x + 0.1, s_.facade_y_m, 6.7});
  solid_.use(gse_chassis);
  add_box(solid_, {x - 0.7, y - 0.37, 6.1}, {x + 0.7, y - 0.35, 7.2});
}

}  // namespace

Terminal make_terminal(const TerminalSpec& spec, const core::SE3& T_mesh_terminal) {
  return Builder(spec, T_mesh_terminal).build();
}

}  // namespace tarmac::scenes
