// Aircraft tractors, towbars, container handling.
#include <cmath>

#include "scenes/equipment/vehicle_parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

/// A low cab with windows all round.
void add_low_cab(MeshBuilder& b, double x0, double x1, double half_width, double low_z, double high_z) {
  b.use(gse_paint_white);
  add_plate(b, {{x0, low_z}, {x1, low_z}, {x1 - 0.15, high_z - 0.08}, {x0 + 0.12, high_z - 0.08}}, -half_width,
            half_width);
  add_box(b, {x0 + 0.05, -half_width - 0.04, high_z - 0.08}, {x1 - 0.08, half_width + 0.04, high_z});
  b.use(glass_clear_float_pane);
  const double z0 = low_z + 0.45 * (high_z - low_z), z1 = high_z - 0.14, off = 0.012, s = half_width - 0.1;
  const auto lean = [&](double z) { return (z - low_z) / (high_z - 0.08 - low_z); };
  const auto front = [&](double z) { return x1 - 0.15 * lean(z) + off; };
  const auto rear = [&](double z) { return x0 + 0.12 * lean(z) - off; };
  add_patch(b, {front(z0), -s, z0}, {front(z0), s, z0}, {front(z1), s, z1}, {front(z1), -s, z1});
  add_patch(b, {rear(z0), s, z0}, {rear(z0), -s, z0}, {rear(z1), -s, z1}, {rear(z1), s, z1});
  const double xa = x0 + 0.22, xb = x1 - 0.25, y = half_width + off;
  add_patch(b, {xb, y, z0}, {xa, y, z0}, {xa, y, z1}, {xb, y, z1});
  add_patch(b, {xa, -y, z0}, {xb, -y, z0}, {xb, -y, z1}, {xa, -y, z1});
}

}  // namespace

void add_pushback_tractor(MeshBuilder& b, bool wide) {
  const double end = wide ? 4.75 : 3.0, w = wide ? 1.65 : 1.35, axle = wide ? 2.6 : 1.9, r = wide ? 0.62 : 0.52;
  const double deck = wide ? 1.35 : 1.25, top = wide ? 2.0 : 2.35;
  for (const double x : {axle, -axle}) add_axle(b, x, w - 0.03, r, wide ? 0.50 : 0.42);
  b.use(gse_chassis);
  add_box(b, {-end + 0.15, -w + 0.6, 0.30}, {end - 0.15, w - 0.6, 0.75});
  b.use(gse_paint_yellow);  // body with wheel arches cut out, bonnet lower than the cab
  const double arch = r + 0.12;
  for (const double side : {-1.0, 1.0}) {
    const double y0 = std::min(side * w, side * (w - 0.55)), y1 = y0 + 0.55;
    for (const auto& [x0, x1] : {std::pair{-end, -axle - arch}, {-axle + arch, axle - arch}, {axle + arch, end}})
      add_box(b, {x0, y0, 0.32}, {x1, y1, deck - 0.08});
  }
  add_box(b, {-end, -w, deck - 0.08}, {end, w, deck});
  add_box(b, {-end, -w + 0.55, 0.55}, {end, w - 0.55, deck - 0.08});
  b.use(gse_chassis);
  for (const double x : {-end - 0.12, end}) {  // hitches
    add_box(b, {x, -0.25, 0.45}, {x + 0.12, 0.25, 0.62});
  }
  for (int k = 0; k < 5; ++k)
    add_box(b, {-end + 0.4 + 0.25 * k, -0.8, deck}, {-end + 0.5 + 0.25 * k, 0.8, deck + 0.02});
  add_low_cab(b, wide ? 2.2 : 0.3, wide ? 4.4 : 2.4, wide ? 1.1 : 1.15, deck, top);
  add_beacon(b, wide ? 3.2 : 1.2, 0, top);
}

void add_towbar(MeshBuilder& b, bool wide) {
  const double half = wide ? 2.75 : 2.0, z = 0.42, r = wide ? 0.09 : 0.07;
  for (const double y : {-0.45, 0.45}) add_road_wheel(b, -0.6, y, 0.22, 0.12);
  b.use(gse_chassis);
  add_beam(b, {-0.6, -0.45, 0.22}, {-0.6, 0.45, 0.22}, 0.06, 0.06);
  add_beam(b, {-0.6, 0, 0.22}, {-0.6, 0, z}, 0.08, 0.08);
  b.use(gse_paint_yellow);
  add_bar(b, {{-half + 0.2, 0, z}, {half - 0.35, 0, z}}, r, 16);
  b.use(galvanised_steel);  // towing eye at the tractor's end, head with two arms at the nose gear's end
  add_frustum(b, {-half + 0.12, 0, z - 0.04}, {-half + 0.12, 0, z + 0.04}, 0.12, 0.12, 20);
  add_box(b, {half - 0.4, -0.22, z - 0.09}, {half - 0.2, 0.22, z + 0.09});
  for (const double y : {-0.18, 0.18}) add_box(b, {half - 0.2, y - 0.04, z - 0.06}, {half, y + 0.04, z + 0.06});
}

