#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;
namespace l = layout;

namespace {

constexpr double pivot_to_door_m = 2.4, door_gap_m = 0.08, cab_half_m = 1.5, rotunda_radius_m = 2.2;
constexpr double floor_slab_m = 0.32;

/// A straight stretch of bridge; x along, z above its floor. `height_m` and `width_m` are outside.
struct Tunnel {
  core::SE3 T_world_tunnel;
  double length_m, width_m, height_m;
};

/// Floor, roof and walls with a window band of 0.9-2.2 m above the floor, a post every two metres.
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

core::SE3 frame_between(const Vector3d& from, const Vector3d& to) {
  core::SE3 T = core::SE3::Identity();
  const Vector3d x = (to - from).normalized(), y = Vector3d::UnitZ().cross(x).normalized();
  T.linear() << x, y, x.cross(y);
  T.translation() = from;
  return T;
}

/// Canopy wall at one side of the cab: from the cab's edge to the skin, following the fuselage's outline.
void add_canopy_side(MeshBuilder& b, const AircraftType& type, double along_m, double cab_y_m) {
  const double station = type.doors.front().x_m - along_m;
  std::vector<Ring> rings;
  constexpr int n = 28;
  for (int k = 0; k <= n; ++k) {
    const double z = -0.1 + 2.40 * k / n;
    double skin = 0;  // the largest that the wall's thickness and a step in height meet
    for (const double d : {-0.05, 0.05}) {
      for (const double dz : {-0.09, 0.0}) {
        skin = std::max(skin, fuselage_half_width_m(type, station + d, type.floor_z_m + z + dz));
      }
    }
    skin += 0.02;
    rings.push_back({{along_m - 0.05, skin, z},
                     {along_m + 0.05, skin, z},
                     {along_m + 0.05, cab_y_m, z},
                     {along_m - 0.05, cab_y_m, z}});
  }
  add_loft(b, rings);
}

/// In the aircraft's frame moved to the door's sill on the centre line: y leads away from the skin.
void add_cab(MeshBuilder& b, const AircraftType& type, const core::SE3& T_world_aircraft) {
  const Door& door = type.doors.front();
  b.at(T_world_aircraft * place(-door.x_m, 0, type.floor_z_m));
  const double skin = fuselage_half_width_m(type, door.x_m, type.floor_z_m), pivot = skin + pivot_to_door_m;
  // The skin tapers towards the nose; the straight edge of the floor stays clear of it on both sides.
  double widest = skin;
  for (const double d : {-cab_half_m, cab_half_m}) {
    for (const double z : {-0.2, 0.0})
      widest = std::max(widest, fuselage_half_width_m(type, door.x_m + d, type.floor_z_m + z));
  }
  const double edge = widest + door_gap_m, wall_from = edge + 0.35, top = 2.75;
  b.use(bellows);
  add_box(b, {-cab_half_m, edge, -0.22}, {cab_half_m, edge + 0.14, -0.02});  // bumper
  b.use(painted_steel);
  add_box(b, {-cab_half_m, edge + 0.14, -floor_slab_m}, {cab_half_m, pivot, 0});
  b.use(bridge_panel);
  add_box(b, {-cab_half_m, wall_from, top - 0.15}, {cab_half_m, pivot, top + 0.1});
  for (const double x : {-cab_half_m, cab_half_m - 0.1}) add_box(b, {x, wall_from, 0}, {x + 0.1, pivot, top - 0.15});
  add_frustum(b, {0, pivot, -floor_slab_m - 0.1}, {0, pivot, top}, 1.85, 1.85, 40);
  b.use(painted_steel);
  add_frustum(b, {0, pivot, top}, {0, pivot, top + 0.25}, 1.95, 1.80, 40);
  b.use(bellows);
  for (const double x : {-cab_half_m + 0.06, cab_half_m - 0.06}) add_canopy_side(b, type, x, wall_from + 0.05);
  std::vector<Ring> roof;
  constexpr int n = 8;
  for (int k = 0; k <= n; ++k) {
    const double x = cab_half_m * (2.0 * k / n - 1), margin = 0.06;
    const double low = fuselage_half_width_m(type, door.x_m - x, type.floor_z_m + 2.25) + margin;
    const double high = fuselage_half_width_m(type, door.x_m - x, type.floor_z_m + 2.38) + margin;
    roof.push_back({{x, low, 2.28}, {x, wall_from + 0.05, 2.55}, {x, wall_from + 0.05, 2.68}, {x, high, 2.40}});
  }
  add_loft(b, roof);
  b.at(core::SE3::Identity());
}

/// Two legs beside the tunnel on a bogie with two wheels; T: origin on the tunnel's floor, x along it.
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

/// Steps from a landing beside the tunnel down to the apron, along the tunnel.
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

double walkway_floor_z_m(const Ground& ground) {
  return ground.height_m(0, l::facade_y_m) + l::boarding_floor_z_m;
}

}  // namespace

