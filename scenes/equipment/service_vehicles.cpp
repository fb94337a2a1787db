// Trucks, buses and cars that serve an aircraft or lead it.
#include <cmath>

#include "scenes/equipment/vehicle_parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

void add_refueller(MeshBuilder& b) {
  add_axle(b, 3.55, 1.22, 0.52, 0.32);
  for (const double x : {-1.75, -3.10}) add_axle(b, x, 1.22, 0.52, 0.55);
  b.use(gse_chassis);
  add_box(b, {-4.9, -0.45, 0.62}, {4.6, 0.45, 1.0});
  add_box(b, {-5.0, -1.15, 0.45}, {-4.85, 1.15, 0.65});  // rear underrun bar
  for (const double x : {-1.75, -3.10}) add_box(b, {x - 0.62, -1.22, 1.06}, {x + 0.62, 1.22, 1.10});
  b.use(gse_paint_white);
  add_truck_cab(b, 2.95, 5.0, 1.22, 0.55, 2.75, WheelArch{3.55, 0.52});
  b.use(gse_paint_white);
  add_tank(b, -4.95, 2.70, 1.25, 1.10, 3.10);
  b.use(gse_paint_blue);
  for (const double y : {-1.26, 1.24}) add_box(b, {-3.8, y, 1.95}, {1.6, y + 0.02, 2.25});
  b.use(gse_chassis);  // pump and hose cabinets under the tank, valve covers on it
  for (const double side : {-1.0, 1.0}) {
    add_box(b, {-0.9, std::min(side * 0.7, side * 1.22), 0.5}, {1.7, std::max(side * 0.7, side * 1.22), 1.15});
  }
  b.use(galvanised_steel);
  for (const double x : {-3.2, -1.0, 1.2}) add_frustum(b, {x, 0, 3.05}, {x, 0, 3.22}, 0.28, 0.26, 20);
  for (const double y : {-0.6, 0.6}) add_beam(b, {-4.4, y, 3.27}, {2.2, y, 3.27}, 0.06, 0.06);
  for (const double x : {-4.3, -2.1, 0.1, 2.1}) {
    for (const double y : {-0.6, 0.6}) add_beam(b, {x, y, 3.0}, {x, y, 3.26}, 0.05, 0.05);
  }
  add_beacon(b, 3.6, 0, 2.75);
}

void add_hydrant_dispenser(MeshBuilder& b) {
  add_axle(b, 2.35, 1.17, 0.45, 0.28);
  add_axle(b, -1.85, 1.17, 0.45, 0.48);
  b.use(gse_chassis);
  add_box(b, {-3.7, -0.45, 0.55}, {3.4, 0.45, 0.9});
  b.use(gse_paint_white);
  add_truck_cab(b, 1.75, 3.75, 1.17, 0.5, 2.35, WheelArch{2.35, 0.45});
  b.use(gse_paint_yellow);
  add_box(b, {-3.75, -1.2, 0.9}, {1.6, 1.2, 1.05});
  b.use(galvanised_steel);  // filter vessel, hose reel, meter, pit coupler's pipe
  add_frustum(b, {-0.9, 0.0, 1.05}, {-0.9, 0.0, 1.95}, 0.5, 0.5, 28);
  add_frustum(b, {0.9, -0.75, 1.5}, {0.9, 0.75, 1.5}, 0.44, 0.44, 28);
  b.use(tyre_rubber);
  for (const double y : {-0.45, 0.0, 0.45}) add_frustum(b, {0.9, y - 0.1, 1.5}, {0.9, y + 0.1, 1.5}, 0.47, 0.47, 28);
  b.use(gse_chassis);
  add_box(b, {-0.1, 0.45, 1.05}, {0.3, 1.1, 1.75});
  add_bar(b, {{-3.3, -0.9, 0.95}, {-3.3, -0.9, 0.45}, {-3.6, -0.9, 0.35}}, 0.07, 12);
  b.use(gse_paint_white);  // elevating platform, lowered
  for (const double y : {-0.8, 0.8}) add_beam(b, {-3.4, y, 1.05}, {-2.0, y, 1.88}, 0.08, 0.10);
  for (const double y : {-0.72, 0.72}) add_beam(b, {-2.0, y, 1.05}, {-3.4, y, 1.88}, 0.08, 0.10);
  add_box(b, {-3.7, -0.95, 1.85}, {-1.6, 0.95, 1.93});
  add_guard_rail(b, -3.7, -1.6, 0.95, 1.93, 1.07);
  add_beacon(b, 2.5, 0, 2.35);
}

