#include "scenes/bridge/bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scenes/bridge/parts.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

namespace {

double angle_deg(const Vector2d& a, const Vector2d& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))) * 180 / std::numbers::pi;
}

core::SE3 frame_between(const Vector3d& from, const Vector3d& to) {
  core::SE3 T = core::SE3::Identity();
  const Vector3d x = (to - from).normalized(), y = Vector3d::UnitZ().cross(x).normalized();
  T.linear() << x, y, x.cross(y);
  T.translation() = from;
  return T;
}

void check(const BridgeReach& r, const BridgeLimits& limits, const std::string& who) {
  const auto fail = [&](const std::string& what) { throw core::InputError("jet bridge to " + who + ": " + what); };
  if (r.reach_m < limits.reach_min_m || r.reach_m > limits.reach_max_m) {
    fail(
        fmt::format("the cab would stand {:.2f} m from the rotunda, outside the bridge's {} .. {} m; move the rotunda "
                    "or the aircraft {}",
                    r.reach_m, limits.reach_min_m, limits.reach_max_m,
                    r.reach_m < limits.reach_min_m ? "apart" : "closer together"));
  }
  if (std::abs(r.slope) > limits.slope_max) {
    fail(
        fmt::format("its tunnels would slope by {:.3f}, more than {}; give it a longer way or a floor nearer to the "
                    "sill's height",
                    r.slope, limits.slope_max));
  }
  if (r.swing_deg > limits.swing_max_deg) {
    fail(
        fmt::format("the tunnels would swing {:.1f} deg from the walkway's direction, more than {}; turn the walkway "
                    "or move the rotunda away from the aircraft's nose",
                    r.swing_deg, limits.swing_max_deg));
  }
  if (r.cab_turn_deg > limits.cab_turn_max_deg) {
    fail(
        fmt::format("the cab would turn {:.1f} deg from the tunnels' direction, more than {}; move the rotunda to the "
                    "door's side of the aircraft",
                    r.cab_turn_deg, limits.cab_turn_max_deg));
  }
}

/// Column, drum and roof that the tunnels turn on.
void add_rotunda(MeshBuilder& b, const Vector3d& floor, double ground_z) {
  const double r = bridge::rotunda_radius_m;
  const Vector3d up = Vector3d::UnitZ(), foot(floor.x(), floor.y(), ground_z - 0.5);
  const Vector3d under = floor - (bridge::floor_slab_m + 0.1) * up;
  b.use(bridge_panel);
  add_frustum(b, under, floor + 2.9 * up, r, r, 48);
  b.use(painted_steel);
  add_frustum(b, floor + 2.9 * up, floor + 3.15 * up, r + 0.1, r, 48);
  add_frustum(b, foot, under, 0.5, 0.5, 32);
  add_frustum(b, foot, foot + 0.85 * up, 0.9, 0.9, 32);
}

/// Two tunnels that slide into each other, three from 24 m on; each outer one wraps the inner one.
void add_tunnels(MeshBuilder& b, const core::SE3& T_world_tunnel, double length) {
  const double begin = bridge::rotunda_radius_m - 0.4, end = length - 1.6;
  const auto add = [&](double from, double to, double drop, double width, double height) {
    bridge::add_tunnel(b, {T_world_tunnel * place(from, 0, -drop), to - from, width, height});
  };
  if (length < 24) {
    add(begin, 0.66 * length, 0, 2.55, 2.85);
    add(0.46 * length, end, 0.12, 2.82, 3.12);
  } else {
    add(begin, 0.44 * length, 0, 2.55, 2.85);
    add(0.30 * length, 0.74 * length, 0.06, 2.68, 2.98);
    add(0.58 * length, end, 0.12, 2.82, 3.12);
  }
}

}  // namespace

BridgeReach bridge_reach(const BridgeSite& site, const AircraftType& type, const core::SE3& T_world_aircraft,
                         std::size_t door, const BridgeLimits& limits) {
  const std::string who = fmt::format("door {} of {}", door, type.name);
  if (door >= type.doors.size() || type.doors[door].side < 0 || type.doors[door].sill_m < 0)
    throw core::InputError("jet bridge to " + who + ": it is no passenger door on the left side");
  BridgeReach r;
  r.sill_m = door_sill_world(type, T_world_aircraft, door);
  r.rotunda_m = Vector3d(site.rotunda_m.x(), site.rotunda_m.y(), site.floor_z_m);
  r.pivot_m = r.sill_m + bridge::pivot_to_door_m * T_world_aircraft.linear().col(1) -
              bridge::floor_below_sill_m * T_world_aircraft.linear().col(2);
  const Vector2d walkway = site.rotunda_m - site.terminal_m, tunnel = (r.pivot_m - r.rotunda_m).head<2>();
  r.reach_m = tunnel.norm();
  r.slope = (r.pivot_m.z() - r.rotunda_m.z()) / r.reach_m;
  r.swing_deg = angle_deg(walkway, tunnel);
  r.cab_turn_deg = angle_deg(tunnel, -T_world_aircraft.linear().col(1).head<2>());
  check(r, limits, who);
  return r;
}

Mesh make_jet_bridge(const BridgeSite& site, const AircraftType& type, const core::SE3& T_world_aircraft,
                     const Ground& ground, std::size_t door) {
  const BridgeReach reach = bridge_reach(site, type, T_world_aircraft, door);
  MeshBuilder b("jet_bridge");
  const Vector3d portal(site.terminal_m.x(), site.terminal_m.y(), site.floor_z_m);
  const double from = bridge::rotunda_radius_m - 0.3, walkway = (portal - reach.rotunda_m).norm();
  if (walkway > from)
    bridge::add_tunnel(b, {frame_between(reach.rotunda_m, portal) * place(from, 0, 0), walkway - from, 2.6, 3.0});
  add_rotunda(b, reach.rotunda_m, ground.height_m(site.rotunda_m.x(), site.rotunda_m.y()));

  const core::SE3 T_tunnel = frame_between(reach.rotunda_m, reach.pivot_m);
  const double length = (reach.pivot_m - reach.rotunda_m).norm();
  add_tunnels(b, T_tunnel, length);
  bridge::add_drive_column(b, T_tunnel, std::max(length - 8.2, 0.55 * length), ground);
  bridge::add_service_stair(b, T_tunnel, length - 3.2, ground);
  bridge::add_cab(b, type, door, T_world_aircraft, T_tunnel.linear().col(0));
  return std::move(b).build();
}

double walkway_clearance_m(const BridgeSite& site, const Ground& ground, double from, double to) {
  const Vector2d along = site.terminal_m - site.rotunda_m, across = Vector2d(-along.y(), along.x()).normalized();
  double clearance = 1e9;
  const int n = std::max(1, static_cast<int>(std::ceil((to - from) * along.norm() / 0.25)));
  for (int k = 0; k <= n; ++k) {
    for (const double side : {-1.5, 0.0, 1.5}) {
      const Vector2d p = site.rotunda_m + (from + (to - from) * k / n) * along + side * across;
      clearance = std::min(clearance, site.floor_z_m - bridge::floor_slab_m - ground.height_m(p.x(), p.y()));
    }
  }
  return clearance;
}

}  // namespace tarmac::scenes
