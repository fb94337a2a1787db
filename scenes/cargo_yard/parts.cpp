#include "scenes/cargo_yard/parts.h"

#include <cmath>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

void add_articulated_truck(MeshBuilder& b) {
  b.at(place(-kTruckTail_m, 0, 0));
  for (const double y : {-1.02, 1.02}) {
    for (const double x : {1.8, 3.1, 4.4}) add_road_wheel(b, x, y, 0.5, 0.36);
    for (const double x : {11.2, 15.0}) add_road_wheel(b, x, y, 0.52, 0.34);
  }
  b.use(gse_chassis);
  for (const double y : {-0.55, 0.45}) add_box(b, {0.2, y, 0.85}, {13.2, y + 0.1, 1.12});
  add_box(b, {10.2, -0.5, 0.62}, {15.8, 0.5, 0.86});
  add_box(b, {0.05, -1.2, 0.55}, {0.15, 1.2, 0.70});  // underrun bar
  for (const double y : {-0.5, 0.5}) add_box(b, {0.06, y - 0.05, 0.68}, {0.14, y + 0.05, 0.9});
  b.use(gse_paint_white);
  add_box(b, {0, -1.275, 1.12}, {13.6, 1.275, 4.0});
  b.use(galvanised_steel);  // rear doors' frame and rods
  for (const double y : {-0.6, -0.2, 0.2, 0.6}) add_box(b, {-0.04, y - 0.02, 1.2}, {0, y + 0.02, 3.9});
  b.use(gse_paint_blue);
  add_plate(b, {{14.1, 0.55}, {16.35, 0.55}, {16.4, 1.6}, {16.15, 2.9}, {15.6, 3.6}, {14.1, 3.7}}, -1.22, 1.22);
  b.use(glass_clear_float_pane);
  add_patch(b, {16.43, -1.05, 1.75}, {16.43, 1.05, 1.75}, {16.21, 1.05, 2.85}, {16.21, -1.05, 2.85});
  b.use(gse_chassis);
  for (const double y : {-1.36, 1.24}) add_box(b, {15.9, y, 2.0}, {16.05, y + 0.12, 2.7});  // mirrors
  b.at(core::SE3::Identity());
}

void add_roller_bed(MeshBuilder& b) {
  b.use(galvanised_steel);
  for (const double x : {-1.0, 0.92}) {
    for (const double y : {-0.8, 0.72}) add_box(b, {x, y, 0}, {x + 0.08, y + 0.08, kRollerBedHeight_m - 0.1});
  }
  for (const double y : {-0.85, 0.77})
    add_box(b, {-1.05, y, kRollerBedHeight_m - 0.14}, {1.05, y + 0.08, kRollerBedHeight_m - 0.02});
  for (int k = 0; k < 6; ++k) {
    const double x = -0.9 + 0.36 * k;
    add_frustum(b, {x, -0.77, kRollerBedHeight_m - 0.05}, {x, 0.77, kRollerBedHeight_m - 0.05}, 0.05, 0.05, 10);
  }
}

void add_fence(MeshBuilder& b, const Ground& ground, const Vector2d& from_m, const Vector2d& to_m) {
  constexpr double pitch_m = 3, height_m = 2.3, arm_m = 0.4;
  const int bays = std::max(1, static_cast<int>(std::round((to_m - from_m).norm() / pitch_m)));
  const Vector2d along = (to_m - from_m).normalized(), out(-along.y(), along.x());
  const auto at = [&](int k) -> Vector3d {
    const Vector2d p = from_m + (to_m - from_m) * k / bays;
    return {p.x(), p.y(), ground.height_m(p.x(), p.y())};
  };
  const Vector3d arm(0.7 * arm_m * out.x(), 0.7 * arm_m * out.y(), 0.7 * arm_m);
  b.use(galvanised_steel);
  for (int k = 0; k <= bays; ++k) {
    const Vector3d foot = at(k), top = foot + Vector3d(0, 0, height_m);
    add_frustum(b, foot - Vector3d(0, 0, 0.3), top, 0.035, 0.035, 10);
    add_beam(b, top, top + arm, 0.04, 0.04);
    if (k == bays) break;
    const Vector3d next = at(k + 1);
    for (const double z : {0.1, 1.2, height_m - 0.05})
      add_beam(b, foot + Vector3d(0, 0, z), next + Vector3d(0, 0, z), 0.04, 0.04);
    for (const double share : {0.3, 0.65, 1.0}) {
      const Vector3d up = Vector3d(0, 0, height_m) + share * arm;
      add_beam(b, foot + up, next + up, 0.012, 0.012);
    }
  }
}

void add_barrier(MeshBuilder& b) {
  b.use(concrete_wall);
  std::vector<Ring> rings;
  for (const double x : {-1.5, 1.5}) {
    rings.push_back({{x, -0.3, 0},
                     {x, 0.3, 0},
                     {x, 0.3, 0.1},
                     {x, 0.13, 0.4},
                     {x, 0.09, 0.85},
                     {x, -0.09, 0.85},
                     {x, -0.13, 0.4},
                     {x, -0.3, 0.1}});
  }
  add_loft(b, rings);
}

}  // namespace tarmac::scenes