core::SE3 park(const AircraftType& type, const Ground& ground, double nose_x_m, double nose_y_m) {
  const LandingGear& main = type.main_gear.front();
  const auto on_ground = [&](double x, double y) { return Vector3d(x, y, ground.height_m(x, y)); };
  const Vector3d nose = on_ground(nose_x_m, nose_y_m - type.nose_gear.x_m);
  const Vector3d left = on_ground(nose_x_m - main.half_track_m, nose_y_m - main.x_m);
  const Vector3d right = on_ground(nose_x_m + main.half_track_m, nose_y_m - main.x_m);
  const Vector3d forward = (nose - 0.5 * (left + right)).normalized();
  const Vector3d up = forward.cross((left - right)).normalized();
  core::SE3 T = core::SE3::Identity();
  T.linear() << forward, up.cross(forward), up;
  T.translation() = nose + type.nose_gear.x_m * forward;
  return T;
}

Vector3d door_sill_world(const AircraftType& type, const core::SE3& T_world_aircraft) {
  const Door& door = type.doors.front();
  return T_world_aircraft * Vector3d(-door.x_m, fuselage_half_width_m(type, door.x_m, type.floor_z_m), type.floor_z_m);
}

double bridge_clearance_m(const Ground& ground) {
  double clearance = 1e9;
  for (double y = l::head_road_centre_y_m - l::lane_width_m; y <= l::head_road_centre_y_m + l::lane_width_m;
       y += 0.25) {
    for (const double x : {l::rotunda_x_m - 1.5, l::rotunda_x_m, l::rotunda_x_m + 1.5}) {
      clearance = std::min(clearance, walkway_floor_z_m(ground) - floor_slab_m - ground.height_m(x, y));
    }
  }
  return clearance;
}

Mesh make_jet_bridge(const AircraftType& type, const core::SE3& T_world_aircraft, const Ground& ground) {
  MeshBuilder b("jet_bridge");
  const double floor_z = walkway_floor_z_m(ground);
  const Vector3d rotunda(l::rotunda_x_m, l::rotunda_y_m, floor_z);
  // Fixed walkway from the rotunda to the façade.
  const Vector3d facade(l::rotunda_x_m, l::facade_y_m - 0.02, floor_z);
  const core::SE3 T_walkway = frame_between(rotunda, facade) * place(rotunda_radius_m - 0.3, 0, 0);
  add_tunnel(b, {T_walkway, l::facade_y_m - 0.02 - l::rotunda_y_m - rotunda_radius_m + 0.3, 2.6, 3.0});

  const double rotunda_ground = ground.height_m(rotunda.x(), rotunda.y());
  b.use(bridge_panel);
  add_frustum(b, rotunda - Vector3d(0, 0, floor_slab_m + 0.1), rotunda + Vector3d(0, 0, 2.9), rotunda_radius_m,
              rotunda_radius_m, 48);
  b.use(painted_steel);
  add_frustum(b, rotunda + Vector3d(0, 0, 2.9), rotunda + Vector3d(0, 0, 3.15), rotunda_radius_m + 0.1,
              rotunda_radius_m, 48);
  add_frustum(b, {rotunda.x(), rotunda.y(), rotunda_ground - 0.5}, rotunda - Vector3d(0, 0, floor_slab_m + 0.1), 0.5,
              0.5, 32);
  add_frustum(b, {rotunda.x(), rotunda.y(), rotunda_ground - 0.5}, {rotunda.x(), rotunda.y(), rotunda_ground + 0.35},
              0.9, 0.9, 32);

  // Two tunnels, the outer one at the cab.
  const Door& door = type.doors.front();
  const double skin = fuselage_half_width_m(type, door.x_m, type.floor_z_m);
  const Vector3d pivot = T_world_aircraft * Vector3d(-door.x_m, skin + pivot_to_door_m, type.floor_z_m);
  const core::SE3 T_tunnel = frame_between(rotunda, pivot);
  const double length = (pivot - rotunda).norm(), inner_to = 0.66 * length, outer_from = 0.46 * length;
  add_tunnel(b, {T_tunnel * place(rotunda_radius_m - 0.4, 0, 0), inner_to - rotunda_radius_m + 0.4, 2.55, 2.85});
  add_tunnel(b, {T_tunnel * place(outer_from, 0, -0.12), length - 1.6 - outer_from, 2.82, 3.12});
  add_drive_column(b, T_tunnel, length - 8.2, ground);
  add_service_stair(b, T_tunnel, length - 3.2, ground);
  add_cab(b, type, T_world_aircraft);
  return std::move(b).build();
}

}  // namespace tarmac::scenes