void add_towbarless_tractor(MeshBuilder& b) {
  constexpr double w = 2.0, front = 4.25, rear = -4.25;
  add_axle(b, 2.4, w - 0.08, 0.6, 0.5);
  add_axle(b, -2.1, w - 0.03, 0.6, 0.45);
  b.use(gse_chassis);
  add_box(b, {-0.3, -1.2, 0.28}, {4.0, 1.2, 0.6});
  b.use(gse_paint_yellow);
  add_box(b, {-0.4, -w, 0.95 + 0.3}, {front, w, 1.4});
  for (const double side : {-1.0, 1.0}) {
    const auto box = [&](double x0, double x1, double inner, double z0, double z1) {
      add_box(b, {x0, std::min(side * inner, side * w), z0}, {x1, std::max(side * inner, side * w), z1});
    };
    box(3.15, front, 1.2, 0.35, 1.25);
    box(-0.4, 1.65, 1.2, 0.35, 1.25);
    box(rear, -0.4, 0.9, 1.22, 1.40);  // arms over the rear wheels, open between them
    box(rear, -2.85, 0.9, 0.35, 1.22);
    box(-1.35, -0.4, 0.9, 0.35, 1.22);
  }
  add_box(b, {-0.4, -1.2, 0.6}, {4.0, 1.2, 1.25});
  b.use(galvanised_steel);  // cradle that lifts the nose wheels
  add_box(b, {-2.3, -0.85, 0.12}, {-0.6, 0.85, 0.24});
  add_plate(b, {{-0.85, 0.24}, {-0.55, 0.24}, {-0.55, 1.0}, {-0.65, 1.0}}, -0.8, 0.8);
  for (const double y : {-0.75, 0.65}) add_box(b, {-2.35, y, 0.24}, {-2.2, y + 0.1, 0.7});
  add_low_cab(b, 1.7, 4.0, 1.3, 1.4, 2.2);
  add_beacon(b, 2.6, 0, 2.2);
}

void add_container_loader(MeshBuilder& b, double platform_z_m) {
  constexpr double w = 1.95;
  for (const double x : {3.2, -1.4}) add_axle(b, x, 1.45, 0.38, 0.36);
  b.use(gse_chassis);
  for (const double y : {-0.9, 0.6}) add_box(b, {-4.1, y, 0.28}, {4.1, y + 0.3, 0.48});
  b.use(gse_paint_white);  // engine housing and driver's place beside the platforms
  add_box(b, {-0.4, 1.55, 0.45}, {3.6, w, 1.35});
  const double z = platform_z_m;
  b.use(gse_paint_yellow);
  add_box(b, {-4.25, -w, z - 0.16}, {1.2, 1.5, z});  // main platform
  add_box(b, {1.35, -w, z - 0.14}, {4.25, 1.5, z});  // bridge platform, towards the aircraft
  b.use(galvanised_steel);                           // rollers
  for (double x = -4.0; x < 4.1; x += 0.35) {
    if (x > 1.0 && x < 1.5) continue;
    add_frustum(b, {x, -1.6, z + 0.01}, {x, 1.2, z + 0.01}, 0.04, 0.04, 8);
  }
  b.use(gse_chassis);  // scissors under both
  for (const double y : {-1.2, 0.9}) {
    add_beam(b, {-3.6, y, 0.48}, {0.6, y, z - 0.16}, 0.12, 0.14);
    add_beam(b, {0.6, y + 0.14, 0.48}, {-3.6, y + 0.14, z - 0.16}, 0.12, 0.14);
    add_beam(b, {1.6, y, 0.48}, {3.9, y, z - 0.14}, 0.10, 0.12);
    add_beam(b, {3.9, y + 0.14, 0.48}, {1.6, y + 0.14, z - 0.14}, 0.10, 0.12);
  }
  b.use(gse_paint_yellow);
  for (const double y : {-w + 0.03, 1.47}) {
    // The rails end before the platform does: beside them the fuselage bulges out.
    add_beam(b, {1.4, y, z + 1.1}, {3.5, y, z + 1.1}, 0.05, 0.10);
    for (const double x : {1.42, 2.45, 3.48}) add_beam(b, {x, y, z - 0.02}, {x, y, z + 1.08}, 0.05, 0.05);
  }
  b.use(gse_paint_white);
  add_box(b, {2.2, 1.52, z + 0.3}, {2.7, w, z + 1.05});  // operator's console
  add_box(b, {1.5, 1.5, z - 0.1}, {3.4, w, z});
}

void add_uld(MeshBuilder& b) {
  // AKE: full width 2.007 above a base of 1.562, chamfered on one side.
  b.use(polished_aluminium);
  add_plate(b, {{-1.0035, 0}, {0.5585, 0}, {1.0035, 0.49}, {1.0035, 1.626}, {-1.0035, 1.626}}, -0.759, 0.759);
  b.use(cart_curtain);
  add_box(b, {-0.8, 0.759, 0.12}, {0.5, 0.767, 1.5});
  b.use(galvanised_steel);
  add_box(b, {-0.95, -0.767, 1.5}, {0.95, -0.759, 1.58});
}

}  // namespace tarmac::scenes
