// Everything here is built in the door's frame: the aircraft's, moved to the centre line under the door at the cab's
// floor; x forward, y away from the skin, z above the floor.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/bridge/parts.h"

namespace tarmac::scenes::bridge {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

/// The skin beside a door.
class Skin {
 public:
  Skin(const AircraftType& type, const Door& door)
      : type_(&type), door_x_m_(door.x_m), floor_z_m_(type.floor_z_m + door.sill_m - floor_below_sill_m) {}
  double floor_z_m() const { return floor_z_m_; }
  /// Half width `x_m` ahead of the door, `z_m` over the cab's floor.
  double y_m(double x_m, double z_m) const { return fuselage_half_width_m(*type_, door_x_m_ - x_m, floor_z_m_ + z_m); }
  /// The largest over a stretch of heights and `margin_m` to both sides.
  double widest_m(double x_m, double z0_m, double z1_m, double margin_m = 0.05) const {
    double widest = 0;
    for (const double dx : {-margin_m, 0.0, margin_m}) {
      for (int k = 0; k <= 4; ++k) widest = std::max(widest, y_m(x_m + dx, z0_m + (z1_m - z0_m) * k / 4));
    }
    return widest;
  }

 private:
  const AircraftType* type_;
  double door_x_m_, floor_z_m_;
};

/// A strip along the skin: from `gap_m` off it to a straight edge, between two heights.
void add_lip(MeshBuilder& b, const Skin& skin, double half_m, double z0, double z1, double gap_m, double edge_y_m) {
  std::vector<Ring> rings;
  constexpr int n = 16;
  for (int k = 0; k <= n; ++k) {
    const double x = half_m * (2.0 * k / n - 1), y = skin.widest_m(x, z0, z1) + gap_m;
    rings.push_back({{x, y, z0}, {x, edge_y_m, z0}, {x, edge_y_m, z1}, {x, y, z1}});
  }
  add_loft(b, rings);
}

/// Canopy wall at one side of the cab: from the cab's edge to the skin, following the fuselage's outline.
void add_canopy_side(MeshBuilder& b, const Skin& skin, double x_m, double cab_y_m, double top_m) {
  std::vector<Ring> rings;
  constexpr int n = 28;
  for (int k = 0; k <= n; ++k) {
    const double z = -0.1 + (top_m + 0.1) * k / n, y = skin.widest_m(x_m, z - 0.09, z) + canopy_gap_m;
    rings.push_back({{x_m - 0.05, y, z}, {x_m + 0.05, y, z}, {x_m + 0.05, cab_y_m, z}, {x_m - 0.05, cab_y_m, z}});
  }
  add_loft(b, rings);
}

/// Canopy roof: from the cab's roof edge down to the skin above the door.
void add_canopy_roof(MeshBuilder& b, const Skin& skin, double half_m, double cab_y_m, double low_m) {
  std::vector<Ring> rings;
  constexpr int n = 16;
  for (int k = 0; k <= n; ++k) {
    const double x = half_m * (2.0 * k / n - 1), margin = canopy_gap_m + 0.03;
    const double low = skin.widest_m(x, low_m - 0.06, low_m) + margin;
    const double high = skin.widest_m(x, low_m + 0.04, low_m + 0.12) + margin;
    rings.push_back({{x, low, low_m}, {x, cab_y_m, 2.52}, {x, cab_y_m, 2.66}, {x, high, low_m + 0.12}});
  }
  add_loft(b, rings);
}

/// Floor, roof and wall about the pivot: the wall stands behind it, away from the aircraft, and leaves out where the
/// tunnel comes in, so that from the door one looks through the cab. `from_tunnel` leads from the tunnel to the pivot.
void add_round_end(MeshBuilder& b, double pivot_y_m, double radius_m, double top_m, const Vector3d& from_tunnel) {
  const auto disc = [&](double z0, double z1, double r0, double r1) {
    add_frustum(b, {0, pivot_y_m, z0}, {0, pivot_y_m, z1}, r0, r1, 40);
  };
  b.use(bridge_panel);
  disc(-floor_slab_m - 0.1, -0.005, radius_m, radius_m);
  b.use(painted_steel);
  disc(top_m - 0.14, top_m + 0.25, radius_m + 0.1, radius_m - 0.05);
  b.use(bridge_panel);
  double entry = std::atan2(-from_tunnel.y(), -from_tunnel.x());
  if (entry < -std::numbers::pi / 2) entry += 2 * std::numbers::pi;
  const double half_entry = std::asin(1.3 / radius_m);
  const double begin = -0.1, end = std::numbers::pi + 0.1, wall_m = 0.08;
  const auto wall = [&](double from, double to) {
    if (to - from < 0.05) return;
    std::vector<Ring> rings;
    const int n = std::max(2, static_cast<int>(std::ceil((to - from) / 0.16)));
    for (int k = 0; k <= n; ++k) {
      const double a = from + (to - from) * k / n;
      const Vector3d out(std::cos(a), std::sin(a), 0), at(0, pivot_y_m, 0), up(0, 0, top_m - 0.1);
      const Vector3d inner = at + (radius_m - wall_m) * out - 0.02 * Vector3d::UnitZ(), outer = inner + wall_m * out;
      rings.push_back({inner, outer, outer + up, inner + up});
    }
    add_loft(b, rings);
  };
  wall(begin, std::clamp(entry - half_entry, begin, end));
  wall(std::clamp(entry + half_entry, begin, end), end);
}

}  // namespace

void add_cab(MeshBuilder& b, const AircraftType& type, std::size_t door_index, const core::SE3& T_world_aircraft,
             const Vector3d& tunnel_direction_world) {
  const Door& door = type.doors[door_index];
  const Skin skin(type, door);
  b.at(T_world_aircraft * place(-door.x_m, 0, skin.floor_z_m()));
  // Wide enough for the leaf that has swung forward.
  const double half = std::max(1.5, 1.5 * door.width_m + 0.28), top = 2.75;
  const double pivot = skin.y_m(0, floor_below_sill_m) + pivot_to_door_m, drum = std::max(1.85, half + 0.1);
  // The skin tapers towards the nose and may bulge over the floor; the straight edge stays clear of it everywhere.
  double widest = 0;
  for (const double x : {-half, 0.0, half}) widest = std::max(widest, skin.widest_m(x, -floor_slab_m, 0));
  const double edge = widest + lip_gap_m + 0.16, wall = edge + 0.27;
  b.use(bellows);
  add_lip(b, skin, half, -0.22, -0.02, lip_gap_m, edge);  // bumper
  b.use(painted_steel);
  add_lip(b, skin, half, -0.02, 0, lip_gap_m + 0.02, edge);  // tread plate
  add_box(b, {-half, edge, -floor_slab_m}, {half, pivot, 0});
  b.use(bridge_panel);
  add_box(b, {-half, wall, top - 0.15}, {half, pivot, top + 0.1});
  for (const double x : {-half, half - 0.1}) add_box(b, {x, wall, 0}, {x + 0.1, pivot, top - 0.15});
  const core::SE3 T_cab_world = (T_world_aircraft * place(-door.x_m, 0, skin.floor_z_m())).inverse();
  add_round_end(b, pivot, drum, top, T_cab_world.linear() * tunnel_direction_world);
  b.use(bellows);
  const double canopy_top = door.height_m + 0.22;
  for (const double x : {-half + 0.06, half - 0.06}) add_canopy_side(b, skin, x, wall + 0.05, canopy_top);
  add_canopy_roof(b, skin, half, wall + 0.05, canopy_top);
  b.at(core::SE3::Identity());
}

}  // namespace tarmac::scenes::bridge
