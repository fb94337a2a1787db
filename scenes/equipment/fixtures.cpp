#include <cmath>
#include <numbers>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

using enum MaterialId;

void add_traffic_cone(MeshBuilder& b) {
  core::SE3 upright = core::SE3::Identity();
  upright.linear() = Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  b.use(gse_chassis);
  add_box(b, {-0.2, -0.2, 0}, {0.2, 0.2, 0.04});
  b.at(upright);  // the lathe's axis becomes the vertical
  add_lathe(b,
            {{0.035, 0.16, cone_orange},
             {0.20, 0.133, cone_orange},
             {0.25, 0.125, retro_sheeting_ra1},
             {0.40, 0.100, retro_sheeting_ra1},
             {0.45, 0.092, cone_orange},
             {0.54, 0.077, retro_sheeting_ra1},
             {0.62, 0.063, cone_orange},
             {0.75, 0.040, cone_orange},
             {0.75, 0, cone_orange}},
            20);
  b.at(core::SE3::Identity());
}

void add_chock(MeshBuilder& b) {
  b.use(gse_paint_yellow);
  add_plate(b, {{-0.10, 0}, {0.10, 0}, {0.03, 0.15}, {-0.03, 0.15}}, -0.25, 0.25);
}

void add_lighting_mast(MeshBuilder& b, double height_m) {
  b.use(concrete_wall);
  add_box(b, {-0.8, -0.8, -0.5}, {0.8, 0.8, 0.9});
  b.use(galvanised_steel);
  constexpr int sections = 5;
  for (int k = 0; k < sections; ++k) {
    const auto z = [&](int i) { return 0.9 + (height_m - 0.9) * i / sections; };
    const auto r = [&](int i) { return 0.45 - 0.30 * i / sections; };
    add_frustum(b, {0, 0, z(k)}, {0, 0, z(k + 1) + (k + 1 < sections ? 0.3 : 0.0)}, r(k), r(k + 1), 20);
  }
  const double top = height_m - 0.4;
  add_beam(b, {-2.4, -0.35, top}, {2.4, -0.35, top}, 0.12, 0.14);
  add_beam(b, {-2.4, -0.35, top - 0.9}, {2.4, -0.35, top - 0.9}, 0.12, 0.14);
  for (const double x : {-2.2, 0.0, 2.2}) add_beam(b, {x, -0.35, top - 0.9}, {x, -0.35, top}, 0.08, 0.08);
  for (const double z : {top - 0.35, top - 1.25}) add_beam(b, {0, 0, z + 0.3}, {0, -0.35, z + 0.3}, 0.2, 0.12);
  for (const double z : {top, top - 0.9}) {
    for (int k = -2; k <= 2; ++k) {  // lamps look down and out
      const Eigen::Vector3d at(1.0 * k, -0.5, z - 0.28);
      b.use(gse_chassis);
      add_beam(b, at + Eigen::Vector3d(0, 0.12, 0.10), at + Eigen::Vector3d(0, -0.12, -0.06), 0.6, 0.45);
      b.use(galvanised_steel);
      add_beam(b, at + Eigen::Vector3d(0, 0.15, 0.28), at + Eigen::Vector3d(0, 0.10, 0.08), 0.06, 0.06);
    }
  }
}

}  // namespace tarmac::scenes
