// A hall of racking: aisles that are all alike, which is what place recognition and ICP along an aisle stumble over.
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/primitives/ground_patch.h"
#include "scenes/registry.h"
#include "scenes/warehouse/layout.h"
#include "scenes/warehouse/racking.h"

namespace tarmac::scenes {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using enum MaterialId;
namespace l = warehouse_layout;

constexpr double kWall_m = 0.2, kFoot_m = -0.15;
constexpr double kDoorWidth_m = 3.0, kDoorHeight_m = 3.4;

/// Left edges of the loading doors, evenly along the eastern wall.
std::vector<double> dock_doors(const WarehouseOptions& o) {
  std::vector<double> doors;
  const double half = l::half_width_m(o) - 1.5;
  const int fit = static_cast<int>(2 * half / (kDoorWidth_m + 1));
  const int count = std::min(o.docks, fit);
  for (int k = 0; k < count; ++k) doors.push_back(-half + 2 * half * (k + 0.5) / count - kDoorWidth_m / 2);
  return doors;
}

/// A sectional door a hand's breadth inside the wall's face, its rails, and rubber bumpers.
void add_dock(MeshBuilder& b, double x, double y) {
  b.use(roller_shutter);
  for (int k = 0; k < 6; ++k) {  // panels, each with a rib
    const double z = 0.02 + k * kDoorHeight_m / 6;
    add_box(b, {x + 0.02, y, z}, {x + 0.08, y + kDoorWidth_m, z + kDoorHeight_m / 6 - 0.01});
    add_box(b, {x, y, z + 0.22}, {x + 0.02, y + kDoorWidth_m, z + 0.30});
  }
  b.use(galvanised_steel);
  for (const double rail : {y - 0.1, y + kDoorWidth_m}) {
    add_box(b, {x - 0.08, rail, kFoot_m}, {x + 0.08, rail + 0.1, kDoorHeight_m + 1.2});
  }
  b.use(gse_paint_yellow);
  for (const double post : {y - 0.45, y + kDoorWidth_m + 0.45}) {
    add_frustum(b, {x - 0.6, post, kFoot_m}, {x - 0.6, post, 1.1}, 0.08, 0.08, 14);
  }
}

void add_hall(Assembly& a, const WarehouseOptions& o) {
  const double w = l::west_m(o), e = l::east_m(o), half = l::half_width_m(o), roof = l::roof_m(o);
  MeshBuilder walls("hall_walls"), docks("docks");
  walls.use(facade_panel);
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * half, outer = side * (half + kWall_m);
    add_box(walls, {w - kWall_m, std::min(inner, outer), kFoot_m}, {e + kWall_m, std::max(inner, outer), roof});
  }
  add_box(walls, {w - kWall_m, -half, kFoot_m}, {w, half, roof});
  double from = -half;
  for (const double door : dock_doors(o)) {
    walls.use(facade_panel);
    add_box(walls, {e, from, kFoot_m}, {e + kWall_m, door, roof});
    add_box(walls, {e, door, kDoorHeight_m}, {e + kWall_m, door + kDoorWidth_m, roof});
    add_dock(docks, e, door);
    from = door + kDoorWidth_m;
  }
  walls.use(facade_panel);
  add_box(walls, {e, from, kFoot_m}, {e + kWall_m, half, roof});
  a.put(a.mesh(std::move(walls).build()), Label::building);
  if (docks.triangle_count() > 0) a.put(a.mesh(std::move(docks).build()), Label::building);

  MeshBuilder lid("hall_ceiling"), lamps("lamps_ceiling");
  lid.use(roller_shutter);
  add_box(lid, {w - kWall_m, -half - kWall_m, roof}, {e + kWall_m, half + kWall_m, roof + 0.2});
  lid.use(galvanised_steel);
  for (double x = w + 3; x < e; x += 6) {  // trusses
    add_box(lid, {x - 0.08, -half, roof - 0.12}, {x + 0.08, half, roof});
    add_box(lid, {x - 0.08, -half, roof - 1.0}, {x + 0.08, half, roof - 0.9});
    const int panels = std::max(2, static_cast<int>(half / 2));
    for (int k = 0; k < panels; ++k) {
      const double y = -half + 2 * half * k / panels, next = -half + 2 * half * (k + 1) / panels;
      add_beam(lid, {x, y, k % 2 == 0 ? roof - 0.95 : roof - 0.1}, {x, next, k % 2 == 0 ? roof - 0.1 : roof - 0.95},
               0.06, 0.06);
    }
  }
  a.put(a.mesh(std::move(lid).build()), Label::building);
  lamps.use(gse_paint_white);
  for (int k = 0; k < o.aisles; ++k) {
    for (double x = w + 4.5; x < e - 1.5; x += 6) {
      const double y = l::aisle_y_m(o, k);
      add_box(lamps, {x - 0.75, y - 0.12, roof - 1.2}, {x + 0.75, y + 0.12, roof - 1.1});
    }
  }
  a.put(a.mesh(std::move(lamps).build()), Label::light);
}

