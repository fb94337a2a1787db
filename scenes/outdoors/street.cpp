#include <Eigen/Geometry>

#include "scenes/outdoors/outdoors.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

void add_street_lamp(MeshBuilder& b, double height_m, double reach_m) {
  b.use(galvanised_steel);
  add_frustum(b, {0, 0, -0.3}, {0, 0, 1.2}, 0.09, 0.09, 14);
  add_frustum(b, {0, 0, 1.2}, {0, 0, height_m}, 0.075, 0.045, 14);
  if (reach_m > 0) add_beam(b, {0, 0, height_m - 0.08}, {reach_m, 0, height_m + 0.1}, 0.06, 0.06);
  b.use(gse_chassis);
  add_box(b, {reach_m - 0.35, -0.14, height_m}, {reach_m + 0.35, 0.14, height_m + 0.16});
  add_box(b, {0.07, -0.07, 0.5}, {0.1, 0.07, 0.95});  // hatch
}

void add_round_sign(MeshBuilder& b) {
  b.use(galvanised_steel);
  add_frustum(b, {0, 0, -0.3}, {0, 0, 2.5}, 0.03, 0.03, 12);
  add_frustum(b, {-0.034, 0, 2.2}, {-0.03, 0, 2.2}, 0.3, 0.3, 24);
  b.use(retro_sheeting_ra1);
  add_frustum(b, {-0.036, 0, 2.2}, {-0.034, 0, 2.2}, 0.29, 0.29, 24);
}

void add_panel_sign(MeshBuilder& b, double width_m, double height_m, double foot_m) {
  const double half = width_m / 2, top = foot_m + height_m;
  b.use(galvanised_steel);
  for (const double y : {-0.32 * width_m, 0.32 * width_m}) {
    add_beam(b, {0.08, y, -0.4}, {0.08, y, top - 0.1}, 0.12, 0.12);
  }
  for (const double z : {foot_m + 0.25 * height_m, foot_m + 0.75 * height_m}) {
    add_box(b, {0, -half + 0.1, z - 0.03}, {0.02, half - 0.1, z + 0.03});
  }
  add_box(b, {-0.03, -half, foot_m}, {0, half, top});
  b.use(retro_sheeting_ra1);
  add_box(b, {-0.033, -half + 0.02, foot_m + 0.02}, {-0.03, half - 0.02, top - 0.02});
}

void add_bollard(MeshBuilder& b) {
  b.use(gse_chassis);
  add_frustum(b, {0, 0, -0.2}, {0, 0, 0.95}, 0.05, 0.05, 14);
}

void add_litter_bin(MeshBuilder& b) {
  b.use(painted_steel);
  add_box(b, {-0.2, -0.2, 0}, {0.2, 0.2, 0.9});
  b.use(gse_chassis);
  add_box(b, {-0.22, -0.22, 0.93}, {0.22, 0.22, 1.0});
  for (const double y : {-0.19, 0.19}) add_box(b, {-0.02, y - 0.01, 0.9}, {0.02, y + 0.01, 0.93});
}

void add_bench(MeshBuilder& b) {
  b.use(gse_chassis);
  for (const double y : {-0.7, 0.7}) {
    add_box(b, {-0.22, y - 0.03, 0}, {-0.16, y + 0.03, 0.85});
    add_box(b, {0.16, y - 0.03, 0}, {0.22, y + 0.03, 0.42});
    add_box(b, {-0.16, y - 0.03, 0.38}, {0.16, y + 0.03, 0.42});
  }
  b.use(wood);
  for (const double x : {-0.17, -0.03, 0.11}) add_box(b, {x, -0.9, 0.42}, {x + 0.11, 0.9, 0.46});
  for (const double z : {0.58, 0.72}) add_box(b, {-0.16, -0.9, z}, {-0.12, 0.9, z + 0.1});
}

void add_delineator(MeshBuilder& b) {
  b.use(gse_paint_white);
  add_box(b, {-0.04, -0.06, -0.2}, {0.04, 0.06, 1.05});
  b.use(retro_sheeting_ra1);
  for (const double side : {-1.0, 1.0}) {
    const double face = side * 0.04, out = side * 0.043;
    add_box(b, {std::min(face, out), -0.025, 0.75}, {std::max(face, out), 0.025, 0.93});
  }
}

void add_w_beam(MeshBuilder& b, const std::vector<Vector3d>& rail) {
  // Depth to the left by height: two waves. 3 mm of steel, and back along the other side.
  constexpr double thickness_m = 0.003;
  const std::vector<Vector2d> face{{0.01, -0.155}, {0.08, -0.125}, {0.08, -0.055}, {0.0, -0.02},
                                   {0.0, 0.02},    {0.08, 0.055},  {0.08, 0.125},  {0.01, 0.155}};
  std::vector<Ring> rings;
  for (std::size_t k = 0; k < rail.size(); ++k) {
    const Vector3d ahead = (rail[std::min(k + 1, rail.size() - 1)] - rail[k > 0 ? k - 1 : 0]).normalized();
    const Vector3d left = Vector3d::UnitZ().cross(ahead).normalized();
    Ring ring;
    for (const Vector2d& p : face) ring.push_back(rail[k] + p.x() * left + p.y() * Vector3d::UnitZ());
    for (auto p = face.rbegin(); p != face.rend(); ++p) {
      ring.push_back(rail[k] + (p->x() - thickness_m) * left + p->y() * Vector3d::UnitZ());
    }
    rings.push_back(std::move(ring));
  }
  b.use(galvanised_steel);
  add_loft(b, rings);
}

}  // namespace tarmac::scenes
