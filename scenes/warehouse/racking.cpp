#include "scenes/warehouse/racking.h"

#include <algorithm>

#include "core/random.h"
#include "scenes/equipment/equipment.h"
#include "scenes/warehouse/layout.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;
namespace l = warehouse_layout;

namespace {

constexpr double kPost_m = 0.09, kBeam_m = 0.12, kPallet_m = 0.144;

/// Two posts, a cross-tie at foot and head, diagonals between.
void add_frame(MeshBuilder& b, double x, double height_m) {
  b.use(gse_paint_blue);
  const double back = l::rack_depth_m - kPost_m / 2, front = kPost_m / 2;
  for (const double y : {front, back}) {
    add_box(b, {x - kPost_m / 2, y - kPost_m / 2, -0.02}, {x + kPost_m / 2, y + kPost_m / 2, height_m});
  }
  constexpr double step_m = 1.2;
  for (double z = 0.2; z + step_m < height_m; z += step_m) {
    const bool forward = static_cast<int>(z / step_m) % 2 == 0;
    add_beam(b, {x, forward ? front : back, z}, {x, forward ? back : front, z + step_m}, 0.03, 0.04);
  }
}

}  // namespace

void add_racking(MeshBuilder& b, const WarehouseOptions& options) {
  const double half = l::rack_length_m(options) / 2;
  const double top = (options.levels - 1) * options.level_height_m;
  for (int k = 0; k <= options.bays; ++k) add_frame(b, -half + k * l::bay_m, top + 1.3);
  b.use(steel_orange);
  for (int level = 1; level < options.levels; ++level) {
    const double z = level * options.level_height_m;
    for (int k = 0; k < options.bays; ++k) {
      const double left = -half + k * l::bay_m + kPost_m / 2, right = left + l::bay_m - kPost_m;
      for (const double y : {0.0, l::rack_depth_m - 0.05}) add_box(b, {left, y, z - kBeam_m}, {right, y + 0.05, z});
    }
  }
}

void add_pallet(MeshBuilder& b, double x_m, double y_m, double z_m, double height_m, double look, double size) {
  b.use(wood);
  for (const double y : {-0.55, -0.07, 0.41}) {  // runners and blocks as one
    add_box(b, {x_m - 0.4, y_m + y, z_m}, {x_m + 0.4, y_m + y + 0.14, z_m + 0.122});
  }
  add_box(b, {x_m - 0.4, y_m - 0.6, z_m + 0.122}, {x_m + 0.4, y_m + 0.6, z_m + kPallet_m});
  if (height_m <= 0) return;
  const double hx = 0.40 - 0.06 * size, hy = 0.60 - 0.10 * size, foot = z_m + kPallet_m;
  if (look < 0.45) {  // cartons in two or three layers, each drawn in by a finger's breadth in turn
    b.use(cardboard);
    const int layers = height_m > 0.9 ? 3 : 2;
    for (int k = 0; k < layers; ++k) {
      const double in = k % 2 == 0 ? 0 : 0.012;
      add_box(b, {x_m - hx + in, y_m - hy + in, foot + height_m * k / layers},
              {x_m + hx - in, y_m + hy - in, foot + height_m * (k + 1) / layers});
    }
  } else if (look < 0.65) {  // a wrapped stack
    b.use(gse_paint_white);
    add_box(b, {x_m - hx, y_m - hy, foot}, {x_m + hx, y_m + hy, foot + height_m});
  } else if (look < 0.8) {  // a crate
    b.use(wood);
    add_box(b, {x_m - hx, y_m - hy, foot}, {x_m + hx, y_m + hy, foot + height_m});
  } else if (look < 0.92) {  // two stacks of unlike height
    b.use(cardboard);
    add_box(b, {x_m - hx, y_m - hy, foot}, {x_m + hx, y_m - 0.02, foot + height_m});
    add_box(b, {x_m - hx, y_m + 0.02, foot}, {x_m + hx, y_m + hy, foot + 0.6 * height_m});
  } else {  // drums
    b.use(gse_paint_blue);
    for (const double y : {-0.3, 0.3}) {
      add_frustum(b, {x_m, y_m + y, foot}, {x_m, y_m + y, foot + std::min(height_m, 0.9)}, 0.28, 0.28, 14);
    }
  }
}

void add_goods(MeshBuilder& b, const WarehouseOptions& options, int row, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/warehouse/goods");
  const double half = l::rack_length_m(options) / 2, v = options.load_variation;
  constexpr int kPlaces = 3;
  std::uint64_t place = static_cast<std::uint64_t>(row) << 32;
  for (int bay = 0; bay < options.bays; ++bay) {
    for (int level = 0; level < options.levels; ++level) {
      for (int k = 0; k < kPlaces; ++k, ++place) {
        const auto draw = [&](std::uint32_t j) { return random.uniform(place, j); };
        if (draw(0) > options.fill) continue;
        const double x = -half + (bay + 0.5) * l::bay_m + (k - 1) * 0.88 + v * 0.03 * (2 * draw(1) - 1);
        const double y = l::rack_depth_m / 2 + v * 0.04 * (2 * draw(2) - 1);
        const double tallest = options.level_height_m - kBeam_m - kPallet_m - 0.15;
        const double height = tallest * (1 - v * 0.55 * draw(3));
        add_pallet(b, x, y, level * options.level_height_m, height, v > 0 ? draw(4) : 0, v * draw(5));
      }
    }
  }
}

void add_fork_lift(MeshBuilder& b) {
  for (const double y : {-0.48, 0.48}) {
    add_road_wheel(b, 0.55, y, 0.30, 0.18);
    add_road_wheel(b, -0.85, y, 0.24, 0.16);
  }
  b.use(gse_paint_yellow);
  add_box(b, {-1.3, -0.5, 0.22}, {0.35, 0.5, 0.95});
  b.use(gse_chassis);
  add_box(b, {-1.42, -0.5, 0.35}, {-1.3, 0.5, 1.05});
  add_box(b, {-0.75, -0.28, 0.95}, {-0.3, 0.28, 1.1});
  add_box(b, {-0.82, -0.26, 1.0}, {-0.72, 0.26, 1.55});
  for (const double x : {-1.0, 0.3}) {
    for (const double y : {-0.45, 0.45}) add_beam(b, {x, y, 0.9}, {x, y, 2.12}, 0.06, 0.06);
  }
  add_box(b, {-1.05, -0.5, 2.12}, {0.36, 0.5, 2.18});
  for (const double y : {-0.34, 0.34}) add_box(b, {0.72, y - 0.05, 0.08}, {0.84, y + 0.05, 2.1});
  for (const double z : {0.45, 1.2, 1.95}) add_box(b, {0.74, -0.34, z}, {0.80, 0.34, z + 0.1});
  b.use(galvanised_steel);
  for (const double y : {-0.27, 0.27}) {
    add_box(b, {0.84, y - 0.06, 0.06}, {0.89, y + 0.06, 0.55});
    add_box(b, {0.84, y - 0.06, 0.06}, {2.0, y + 0.06, 0.10});
  }
}

}  // namespace tarmac::scenes