void add_apron_bus(MeshBuilder& b) {
  constexpr double w = 1.5, end = 6.95, floor = 0.50, waist = 1.05, head = 2.70, roof = 3.05;
  for (const double x : {3.55, -3.55}) add_axle(b, x, 1.42, 0.48, 0.30);
  b.use(gse_chassis);
  add_box(b, {-end + 0.1, -1.1, 0.28}, {end - 0.1, 1.1, floor});
  b.use(gse_paint_white);
  add_box(b, {-end, -w, head}, {end, w, roof});
  add_box(b, {-end + 1.0, -1.1, roof}, {end - 1.0, 1.1, 3.20});  // air conditioning
  for (const double side : {-1.0, 1.0}) {
    const double y0 = std::min(side * w, side * (w - 0.05)), y1 = y0 + 0.05;
    b.use(gse_paint_blue);  // skirts between the wheel arches
    for (const auto& [x0, x1] : {std::pair{-end, -4.15}, {-2.95, 2.95}, {4.15, end}})
      add_box(b, {x0, y0, 0.32}, {x1, y1, waist});
    for (const double x : {-3.55, 3.55}) add_box(b, {x - 0.6, y0, 1.0}, {x + 0.6, y1, waist});
    b.use(gse_paint_white);
    constexpr int bays = 10;
    for (int k = 0; k <= bays; ++k) {
      const double x = std::clamp(-end + 2 * end * k / bays, -end + 0.06, end - 0.06);
      add_box(b, {x - 0.06, y0, waist}, {x + 0.06, y1, head});
    }
    b.use(glass_clear_float_pane);
    const double y = side * (w - 0.025);
    for (int k = 0; k < bays; ++k) {
      const double x0 = -end + 2 * end * k / bays + 0.07, x1 = x0 + 2 * end / bays - 0.14;
      side > 0 ? add_patch(b, {x1, y, waist}, {x0, y, waist}, {x0, y, head}, {x1, y, head})
               : add_patch(b, {x0, y, waist}, {x1, y, waist}, {x1, y, head}, {x0, y, head});
    }
  }
  for (const double side : {-1.0, 1.0}) {  // both ends: bumper, windscreen
    const double x0 = std::min(side * end, side * (end - 0.06)), x = side * (end - 0.03);
    b.use(gse_paint_blue);
    add_box(b, {x0, -w, 0.32}, {x0 + 0.06, w, waist});
    b.use(glass_clear_float_pane);
    const double s = side * (w - 0.08);
    add_patch(b, {x, -s, waist}, {x, s, waist}, {x, s, head}, {x, -s, head});
  }
  b.use(interior_wall);  // driver's partitions, benches, poles
  for (const double x : {-5.3, 5.3}) add_box(b, {x - 0.03, -w + 0.06, floor}, {x + 0.03, 0.1, 1.6});
  b.use(gse_chassis);
  for (const double x : {-3.55, 3.55}) {
    for (const double y : {-1.15, 1.15}) add_box(b, {x - 0.7, y - 0.25, floor}, {x + 0.7, y + 0.25, 1.1});
  }
  b.use(gse_paint_yellow);
  for (double x = -4.5; x < 5; x += 1.5) add_beam(b, {x, 0, floor}, {x, 0, head}, 0.04, 0.04);
}

