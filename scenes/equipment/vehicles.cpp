#include <algorithm>
#include <cmath>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

void add_road_wheel(MeshBuilder& b, double x_m, double y_m, double radius_m, double width_m) {
  const double h = width_m / 2, r = radius_m;
  MeshBuilder wheel("");  // built about x, then laid across
  add_lathe(wheel,
            {{-0.7 * h, 0, galvanised_steel},
             {-0.7 * h, 0.5 * r, tyre_rubber},
             {-h, 0.6 * r, tyre_rubber},
             {-h, 0.88 * r, tyre_rubber},
             {-0.7 * h, r, tyre_rubber},
             {0.7 * h, r, tyre_rubber},
             {h, 0.88 * r, tyre_rubber},
             {h, 0.6 * r, tyre_rubber},
             {0.7 * h, 0.5 * r, galvanised_steel},
             {0.7 * h, 0, galvanised_steel}},
            20);
  const Mesh mesh = std::move(wheel).build();
  std::vector<std::uint32_t> indices;
  for (const Eigen::Vector3f& p : mesh.vertices)
    indices.push_back(b.vertex(Vector3d(x_m - p.y(), y_m + p.x(), r + p.z())));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    b.use(static_cast<MaterialId>(mesh.materials[t]));
    const auto& [i, j, k] = mesh.triangles[t];
    b.triangle(indices[i], indices[j], indices[k]);
  }
}

void add_baggage_tractor(MeshBuilder& b) {
  for (const double x : {0.80, -0.69}) {  // wheelbase 1.49 m
    for (const double y : {-0.68, 0.68}) add_road_wheel(b, x, y, 0.31, 0.22);
  }
  b.use(gse_chassis);
  add_box(b, {-1.35, -0.56, 0.22}, {1.35, 0.56, 0.55});
  b.use(gse_paint_yellow);  // bonnet, rear body, mudguards, front bumper
  add_plate(b, {{0.25, 0.50}, {1.45, 0.50}, {1.45, 0.92}, {1.30, 1.02}, {0.25, 1.10}}, -0.62, 0.62);
  add_box(b, {-1.45, -0.80, 0.55}, {-0.75, 0.80, 0.98});
  add_box(b, {-0.75, -0.80, 0.45}, {0.25, 0.80, 0.62});
  for (const double side : {-1.0, 1.0}) {
    add_plate(b, {{0.42, 0.62}, {1.18, 0.62}, {1.08, 0.74}, {0.52, 0.74}}, side * 0.62, side * 0.82);
  }
  b.use(gse_chassis);
  add_box(b, {1.45, -0.75, 0.35}, {1.55, 0.75, 0.60});
  add_box(b, {-1.62, -0.12, 0.38}, {-1.45, 0.12, 0.52});  // hitch
  add_box(b, {-0.60, -0.55, 0.62}, {-0.15, 0.55, 0.95});  // bench
  add_plate(b, {{-0.72, 0.95}, {-0.58, 0.95}, {-0.66, 1.45}, {-0.76, 1.45}}, -0.52, 0.52);
  add_beam(b, {0.30, 0.25, 1.05}, {0.02, 0.25, 1.22}, 0.05, 0.05);  // steering column
  b.use(gse_paint_yellow);                                          // cab posts and roof
  for (const double y : {-0.72, 0.72}) {
    add_beam(b, {0.30, y, 0.62}, {0.18, y, 1.97}, 0.07, 0.07);
    add_beam(b, {-0.92, y, 0.95}, {-0.92, y, 1.97}, 0.07, 0.07);
  }
  add_box(b, {-1.05, -0.80, 1.97}, {0.30, 0.80, 2.05});
  b.use(glass_clear_float_pane);
  add_patch(b, {0.285, -0.66, 1.12}, {0.285, 0.66, 1.12}, {0.215, 0.66, 1.93}, {0.215, -0.66, 1.93});
  b.use(cone_orange);
  add_frustum(b, {-0.5, 0, 2.05}, {-0.5, 0, 2.17}, 0.07, 0.05, 12);  // beacon
}

void add_baggage_cart(MeshBuilder& b) {
  for (const double x : {1.05, -1.05}) {
    for (const double y : {-0.62, 0.62}) add_road_wheel(b, x, y, 0.21, 0.14);
  }
  b.use(gse_chassis);
  add_box(b, {-1.5, -0.45, 0.28}, {1.5, 0.45, 0.40});
  add_beam(b, {1.45, 0, 0.33}, {2.65, 0, 0.36}, 0.08, 0.08);  // drawbar
  b.use(gse_paint_white);
  add_box(b, {-1.6, -0.78, 0.40}, {1.6, 0.78, 0.48});
  for (const double x : {-1.56, 1.56}) add_box(b, {x - 0.03, -0.76, 0.48}, {x + 0.03, 0.76, 1.92});
  add_box(b, {-1.6, -0.78, 1.92}, {1.6, 0.78, 1.98});
  b.use(cart_curtain);  // one side closed, the other open with a centre post
  add_box(b, {-1.5, -0.775, 0.50}, {1.5, -0.755, 1.90});
  b.use(gse_paint_white);
  add_box(b, {-0.03, 0.72, 0.48}, {0.03, 0.77, 1.92});
  b.use(gse_paint_blue);  // bags
  add_box(b, {-1.35, -0.55, 0.48}, {-0.6, 0.25, 0.98});
  b.use(tyre_rubber);
  add_box(b, {-0.5, -0.6, 0.48}, {0.35, 0.15, 0.83});
  b.use(gse_chassis);
  add_box(b, {0.5, -0.5, 0.48}, {1.3, 0.3, 1.16});
}

