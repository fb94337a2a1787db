#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/bridge/parts.h"
#include "scenes/equipment/equipment.h"

namespace tarmac::scenes::bridge {

using Eigen::Vector3d;
using enum MaterialId;

void add_tunnel(MeshBuilder& b, const Tunnel& t) {
  const double half = t.width_m / 2, top = t.height_m - floor_slab_m, wall = 0.09;
  b.at(t.T_world_tunnel).use(painted_steel);
  add_box(b, {0, -half, -floor_slab_m}, {t.length_m, half, 0});
  b.use(bridge_panel);
  add_box(b, {0, -half, top - 0.15}, {t.length_m, half, top});
  const int bays = std::max(1, static_cast<int>(std::round(t.length_m / 2)));
  for (const double side : {-1.0, 1.0}) {
    const double y0 = std::min(side * half, side * (half - wall)), y1 = y0 + wall;
    b.use(bridge_panel);
    add_box(b, {0, y0, 0}, {t.length_m, y1, 0.9});
    add_box(b, {0, y0, 2.2}, {t.length_m, y1, top - 0.15});
    for (int k = 0; k <= bays; ++k) {
      const double x = std::clamp(t.length_m * k / bays, 0.07, t.length_m - 0.07);
      b.use(painted_steel);
      add_box(b, {x - 0.07, std::min(side * half, side * (half + 0.06)), -0.1},
              {x + 0.07, std::max(side * half, side * (half + 0.06)), top});
      b.use(bridge_panel);
      add_box(b, {x - 0.07, y0, 0.9}, {x + 0.07, y1, 2.2});
    }
    b.use(glass_clear_float_pane);
    const double y = side * (half - wall / 2);
    for (int k = 0; k < bays; ++k) {
      const double x0 = t.length_m * k / bays + 0.08, x1 = t.length_m * (k + 1) / bays - 0.08;
      side > 0 ? add_patch(b, {x1, y, 0.9}, {x0, y, 0.9}, {x0, y, 2.2}, {x1, y, 2.2})
               : add_patch(b, {x0, y, 0.9}, {x1, y, 0.9}, {x1, y, 2.2}, {x0, y, 2.2});
    }
  }
  b.at(core::SE3::Identity());
}

void add_drive_column(MeshBuilder& b, const core::SE3& T_world_tunnel, double along_m, const Ground& ground) {
  const Vector3d floor = T_world_tunnel * Vector3d(along_m, 0, 0);
  const double yaw = std::atan2(T_world_tunnel.linear()(1, 0), T_world_tunnel.linear()(0, 0));
  const double z = ground.height_m(floor.x(), floor.y()), floor_z = floor.z() - z;
  b.at(place(floor.x(), floor.y(), z, yaw)).use(painted_steel);
  for (const double y : {-1.72, 1.72}) add_box(b, {-0.18, y - 0.18, 0.95}, {0.18, y + 0.18, floor_z + 3.1});
  add_box(b, {-0.16, -1.9, floor_z - 0.75}, {0.16, 1.9, floor_z - floor_slab_m - 0.03});
  add_box(b, {-0.22, -1.9, 0.75}, {0.22, 1.9, 1.15});
  add_box(b, {-0.3, -0.9, 0.35}, {0.3, 0.9, 0.8});
  b.use(gse_paint_yellow);
  for (const double y : {-1.6, 1.6}) add_box(b, {-0.75, y - 0.05, 0.55}, {0.75, y + 0.05, 0.75});
  for (const double y : {-1.15, 1.15}) {
    const Vector3d wheel = floor + y * Vector3d(-std::sin(yaw), std::cos(yaw), 0);
    const double step = ground.height_m(wheel.x(), wheel.y()) - z;
    b.at(place(floor.x(), floor.y(), z + step, yaw));
    add_road_wheel(b, 0, y, 0.5, 0.36);
  }
  b.at(core::SE3::Identity());
}

void add_service_stair(MeshBuilder& b, const core::SE3& T_world_tunnel, double along_m, const Ground& ground) {
  const Vector3d top = T_world_tunnel * Vector3d(along_m, 0, 0);
  const double yaw = std::atan2(T_world_tunnel.linear()(1, 0), T_world_tunnel.linear()(0, 0));
  const double z = ground.height_m(top.x(), top.y()), height = top.z() - z;
  constexpr double inner = 1.5, outer = 2.45, run = 0.25;
  const int steps = static_cast<int>(std::ceil(height / 0.19));
  const double rise = height / steps;
  b.at(place(top.x(), top.y(), z, yaw)).use(galvanised_steel);
  add_box(b, {-0.1, inner, height - 0.06}, {1.1, outer, height});
  for (int k = 1; k < steps; ++k) {
    add_box(b, {-0.1 - k * run, inner, height - k * rise - 0.04},
            {-0.1 - (k - 1) * run + 0.03, outer, height - k * rise});
  }
  const double foot_x = -0.1 - (steps - 1) * run;
  for (const double y : {inner, outer}) {
    add_beam(b, {foot_x, y, 0.1}, {-0.1, y, height - 0.12}, 0.05, 0.22);
    add_beam(b, {foot_x, y, 1.15}, {-0.1, y, height + 1.0}, 0.05, 0.05);
    add_beam(b, {foot_x, y, -0.15}, {foot_x, y, 1.15}, 0.05, 0.05);
    add_beam(b, {-0.1, y, height - 0.1}, {-0.1, y, height + 1.0}, 0.05, 0.05);
    add_beam(b, {1.05, y, -0.15}, {1.05, y, height + 1.0}, 0.07, 0.07);
  }
  add_beam(b, {-0.1, outer, height + 1.0}, {1.05, outer, height + 1.0}, 0.05, 0.05);
  b.at(core::SE3::Identity());
}

}  // namespace tarmac::scenes::bridge