void add_deicer(MeshBuilder& b) {
  add_axle(b, 3.6, 1.25, 0.52, 0.32);
  for (const double x : {-1.6, -3.0}) add_axle(b, x, 1.25, 0.52, 0.55);
  b.use(gse_chassis);
  add_box(b, {-5.1, -0.45, 0.62}, {4.8, 0.45, 1.0});
  b.use(gse_paint_white);
  add_truck_cab(b, 3.2, 5.25, 1.25, 0.55, 2.6, WheelArch{3.6, 0.52});
  b.use(gse_paint_white);  // fluid tank and heater house
  add_box(b, {-4.0, -1.3, 1.05}, {2.2, 1.3, 2.55});
  add_box(b, {2.2, -1.1, 1.05}, {3.05, 1.1, 2.3});
  b.use(gse_paint_blue);
  for (const double y : {-1.31, 1.30}) add_box(b, {-3.8, y, 1.5}, {2.0, y + 0.01, 1.9});
  b.use(gse_chassis);
  add_box(b, {-5.25, -1.25, 1.0}, {-4.0, 1.25, 1.2});
  b.use(gse_paint_yellow);  // turret and folded boom, its basket over the cab
  add_frustum(b, {-3.2, 0, 2.5}, {-3.2, 0, 3.25}, 0.55, 0.45, 24);
  add_beam(b, {-3.7, 0.18, 3.15}, {3.6, 0.18, 3.05}, 0.32, 0.36);
  add_beam(b, {-3.5, -0.22, 3.35}, {1.2, -0.22, 3.35}, 0.26, 0.28);
  b.use(gse_paint_white);
  add_box(b, {3.55, -0.75, 2.8}, {5.1, 0.75, 2.9});
  for (const double x : {3.58, 5.02}) {
    for (const double y : {-0.72, 0.67}) add_box(b, {x, y, 2.9}, {x + 0.05, y + 0.05, 3.9});
  }
  add_box(b, {3.55, -0.75, 2.9}, {5.1, -0.72, 3.4});
  add_box(b, {3.55, 0.72, 2.9}, {5.1, 0.75, 3.4});
  add_box(b, {5.07, -0.72, 2.9}, {5.10, 0.72, 3.4});
  add_box(b, {3.5, -0.8, 3.9}, {5.15, 0.8, 4.0});
}

void add_follow_me_car(MeshBuilder& b) {
  constexpr double w = 0.95;
  for (const double x : {1.42, -1.38}) add_axle(b, x, w - 0.02, 0.36, 0.22);
  b.use(gse_chassis);
  add_box(b, {-2.2, -0.7, 0.22}, {2.2, 0.7, 0.45});
  b.use(gse_paint_yellow);
  add_plate(b, {{-2.38, 0.40}, {2.30, 0.36}, {2.40, 0.55}, {2.35, 0.85}, {1.05, 1.02}, {-2.35, 1.05}, {-2.40, 0.8}}, -w,
            w);
  std::vector<Ring> cabin;  // narrower towards the roof
  for (const auto& [z, x0, x1, half] : std::vector<std::array<double, 4>>{
           {1.0, -2.3, 1.15, 0.90}, {1.45, -2.2, 0.55, 0.80}, {1.70, -2.05, 0.22, 0.72}, {1.75, -1.9, 0.05, 0.64}}) {
    cabin.push_back({{x0, -half, z}, {x1, -half, z}, {x1, half, z}, {x0, half, z}});
  }
  add_loft(b, cabin);
  b.use(glass_clear_float_pane);
  add_patch(b, {1.08, -0.80, 1.08}, {1.08, 0.80, 1.08}, {0.60, 0.74, 1.43}, {0.60, -0.74, 1.43});
  for (const double side : {-1.0, 1.0}) {
    const double y0 = side * 0.90, y1 = side * 0.83;
    for (const auto& [x0, x1] : {std::pair{-0.5, 0.7}, {-1.9, -0.6}}) {
      side > 0 ? add_patch(b, {x1, y0, 1.07}, {x0, y0, 1.07}, {x0, y1, 1.42}, {x1 - 0.25, y1, 1.42})
               : add_patch(b, {x0, y0, 1.07}, {x1, y0, 1.07}, {x1 - 0.25, y1, 1.42}, {x0, y1, 1.42});
    }
  }
  b.use(gse_chassis);  // the board, in yellow and black squares, seen from behind
  for (const double y : {-0.45, 0.45}) add_beam(b, {-1.2, y, 1.70}, {-1.2, y, 1.80}, 0.05, 0.05);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 6; ++column) {
      b.use((row + column) % 2 ? gse_chassis : gse_paint_yellow);
      const double y = -0.75 + 0.25 * column, z = 1.75 + 0.25 * row;
      add_box(b, {-1.24, y, z}, {-1.16, y + 0.25, z + 0.25});
    }
  }
  add_beacon(b, -0.5, 0, 1.75);
}

