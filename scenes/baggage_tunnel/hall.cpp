#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/baggage_tunnel/layout.h"
#include "scenes/equipment/equipment.h"
#include "scenes/paving/strips.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double pi = std::numbers::pi;

void add_walls(MeshBuilder& b, const BaggageTunnelLayout& l, double clear_m) {
  const double w = l.wall_m, x0 = -l.hall_length_m, y0 = l.hall_half_m, low = -0.3, high = clear_m + 0.1;
  b.use(concrete_wall);
  add_box(b, {x0 - w, -y0 - w, low}, {x0, y0 + w, high});
  for (const double side : {-1.0, 1.0}) {
    add_box(b, {x0, std::min(side * y0, side * (y0 + w)), low}, {w, std::max(side * y0, side * (y0 + w)), high});
    // Eastern wall on both sides of the tunnel's mouth.
    add_box(b, {0, std::min(side * l.half_m, side * y0), low}, {w, std::max(side * l.half_m, side * y0), high});
  }
  add_box(b, {0, -l.half_m, l.height_m}, {w, l.half_m, high});
}

/// A loop of belt, 1.2 m wide and 0.5 m high, of two straights along x and two half turns.
void add_carousel(MeshBuilder& b, const Ground& ground, double x_m, double y_m, double straight_m) {
  StartOptions start;
  start.x_m = x_m - straight_m / 2;
  PathPiece straight, turn;
  straight.straight_m = straight_m;
  turn.turn_deg = 180;
  turn.radius_m = 1.4;
  turn.blend_m = 1;
  const std::vector<PathPiece> loop{straight, turn, straight, turn};
  // How wide the loop is follows from where its first half ends: its middle shall be y_m.
  start.y_m = y_m - 0.5 * CentreLine(start, {straight, turn, straight}).at(2 * straight_m).p_m.y();
  const CentreLine line(start, loop);
  b.use(painted_steel);
  add_swept(b, ground, line, 0, line.length_m(), rectangle_outline(-0.6, -0.05, 0.6, 0.42), 0.4);
  b.use(tyre_rubber);
  add_swept(b, ground, line, 0, line.length_m(), rectangle_outline(-0.5, 0.40, 0.5, 0.46), 0.4);
  b.use(galvanised_steel);
  for (const double d : {-0.6, 0.56})
    add_swept(b, ground, line, 0, line.length_m(), rectangle_outline(d, 0.40, d + 0.04, 0.55), 0.4);
}

void add_doors(Assembly& a, const BaggageTunnelLayout& l, const BaggageTunnelOptions& o) {
  const std::uint32_t door = a.mesh("hall_door", [](MeshBuilder& b) { add_roller_door(b, 4, 3.5); });
  const double p = o.column_pitch_m;
  for (int k = 1; k < 7; k += 2) {  // between columns
    a.found(door, Label::building, -p * (k + 1), l.hall_half_m, -pi / 2);
    a.found(door, Label::building, -p * (k + 1), -l.hall_half_m, pi / 2);
  }
  for (const double y : {-p, p}) a.found(door, Label::building, -l.hall_length_m, y, 0);
}

/// Between the columns of the rows beside the carousels.
void add_carts(Assembly& a, const BaggageTunnelOptions& o, std::uint64_t seed) {
  if (o.carts == 0) return;
  const core::RandomStream random(seed, "scenes/baggage_tunnel/carts");
  const std::uint32_t cart = a.mesh("baggage_cart", [](MeshBuilder& b) { add_baggage_cart(b); });
  const double p = o.column_pitch_m;
  for (int k = 0; k < o.carts; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double x = -p * (1 + k / 2) - 0.5, y = (k % 2 == 0 ? 1.0 : -1.0) * 1.5 * p;
    a.stand(cart, Label::ground_equipment, x + 0.2 * (random.uniform(i, 0) - 0.5),
            y + 0.15 * (random.uniform(i, 1) - 0.5), 0.06 * (random.uniform(i, 2) - 0.5));
  }
}

}  // namespace

void add_roller_door(MeshBuilder& b, double width_m, double height_m) {
  const double h = width_m / 2;
  b.use(roller_shutter);
  add_box(b, {-0.05, -h, -0.1}, {0.03, h, height_m});
  constexpr double slat_m = 0.25;
  for (double z = slat_m; z < height_m - 0.05; z += slat_m) add_box(b, {0.02, -h, z - 0.015}, {0.045, h, z + 0.015});
  b.use(galvanised_steel);
  for (const double side : {-1.0, 1.0})
    add_box(b, {-0.05, std::min(side * h, side * (h + 0.12)), -0.1},
            {0.1, std::max(side * h, side * (h + 0.12)), height_m});
  add_box(b, {-0.05, -h - 0.12, height_m}, {0.12, h + 0.12, height_m + 0.2});
}

void add_baggage_hall(Assembly& a, const BaggageTunnelLayout& l, const BaggageTunnelOptions& o, const Ground& ground,
                      std::uint64_t seed) {
  MeshBuilder floor("hall_floor"), walls("hall_walls");
  floor.use(concrete_dry);
  add_ground_region(floor, ground, {-l.hall_length_m, -l.hall_half_m}, {0, l.hall_half_m});
  add_walls(walls, l, o.hall_clear_m);
  walls.use(concrete_wall);
  const double p = o.column_pitch_m, c = o.column_m / 2;
  for (int i = 0; i < 8; ++i) {
    for (int j = -3; j < 3; ++j) {
      const double x = -p * (i + 0.5), y = p * (j + 0.5);
      add_box(walls, {x - c, y - c, -0.2}, {x + c, y + c, o.hall_clear_m + 0.05});
    }
  }
  a.put(a.mesh(std::move(floor).build()), Label::pavement);
  a.put(a.mesh(std::move(walls).build()), Label::building);
  a.put(a.mesh("hall_ceiling",
               [&](MeshBuilder& b) {
                 b.use(concrete_wall);
                 const double y = l.hall_half_m + l.wall_m;
                 add_box(b, {-l.hall_length_m - l.wall_m, -y, o.hall_clear_m}, {l.wall_m, y, o.hall_clear_m + 0.4});
               }),
        Label::building);
  if (o.carousels > 0) {
    MeshBuilder loops("carousels");
    const std::array<double, 4> rows{p, -p, 2 * p, -2 * p};
    for (int k = 0; k < o.carousels; ++k)
      add_carousel(loops, ground, -0.55 * l.hall_length_m, rows[static_cast<std::size_t>(k)], 0.5 * l.hall_length_m);
    a.put(a.mesh(std::move(loops).build()), Label::other);
  }
  add_doors(a, l, o);
  add_carts(a, o, seed);
}

}  // namespace tarmac::scenes
