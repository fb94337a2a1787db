#include "scenes/equipment/equipment.h"
#include "scenes/outdoors/outdoors.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

namespace {

struct CarSizes {
  double length_m, width_m, height_m, wheel_m, front_axle_m, rear_axle_m, belt_m, bonnet_m;
  std::vector<Vector2d> cabin;  ///< outline seen from the left, upon the belt line
};

/// Bonnet and boot lines fall away from the belt line; the cabin narrows towards the roof.
CarSizes sizes_of(CarShape shape) {
  switch (shape) {
    case CarShape::hatchback:
      return {4.1, 1.76, 1.48, 0.31, 1.28, -1.27, 0.93, 0.72, {{-1.98, 0.9}, {1.05, 0.9}, {0.25, 1.44}, {-1.55, 1.44}}};
    case CarShape::saloon:
      return {4.6, 1.82, 1.46, 0.32, 1.40, -1.40, 0.92, 0.72, {{-1.75, 0.9}, {1.10, 0.9}, {0.30, 1.42}, {-1.05, 1.42}}};
    case CarShape::van:
      return {5.3, 2.00, 2.25, 0.35, 1.75, -1.55, 1.25, 0.95, {{-2.62, 1.2}, {2.1, 1.2}, {1.35, 2.21}, {-2.62, 2.21}}};
  }
  return {};
}

/// A prism over the outline that narrows from `low_half_m` at its foot to `high_half_m` at its top.
void add_cabin(MeshBuilder& b, const std::vector<Vector2d>& outline, double low_half_m, double high_half_m) {
  double low = outline.front().y(), high = low;
  for (const Vector2d& p : outline) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  Ring right, left;
  for (const Vector2d& p : outline) {
    const double half = low_half_m + (high_half_m - low_half_m) * (p.y() - low) / (high - low);
    right.emplace_back(p.x(), -half, p.y());
    left.emplace_back(p.x(), half, p.y());
  }
  add_loft(b, {right, left});
}

}  // namespace

void add_car(MeshBuilder& b, CarShape shape, MaterialId paint) {
  const CarSizes s = sizes_of(shape);
  const double h = s.length_m / 2, w = s.width_m / 2;
  for (const double x : {s.front_axle_m, s.rear_axle_m}) {
    for (const double y : {-w + 0.1, w - 0.1}) add_road_wheel(b, x, y, s.wheel_m, 0.2);
  }
  b.use(gse_chassis);
  add_box(b, {-h + 0.15, -w + 0.28, 0.17}, {h - 0.15, w - 0.28, 0.35});
  b.use(paint);
  add_plate(b,
            {{-h + 0.04, 0.30},
             {h - 0.12, 0.27},
             {h, 0.42},
             {h - 0.03, s.bonnet_m},
             {s.cabin[1].x(), s.belt_m},
             {-h + 0.15, s.belt_m},
             {-h, 0.6}},
            -w + 0.05, w - 0.05);  // hubs stand 2 cm proud of it
  b.use(car_paint_dark);           // glass and what is behind it: dark, since little comes back from inside a car
  add_cabin(b, s.cabin, w - 0.06, w - 0.22);
  b.use(paint);
  const double roof = s.cabin[2].y();
  add_box(b, {s.cabin[3].x() + 0.04, -w + 0.25, roof - 0.01}, {s.cabin[2].x() - 0.04, w - 0.25, s.height_m});
  for (const double side : {-1.0, 1.0}) {  // mirrors
    add_box(b, {s.cabin[1].x() - 0.45, side > 0 ? w - 0.04 : -w - 0.14, s.belt_m + 0.02},
            {s.cabin[1].x() - 0.30, side > 0 ? w + 0.14 : -w + 0.04, s.belt_m + 0.16});
  }
  b.use(retro_sheeting_ra1);  // number plates
  add_box(b, {-h - 0.012, -0.26, 0.62}, {-h + 0.02, 0.26, 0.73});
  add_box(b, {h - 0.03, -0.26, 0.40}, {h + 0.006, 0.26, 0.51});
}

}  // namespace tarmac::scenes