void add_belt_loader(MeshBuilder& b, double high_end_m) {
  for (const double x : {1.9, -2.4}) {
    for (const double y : {-0.88, 0.88}) add_road_wheel(b, x, y, 0.36, 0.24);
  }
  b.use(gse_chassis);
  add_box(b, {-3.0, -0.72, 0.32}, {2.6, 0.72, 0.60});
  b.use(gse_paint_white);
  add_box(b, {-3.1, -1.02, 0.55}, {2.7, -0.42, 0.85});
  add_box(b, {-3.1, -1.02, 0.85}, {-1.3, -0.46, 1.05});
  b.use(gse_chassis);  // driver's place beside the belt
  add_box(b, {-0.4, 0.52, 0.60}, {0.2, 1.0, 0.95});
  add_plate(b, {{-0.52, 0.95}, {-0.38, 0.95}, {-0.44, 1.5}, {-0.54, 1.5}}, 0.54, 0.98);
  b.use(gse_paint_white);
  add_box(b, {0.75, 0.48, 0.60}, {1.0, 1.02, 1.22});
  const double low = 1.05, rise = high_end_m - low, length = 7.7;
  const auto belt = [&](double x, double over) { return low + rise * (x + 3.85) / length + over; };
  b.use(gse_paint_blue);  // boom with side rails, the belt between them
  for (const double y : {-0.40, 0.40}) {
    add_beam(b, {-3.85, y, belt(-3.85, -0.12)}, {3.85, y, belt(3.85, -0.12)}, 0.10, 0.30);
  }
  b.use(tyre_rubber);
  add_beam(b, {-3.82, 0, belt(-3.82, -0.10)}, {3.82, 0, belt(3.82, -0.10)}, 0.72, 0.16);
  b.use(galvanised_steel);
  add_beam(b, {-2.2, -0.3, 0.55}, {-2.2, -0.3, belt(-2.2, -0.2)}, 0.12, 0.12);
  add_beam(b, {-2.2, 0.3, 0.55}, {-2.2, 0.3, belt(-2.2, -0.2)}, 0.12, 0.12);
  for (const double y : {-0.3, 0.3}) add_bar(b, {{-0.2, y, 0.6}, {1.6, y, belt(1.6, -0.25)}}, 0.06, 10);  // lift
  std::vector<Vector3d> rail{{-1.5, -0.46, belt(-1.5, 0.0)},
                             {-1.5, -0.46, belt(-1.5, 0.9)},
                             {3.4, -0.46, belt(3.4, 0.9)},
                             {3.4, -0.46, belt(3.4, 0.0)}};
  add_bar(b, rail, 0.025, 8);
}

void add_ground_power_unit(MeshBuilder& b) {
  for (const double x : {0.95, -0.95}) {
    for (const double y : {-0.78, 0.78}) add_road_wheel(b, x, y, 0.30, 0.2);
  }
  b.use(gse_chassis);
  add_box(b, {-1.5, -0.65, 0.28}, {1.5, 0.65, 0.55});
  add_beam(b, {1.5, 0, 0.42}, {2.4, 0, 0.40}, 0.08, 0.08);
  b.use(gse_paint_white);
  add_plate(b, {{-1.6, 0.55}, {1.6, 0.55}, {1.6, 1.75}, {1.4, 2.0}, {-1.4, 2.0}, {-1.6, 1.75}}, -0.95, 0.95);
  b.use(gse_chassis);
  add_box(b, {-0.9, -0.97, 0.9}, {0.2, -0.95, 1.6});  // louvres
  add_box(b, {1.6, -0.6, 0.9}, {1.62, 0.6, 1.5});
  b.use(exhaust_metal);
  add_frustum(b, {-0.9, 0.5, 2.0}, {-0.9, 0.5, 2.25}, 0.06, 0.06, 12);
}

void add_container_dolly(MeshBuilder& b, bool loaded) {
  for (const double x : {1.0, -1.0}) {
    for (const double y : {-0.7, 0.7}) add_road_wheel(b, x, y, 0.2, 0.14);
  }
  b.use(gse_paint_yellow);
  add_box(b, {-1.6, -0.95, 0.40}, {1.6, 0.95, 0.51});
  add_beam(b, {1.55, 0, 0.35}, {2.7, 0, 0.38}, 0.08, 0.08);
  if (!loaded) return;
  // LD3: base 1.562, top 2.007 wide, 1.626 high, 1.534 deep, its chamfer on one side.
  b.use(polished_aluminium);
  add_plate(b, {{-0.9, 0.53}, {0.66, 0.53}, {1.10, 1.02}, {1.10, 2.15}, {-0.9, 2.15}}, -0.767, 0.767);
  b.use(cart_curtain);
  add_box(b, {-0.7, 0.767, 0.7}, {0.6, 0.775, 2.0});
}

