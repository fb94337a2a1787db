#include "scenes/hangar/workshop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

void add_tool_cabinet(MeshBuilder& b) {
  b.use(gse_paint_blue);
  add_box(b, {-0.25, -0.5, 0.08}, {0.25, 0.5, 1.95});
  b.use(gse_chassis);
  add_box(b, {-0.22, -0.46, 0}, {0.22, 0.46, 0.08});
  b.use(gse_paint_white);
  for (const double y : {-0.48, 0.02}) add_box(b, {0.25, y, 0.12}, {0.27, y + 0.46, 1.9});
  b.use(galvanised_steel);
  for (const double y : {-0.08, 0.05}) add_box(b, {0.27, y, 0.95}, {0.30, y + 0.03, 1.15});
}

void add_work_bench(MeshBuilder& b) {
  b.use(painted_steel);
  for (const double x : {-0.36, 0.28}) {
    for (const double y : {-0.95, 0.87}) add_box(b, {x, y, 0}, {x + 0.08, y + 0.08, 0.85});
  }
  add_box(b, {-0.38, -0.9, 0.25}, {0.3, 0.9, 0.29});
  b.use(cart_curtain);
  add_box(b, {-0.4, -1.0, 0.85}, {0.4, 1.0, 0.91});
  b.use(gse_chassis);
  add_box(b, {0.1, 0.5, 0.91}, {0.42, 0.72, 1.1});  // vice
  b.use(galvanised_steel);
  add_box(b, {-0.4, -1.0, 0.91}, {-0.37, 1.0, 1.7});  // rack
  for (int k = 0; k < 6; ++k) add_box(b, {-0.37, -0.85 + 0.3 * k, 1.1}, {-0.30, -0.75 + 0.3 * k, 1.5});
}

void add_tool_cart(MeshBuilder& b) {
  for (const double x : {-0.35, 0.35}) {
    for (const double y : {-0.2, 0.2}) add_road_wheel(b, x, y, 0.07, 0.04);
  }
  b.use(gse_paint_yellow);
  add_box(b, {-0.45, -0.25, 0.12}, {0.45, 0.25, 0.98});
  b.use(gse_chassis);
  for (int k = 0; k < 4; ++k) add_box(b, {0.45, -0.22, 0.2 + 0.19 * k}, {0.47, 0.22, 0.34 + 0.19 * k});
  add_box(b, {-0.47, -0.25, 0.98}, {0.47, 0.25, 1.01});
}

void add_step_ladder(MeshBuilder& b) {
  b.use(polished_aluminium);
  constexpr double height = 2.6, foot = 0.9;
  for (const double y : {-0.35, 0.35}) {
    add_beam(b, {foot, y, 0.006}, {0.1, y, height}, 0.06, 0.04);  // a slanted end reaches lower
    add_beam(b, {-foot, y, 0.006}, {-0.1, y, height}, 0.06, 0.04);
  }
  for (int k = 1; k < 9; ++k) {
    const double z = 0.28 * k, x = foot - (foot - 0.1) * z / height;
    add_box(b, {x - 0.06, -0.33, z - 0.02}, {x + 0.06, 0.33, z + 0.02});
  }
  b.use(gse_paint_yellow);
  add_box(b, {-0.3, -0.4, height}, {0.3, 0.4, height + 0.05});
}

void add_oil_drum(MeshBuilder& b) {
  b.use(gse_paint_blue);
  add_frustum(b, {0, 0, 0}, {0, 0, 0.87}, 0.28, 0.28, 20);
  b.use(galvanised_steel);
  for (const double z : {0.02, 0.29, 0.58, 0.84}) add_frustum(b, {0, 0, z}, {0, 0, z + 0.04}, 0.29, 0.29, 20);
}

void add_wheel_rack(MeshBuilder& b) {
  b.use(painted_steel);
  for (const double x : {-1.2, 1.14}) {
    for (const double y : {-0.5, 0.44}) add_box(b, {x, y, 0}, {x + 0.06, y + 0.06, 1.0});
  }
  for (const double y : {-0.3, 0.24}) add_box(b, {-1.2, y, 0.45}, {1.2, y + 0.06, 0.51});
  core::SE3 lying = core::SE3::Identity();
  for (int k = 0; k < 4; ++k) {  // wheels stand side by side on the rails, axles along x
    lying.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
    lying.translation() = Vector3d(-0.8 + 0.53 * k, 0, 0.52);
    b.at(lying);
    add_road_wheel(b, 0, 0, 0.56, 0.40);
  }
  b.at(core::SE3::Identity());
}

void add_engine_stand(MeshBuilder& b) {
  b.use(gse_paint_yellow);
  for (const double y : {-1.0, 0.9}) add_box(b, {-2.1, y, 0.25}, {2.1, y + 0.1, 0.4});
  for (const double x : {-1.9, 1.8}) add_box(b, {x, -1.0, 0.25}, {x + 0.1, 1.0, 0.4});
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-0.95, 0.95}) {
      add_beam(b, {x, y, 0.4}, {x, y, 1.5}, 0.1, 0.1);
      add_beam(b, {x, y, 1.5}, {x, 0.8 * y, 1.55}, 0.1, 0.1);
    }
  }
  for (const double x : {-1.8, 1.8}) {
    for (const double y : {-0.95, 0.95}) add_road_wheel(b, x, y, 0.15, 0.1);
  }
  // Fan case, core and exhaust cone, axis along x.
  core::SE3 raised = core::SE3::Identity();
  raised.translation() = Vector3d(0, 0, 1.62);
  b.at(raised);
  add_lathe(b,
            {{-2.1, 0.0, exhaust_metal},
             {-1.5, 0.22, exhaust_metal},
             {-1.5, 0.40, exhaust_metal},
             {-0.8, 0.50, painted_steel},
             {0.3, 0.52, painted_steel},
             {0.4, 0.86, aircraft_grey},
             {1.4, 0.90, aircraft_grey},
             {1.6, 0.88, polished_aluminium},
             {1.6, 0.30, exhaust_metal},
             {2.0, 0.0, exhaust_metal}},
            36);
  b.at(core::SE3::Identity());
}