void add_fire_tender(MeshBuilder& b) {
  constexpr double w = 1.5;
  for (const double x : {4.0, 2.3, -2.3, -4.0}) add_axle(b, x, w - 0.02, 0.66, 0.48);
  b.use(gse_chassis);
  add_box(b, {-5.8, -0.6, 0.75}, {5.6, 0.6, 1.15});
  b.use(gse_paint_yellow);
  add_truck_cab(b, 4.0, 6.0, w, 0.9, 3.15);
  b.use(gse_paint_yellow);
  add_box(b, {-5.9, -w, 1.45}, {3.9, w, 3.2});
  for (const auto& [x0, x1] : {std::pair{-1.35, 1.35}, {-6.0, -4.9}}) add_box(b, {x0, -w, 0.7}, {x1, w, 1.45});
  b.use(roller_shutter);
  for (const double y : {-w - 0.01, w}) {
    for (const double x : {-5.2, -3.6, -2.0, -0.4, 1.2}) add_box(b, {x, y, 1.6}, {x + 1.4, y + 0.01, 2.95});
  }
  b.use(retro_sheeting_ra1);
  for (const double y : {-w - 0.012, w + 0.002}) add_box(b, {-5.8, y, 1.47}, {5.0, y + 0.01, 1.57});
  b.use(gse_paint_white);  // roof monitor on a short boom, hatches
  add_frustum(b, {2.6, 0, 3.15}, {2.6, 0, 3.45}, 0.35, 0.30, 24);
  add_beam(b, {2.6, 0, 3.5}, {5.2, 0, 3.55}, 0.22, 0.22);
  add_bar(b, {{5.1, 0, 3.55}, {5.7, 0, 3.6}}, 0.09, 12);
  b.use(galvanised_steel);
  add_box(b, {-5.0, -1.0, 3.2}, {1.5, 1.0, 3.26});
  add_guard_rail(b, -5.4, 1.8, 1.35, 3.2, 0.55);
  add_beacon(b, 4.6, 0.9, 3.15);
  add_beacon(b, 4.6, -0.9, 3.15);
}

void add_lavatory_truck(MeshBuilder& b) {
  add_axle(b, 2.1, 1.08, 0.42, 0.26);
  add_axle(b, -1.5, 1.08, 0.42, 0.44);
  b.use(gse_chassis);
  add_box(b, {-3.3, -0.42, 0.52}, {3.2, 0.42, 0.85});
  b.use(gse_paint_white);
  add_truck_cab(b, 1.55, 3.5, 1.08, 0.48, 2.3, WheelArch{2.1, 0.42});
  b.use(gse_paint_blue);
  add_tank(b, -1.6, 1.4, 1.1, 0.9, 2.1);
  b.use(gse_chassis);
  add_box(b, {-3.5, -1.05, 0.75}, {-1.6, 1.05, 0.88});
  b.use(gse_paint_yellow);  // servicing platform at the rear with its mast and steps
  add_box(b, {-3.4, -0.7, 1.62}, {-1.75, 0.7, 1.70});
  add_guard_rail(b, -3.4, -1.75, 0.7, 1.70, 1.1);
  for (const double y : {-0.55, 0.55}) add_beam(b, {-1.9, y, 0.88}, {-1.9, y, 1.65}, 0.1, 0.1);
  for (const double y : {-0.55, 0.55}) add_beam(b, {-3.2, y, 0.88}, {-3.2, y, 1.65}, 0.08, 0.08);
  b.use(tyre_rubber);
  add_bar(b, {{-1.7, 0.85, 1.2}, {-2.6, 0.95, 1.35}, {-3.3, 0.9, 1.1}}, 0.06, 10);  // hose
  add_beacon(b, 2.3, 0, 2.3);
}

}  // namespace tarmac::scenes
