#include "scenes/equipment/vehicle_parts.h"

#include <cmath>
#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

void add_axle(MeshBuilder& b, double x_m, double half_width_m, double radius_m, double width_m) {
  for (const double side : {-1.0, 1.0}) add_road_wheel(b, x_m, side * (half_width_m - width_m / 2), radius_m, width_m);
}

void add_truck_cab(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double low_z_m, double high_z_m,
                   const std::optional<WheelArch>& arch) {
  constexpr double room_m = 0.08;
  const double w = half_width_m, sill = low_z_m + 0.45 * (high_z_m - low_z_m), rake = 0.22;
  const double body_z_m = arch ? 2 * arch->wheel_radius_m + room_m : low_z_m;
  if (arch) {  // below the arch's top, before and behind it
    const double front = arch->axle_x_m + arch->wheel_radius_m + room_m, rear = 2 * arch->axle_x_m - front;
    add_box(b, {front, -w, low_z_m}, {x1_m, w, body_z_m});
    if (rear > x0_m + 0.1) add_box(b, {x0_m, -w, low_z_m}, {rear, w, body_z_m});
  }
  add_plate(b,
            {{x0_m, body_z_m},
             {x1_m, body_z_m},
             {x1_m, sill},
             {x1_m - rake, high_z_m - 0.06},
             {x1_m - rake - 0.15, high_z_m},
             {x0_m, high_z_m}},
            -w, w);
  b.use(glass_clear_float_pane);
  const double off = 0.012, z0 = sill + 0.06, z1 = high_z_m - 0.16;
  const auto front = [&](double z) { return x1_m - rake * (z - sill) / (high_z_m - 0.06 - sill) + off; };
  const double s = w - 0.12;
  add_patch(b, {front(z0), -s, z0}, {front(z0), s, z0}, {front(z1), s, z1}, {front(z1), -s, z1});
  const double xa = x1_m - 1.15, xb = x1_m - rake - 0.15;
  add_patch(b, {xb, w + off, z0}, {xa, w + off, z0}, {xa, w + off, z1}, {xb - 0.08, w + off, z1});
  add_patch(b, {xa, -w - off, z0}, {xb, -w - off, z0}, {xb - 0.08, -w - off, z1}, {xa, -w - off, z1});
  b.use(gse_chassis);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (w + 0.12);
    add_box(b, {x1_m - 0.30, y - 0.09, z0 + 0.1}, {x1_m - 0.22, y + 0.09, z0 + 0.5});
    add_beam(b, {x1_m - 0.26, side * (w - 0.02), z0 + 0.5}, {x1_m - 0.26, y, z0 + 0.45}, 0.03, 0.03);
  }
}

void add_guard_rail(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double floor_z_m, double height_m) {
  const double w = half_width_m - 0.025, top = floor_z_m + height_m - 0.025;
  const int posts = std::max(1, static_cast<int>(std::ceil((x1_m - x0_m) / 1.2)));
  for (const double y : {-w, w}) {
    for (int k = 0; k <= posts; ++k) {
      const double x = x0_m + 0.025 + (x1_m - x0_m - 0.05) * k / posts;
      add_beam(b, {x, y, floor_z_m - 0.03}, {x, y, top}, 0.05, 0.05);
    }
    for (const double z : {top, floor_z_m + 0.5 * height_m}) add_beam(b, {x0_m, y, z}, {x1_m, y, z}, 0.05, 0.05);
  }
}

void add_beacon(MeshBuilder& b, double x_m, double y_m, double z_m) {
  b.use(cone_orange);
  add_frustum(b, {x_m, y_m, z_m - 0.01}, {x_m, y_m, z_m + 0.12}, 0.07, 0.05, 12);
}

void add_tank(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double low_z_m, double high_z_m) {
  const double z = (low_z_m + high_z_m) / 2, h = (high_z_m - low_z_m) / 2;
  std::vector<Ring> rings;
  // Dished ends.
  for (const auto& [share, size] :
       {std::pair{0.0, 0.55}, {0.012, 0.86}, {0.04, 1.0}, {0.5, 1.0}, {0.96, 1.0}, {0.988, 0.86}, {1.0, 0.55}}) {
    Ring ring;
    constexpr int around = 32;
    for (int j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * j / around, c = std::cos(a), d = std::sin(a);
      const double squarish = 1 / std::pow(std::pow(std::abs(c), 3.0) + std::pow(std::abs(d), 3.0), 1 / 3.0);
      ring.emplace_back(x0_m + (x1_m - x0_m) * share, half_width_m * size * squarish * c, z + h * size * squarish * d);
    }
    rings.push_back(std::move(ring));
  }
  add_loft(b, rings);
}

}  // namespace tarmac::scenes