/// Steel columns in the flues between racks back to back and along both outer racks, from end to end of the hall.
void add_columns(Assembly& a, const WarehouseOptions& o) {
  if (o.column_pitch_m <= 0) return;
  const std::uint32_t column = a.mesh("column", [&](MeshBuilder& b) {
    const double top = l::roof_m(o) - 1.0;
    b.use(painted_steel);
    constexpr double half_m = 0.08;  // pallets reach 9 cm into the flue at most
    add_box(b, {-0.15, -half_m, kFoot_m}, {0.15, -half_m + 0.02, top});
    add_box(b, {-0.15, half_m - 0.02, kFoot_m}, {0.15, half_m, top});
    add_box(b, {-0.01, -half_m + 0.02, kFoot_m}, {0.01, half_m - 0.02, top});
    b.use(concrete_wall);
    add_box(b, {-0.16, -half_m - 0.01, kFoot_m}, {0.16, half_m + 0.01, 0.1});
  });
  for (int row = 0; row <= o.aisles; ++row) {
    const double y = l::aisle_y_m(o, 0) + (row - 0.5) * l::pitch_m(o);
    const int count = static_cast<int>((l::east_m(o) - l::west_m(o) - 2) / o.column_pitch_m);
    for (int k = 0; k <= count; ++k) {
      const double x = 0.5 * (l::west_m(o) + l::east_m(o)) + (k - 0.5 * count) * o.column_pitch_m;
      a.put(column, Label::building, place(x, y, 0));
    }
  }
}

/// Every aisle has a rack on either side, facing it.
void add_racks(Assembly& a, const WarehouseOptions& o, const Ground& ground, std::uint64_t seed) {
  const std::uint32_t rack = a.mesh("racking", [&](MeshBuilder& b) { add_racking(b, o); });
  for (int aisle = 0; aisle < o.aisles; ++aisle) {
    for (const int side : {-1, 1}) {
      const double y = l::aisle_y_m(o, aisle) + side * o.aisle_width_m / 2;
      const core::SE3 T = place(0, y, ground.height_m(0, y), side > 0 ? 0 : M_PI);
      a.put(rack, Label::other, T);
      const int row = 2 * aisle + (side > 0 ? 1 : 0);
      MeshBuilder goods("goods");
      add_goods(goods, o, row, seed);
      if (goods.triangle_count() > 0) a.put(a.mesh(std::move(goods).build()), Label::ground_equipment, T);
    }
  }
}

/// Lanes of pallets before the docks, and a fork lift; the first 7 m beside the racks stay free.
void add_staging(Assembly& a, const WarehouseOptions& o, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/warehouse/staging");
  const double x0 = l::rack_length_m(o) / 2 + 8.5, half = l::half_width_m(o) - 2;
  const int per_lane = 3, lanes = std::max(1, static_cast<int>(2 * half / 2.4));
  for (int k = 0; k < o.staged_pallets && k / per_lane < lanes; ++k) {
    const auto draw = [&](std::uint32_t j) { return random.uniform(static_cast<std::uint64_t>(k), j); };
    const std::uint32_t pallet =
        a.mesh("staged_pallet", [&](MeshBuilder& b) { add_pallet(b, 0, 0, 0, 0.5 + 1.0 * draw(0), draw(1), draw(2)); });
    const double x = x0 + 1.4 * (k % per_lane) + 0.1 * draw(3);
    const double y = -half + 2.4 * (k / per_lane) + 0.2 * draw(4);
    a.stand(pallet, Label::ground_equipment, x, y, M_PI / 2 + 0.08 * (2 * draw(5) - 1));
  }
  a.stand(a.mesh("fork_lift", add_fork_lift), Label::vehicle, x0 + 2.5, half - 1.5, 0.6 * M_PI);
}

void add_floor(Assembly& a, const WarehouseOptions& o, const Ground& ground) {
  const double w = l::west_m(o), e = l::east_m(o), half = l::half_width_m(o);
  constexpr double cell_m = 1;  // the shortest wave of the floor is 9 m long
  MeshBuilder floor("floor"), paint("paint");
  floor.use(concrete_dry);
  add_ground_patch(floor, ground, {w, -half}, {e + 0.1, half}, cell_m);
  a.put(a.mesh(std::move(floor).build()), Label::pavement);
  paint.use(paint_yellow_marking);
  const double end = l::rack_length_m(o) / 2;
  for (int k = 0; k < o.aisles; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const double y = l::aisle_y_m(o, k) + side * (o.aisle_width_m / 2 - 0.2);
      add_ground_patch(paint, ground, {-end, y - 0.05}, {end, y + 0.05}, cell_m, 0.001);
    }
  }
  a.put(a.mesh(std::move(paint).build()), Label::marking);
}

Scene make_warehouse(const WarehouseOptions& o, std::uint64_t seed) {
  Scene scene;
  scene.name = "warehouse";
  scene.materials = materials();
  scene.interest_min = Vector2d(l::west_m(o), -l::half_width_m(o));
  scene.interest_max = Vector2d(l::east_m(o), l::half_width_m(o));
  const auto ground = std::make_shared<WavyGround>(o.floor(), seed);
  scene.ground = ground;
  Assembly a(scene, *ground);
  add_floor(a, o, *ground);
  add_hall(a, o);
  add_columns(a, o);
  add_racks(a, o, *ground, seed);
  add_staging(a, o, seed);
  return scene;
}

WarehouseOptions read(const core::ConfigNode& node) {
  return read_scene_options<WarehouseOptions>(node);
}

}  // namespace

extern const SceneEntry warehouse;
const SceneEntry warehouse{
    .name = "warehouse",
    .summary = "a hall of pallet racking: aisles that repeat, columns, loading doors",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_warehouse(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(read(node).floor(), seed);
    },
    .describe = [] { return core::describe_options<WarehouseOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: warehouse\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