void add_catering_truck(MeshBuilder& b) {
  for (const double y : {-1.0, 1.0}) {
    add_road_wheel(b, 2.9, y, 0.48, 0.3);
    add_road_wheel(b, -2.6, y, 0.48, 0.42);
  }
  b.use(gse_chassis);
  add_box(b, {-4.2, -0.85, 0.5}, {4.2, 0.85, 0.95});
  b.use(gse_paint_white);
  add_plate(b, {{2.55, 0.6}, {4.3, 0.6}, {4.3, 1.5}, {4.05, 2.45}, {2.55, 2.55}}, -1.2, 1.2);
  add_box(b, {-4.3, -1.25, 1.45}, {2.35, 1.25, 4.0});
  b.use(gse_paint_blue);
  add_box(b, {-4.31, -1.26, 1.75}, {2.36, 1.26, 2.15});
  b.use(glass_clear_float_pane);
  add_patch(b, {4.305, -1.05, 1.55}, {4.305, 1.05, 1.55}, {4.075, 1.05, 2.40}, {4.075, -1.05, 2.40});
  b.use(galvanised_steel);  // scissors
  for (const double y : {-0.7, 0.7}) {
    add_beam(b, {-3.6, y, 1.0}, {1.8, y, 1.42}, 0.12, 0.12);
    add_beam(b, {1.8, y, 1.0}, {-3.6, y, 1.42}, 0.12, 0.12);
  }
  add_box(b, {2.35, -1.2, 3.3}, {3.6, 1.2, 3.4});
}

namespace {

constexpr double step_run_m = 0.28, stairs_platform_m = 1.7;

int stair_steps(double sill_m) {
  return std::max(3, static_cast<int>(std::lround(sill_m / 0.243)));
}
/// By how much the stairs are longer at each end than those with 14 steps.
double stair_extension_m(double sill_m) {
  return (stair_steps(sill_m) - 14) * step_run_m / 2;
}

}  // namespace

double passenger_stairs_front_m(double sill_m) {
  return -3.4 - stair_extension_m(sill_m) + stair_steps(sill_m) * step_run_m + stairs_platform_m;
}

double passenger_stairs_back_m(double sill_m) {
  return -3.6 - stair_extension_m(sill_m);
}

void add_passenger_stairs(MeshBuilder& b, double sill_m, double rails_short_m) {
  const int steps = stair_steps(sill_m);
  const double longer = stair_extension_m(sill_m), from = -3.4 - longer, rise = sill_m / steps;
  for (const double y : {-0.95, 0.95}) {
    add_road_wheel(b, 1.6 + longer, y, 0.38, 0.26);
    add_road_wheel(b, -2.4 - longer, y, 0.38, 0.26);
  }
  b.use(gse_paint_white);
  add_box(b, {-3.6 - longer, -1.0, 0.45}, {2.1 + longer, 1.0, 0.8});
  b.use(galvanised_steel);
  for (int k = 0; k < steps; ++k) {
    add_box(b, {from + k * step_run_m, -0.7, 0.03 + k * rise + rise - 0.06},
            {from + k * step_run_m + 0.32, 0.7, 0.03 + (k + 1) * rise});
  }
  const double top_x = from + steps * step_run_m, rail_end_x = top_x + stairs_platform_m - rails_short_m;
  add_box(b, {top_x, -0.9, sill_m - 0.1}, {top_x + stairs_platform_m, 0.9, sill_m + 0.03});
  b.use(gse_paint_white);
  for (const double y : {-0.78, 0.78}) {
    add_beam(b, {from, y, 0.25}, {top_x, y, sill_m - 0.05}, 0.08, 0.35);
    add_beam(b, {from, y, 1.25}, {top_x, y, sill_m + 1.0}, 0.06, 0.06);
    add_beam(b, {top_x, y, sill_m + 1.0}, {rail_end_x, y, sill_m + 1.0}, 0.06, 0.06);
    for (const double x : {from, from + 1.3, from + 2.6, top_x, rail_end_x - 0.05}) {
      const double z = std::min(0.25 + (x - from) * (sill_m - 0.3) / (top_x - from), sill_m);
      add_beam(b, {x, y, z}, {x, y, z + 1.0}, 0.05, 0.05);
    }
    add_beam(b, {top_x + 0.2, y, 0.7}, {top_x + 0.2, y, sill_m - 0.05}, 0.14, 0.14);
    add_beam(b, {top_x + 1.5, y, 0.7}, {top_x + 0.3, y, sill_m - 0.05}, 0.1, 0.1);
  }
}

}  // namespace tarmac::scenes