namespace {

struct Platform {
  double x0, x1, y0, y1, z;
};

/// A deck on six legs with rails along all sides but the one next to the aircraft.
void add_platform(MeshBuilder& b, const Platform& d, bool rail_low_y, bool rail_high_y) {
  b.use(galvanised_steel);
  add_box(b, {d.x0, d.y0, d.z - 0.12}, {d.x1, d.y1, d.z});
  b.use(gse_paint_yellow);
  const double mid = (d.x0 + d.x1) / 2;
  for (const double x : {d.x0 + 0.06, mid, d.x1 - 0.06}) {
    for (const double y : {d.y0 + 0.06, d.y1 - 0.06})
      add_box(b, {x - 0.05, y - 0.05, -0.03}, {x + 0.05, y + 0.05, d.z - 0.12});
  }
  for (const double y : {d.y0 + 0.06, d.y1 - 0.06}) {  // braces
    add_beam(b, {d.x0 + 0.06, y, 0.3}, {mid, y, d.z - 0.2}, 0.05, 0.05);
    add_beam(b, {d.x1 - 0.06, y, 0.3}, {mid, y, d.z - 0.2}, 0.05, 0.05);
  }
  const auto rail = [&](const Vector3d& from, const Vector3d& to) {
    const int posts = std::max(1, static_cast<int>(std::ceil((to - from).norm() / 1.6)));
    for (const double z : {0.55, 1.1}) add_beam(b, from + Vector3d(0, 0, z), to + Vector3d(0, 0, z), 0.04, 0.04);
    for (int k = 0; k <= posts; ++k) {
      const Vector3d p = from + (to - from) * k / posts;
      add_beam(b, p, p + Vector3d(0, 0, 1.1), 0.04, 0.04);
    }
  };
  const double in = 0.03;
  if (rail_low_y) rail({d.x0 + in, d.y0 + in, d.z}, {d.x1 - in, d.y0 + in, d.z});
  if (rail_high_y) rail({d.x0 + in, d.y1 - in, d.z}, {d.x1 - in, d.y1 - in, d.z});
}

/// Steps down from the deck's edge at `x_m`, towards -x.
void add_steps(MeshBuilder& b, double x_m, double y0, double y1, double height_m) {
  const int steps = std::max(2, static_cast<int>(std::ceil(height_m / 0.21)));
  const double rise = height_m / steps, run = 0.24;
  b.use(galvanised_steel);
  for (int k = 1; k < steps; ++k)
    add_box(b, {x_m - k * run, y0 + 0.05, height_m - k * rise - 0.03},
            {x_m - (k - 1) * run, y1 - 0.05, height_m - k * rise});
  b.use(gse_paint_yellow);
  const double foot = x_m - (steps - 1) * run;
  for (const double y : {y0 + 0.03, y1 - 0.03}) {
    add_beam(b, {foot, y, 0.12}, {x_m, y, height_m - 0.1}, 0.04, 0.2);
    add_beam(b, {foot, y, 1.05}, {x_m, y, height_m + 1.05}, 0.04, 0.04);
    add_beam(b, {foot, y, 0.0}, {foot, y, 1.05}, 0.04, 0.04);
  }
}

/// The widest that the fuselage is between two stations and heights.
double widest_m(const AircraftType& type, double from_x, double to_x, double from_z, double to_z) {
  double widest = 0;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j)
      widest = std::max(
          widest, fuselage_half_width_m(type, from_x + (to_x - from_x) * i / 8, from_z + (to_z - from_z) * j / 8));
  }
  return widest;
}

}  // namespace

void add_docking(MeshBuilder& b, const AircraftType& type) {
  constexpr double gap_m = 0.25, deck_m = 1.8, end_gap_m = 1.0;
  const double height = std::max(1.0, type.floor_z_m - 0.3);
  const double wing_end = type.wing.root_le_x_m + type.wing.root_chord_m + 4;
  const double tail_begin = (type.t_tail ? type.fin.le_x_m : type.tailplane.root_le_x_m) - end_gap_m;
  for (const auto& [from, to] : {std::pair{wing_end, tail_begin}, {2.2, 6.4}}) {
    if (to - from < 2) continue;
    const double y0 = widest_m(type, from, to, height - 0.2, height + 1.2) + gap_m;
    for (const double side : {-1.0, 1.0}) {
      b.mirror_y(side < 0);
      add_platform(b, {-to, -from, y0, y0 + deck_m, height}, false, true);
      if (from == wing_end) add_steps(b, -to, y0 + 0.7, y0 + deck_m, height);
    }
    b.mirror_y(false);
  }
  const double tail = -(type.length_m + 0.5);
  for (const double z : {3.0, 5.6, 8.2}) {
    if (z < type.height_min_m - 2) add_platform(b, {tail - 1.8, tail, -3.4, 3.4, z}, true, true);
  }
}

}  // namespace tarmac::scenes
