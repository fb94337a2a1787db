// An indoor corridor along x: nothing in it tells where along the axis one is but its doors, lamps and what hangs on
// its walls, and all of these can be taken away.
#include <cmath>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/corridor/options.h"
#include "scenes/primitives/ground_patch.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

namespace {

using Eigen::Vector3d;
using enum MaterialId;

constexpr double kWall_m = 0.2, kFoot_m = -0.1;
constexpr double kDoorWidth_m = 1.0, kDoorHeight_m = 2.1, kRecess_m = 0.12, kFrame_m = 0.06;
constexpr double kDeepest_m = 0.22;  ///< what hangs on a wall leaves the middle of the corridor free

/// Builds one wall in a frame of its own: x along the corridor, y = 0 its face, the corridor at y > 0.
struct WallFrame {
  double length_m, height_m;
};

void add_door(MeshBuilder& b, double x) {
  const double half = kDoorWidth_m / 2;
  b.use(painted_steel);
  for (const double side : {-1.0, 1.0}) {
    const double inner = x + side * half, outer = x + side * (half + kFrame_m);
    add_box(b, {std::min(inner, outer), -kRecess_m, kFoot_m}, {std::max(inner, outer), 0.02, kDoorHeight_m + kFrame_m});
  }
  add_box(b, {x - half, -kRecess_m, kDoorHeight_m}, {x + half, 0.02, kDoorHeight_m + kFrame_m});
  b.use(wood);
  add_box(b, {x - half, -kRecess_m - 0.045, 0.012}, {x + half, -kRecess_m, kDoorHeight_m});
  b.use(galvanised_steel);
  add_box(b, {x + half - 0.20, -kRecess_m, 1.02}, {x + half - 0.08, -kRecess_m + 0.05, 1.05});
}

/// Doors at a fixed pitch, the wall between and above them.
void add_wall(MeshBuilder& b, const WallFrame& wall, const std::vector<double>& doors) {
  const double half = wall.length_m / 2;
  double from = -half;
  for (const double x : doors) {
    const double left = x - kDoorWidth_m / 2 - kFrame_m, right = x + kDoorWidth_m / 2 + kFrame_m;
    b.use(interior_wall);
    add_box(b, {from, -kWall_m, kFoot_m}, {left, 0, wall.height_m});
    add_box(b, {left, -kWall_m, kDoorHeight_m + kFrame_m}, {right, 0, wall.height_m});
    add_door(b, x);
    from = right;
  }
  b.use(interior_wall);
  add_box(b, {from, -kWall_m, kFoot_m}, {half, 0, wall.height_m});
}

/// Something on the wall, its middle at x.
void add_feature(MeshBuilder& b, double x, int kind, double size) {
  switch (kind) {
    case 0:  // notice board
      b.use(wood);
      add_box(b, {x - 0.5 - 0.3 * size, 0, 1.15}, {x + 0.5 + 0.3 * size, 0.03, 1.95});
      break;
    case 1:  // cabinet on the floor
      b.use(gse_paint_white);
      add_box(b, {x - 0.35 - 0.15 * size, 0, 0.02}, {x + 0.35 + 0.15 * size, kDeepest_m, 1.2 + 0.7 * size});
      break;
    case 2:  // extinguisher in its bracket
      b.use(steel_orange);
      add_frustum(b, {x, 0.10, 0.55}, {x, 0.10, 1.05}, 0.08, 0.08, 14);
      b.use(gse_chassis);
      add_box(b, {x - 0.04, 0, 0.70}, {x + 0.04, 0.04, 0.95});
      break;
    case 3:  // radiator
      b.use(gse_paint_white);
      for (int k = 0; k < 8; ++k) {
        const double left = x - 0.48 + 0.12 * k;
        add_box(b, {left, 0.04, 0.15}, {left + 0.09, 0.14, 0.75 + 0.2 * size});
      }
      add_box(b, {x - 0.48, 0, 0.3}, {x + 0.45, 0.04, 0.4});
      break;
    default:  // pipe from floor to ceiling
      b.use(galvanised_steel);
      add_frustum(b, {x, 0.09, kFoot_m}, {x, 0.09, 2.4}, 0.05 + 0.03 * size, 0.05 + 0.03 * size, 14);
      break;
  }
}

/// Half a door's way from a door on the same side: nothing hangs in a doorway.
bool clear_of_doors(double x, const std::vector<double>& doors) {
  for (const double door : doors) {
    if (std::abs(x - door) < kDoorWidth_m / 2 + kFrame_m + 0.85) return false;
  }
  return true;
}

std::vector<double> door_places(const CorridorOptions& options, double shift) {
  std::vector<double> places;
  if (options.door_pitch_m <= 0) return places;
  const double pitch = std::max(options.door_pitch_m, kDoorWidth_m + 2 * kFrame_m + 0.3);
  const double reach = options.length_m / 2 - 1.2;
  for (double x = -reach + shift * pitch; x <= reach; x += pitch) places.push_back(x);
  return places;
}

void add_walls(Assembly& a, const CorridorOptions& options, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/corridor/walls");
  std::uint64_t drawn = 0;
  for (const double side : {-1.0, 1.0}) {
    const auto key = static_cast<std::uint32_t>(side > 0);
    const std::vector<double> doors = door_places(options, random.uniform(0, key));
    const core::SE3 T = place(0, side * options.width_m / 2, 0, side > 0 ? M_PI : 0);
    MeshBuilder wall(side > 0 ? "wall_north" : "wall_south"), features("wall_features");
    add_wall(wall, {options.length_m, options.height_m}, doors);
    a.put(a.mesh(std::move(wall).build()), Label::building, T);
    const int count = static_cast<int>(std::round(options.features_per_10m * options.length_m / 20));
    for (int k = 0; k < count; ++k) {
      // A place in the k-th of `count` equal stretches, so that features neither bunch nor repeat.
      const double u = random.uniform(++drawn, 2), share = (k + 0.2 + 0.6 * u) / count;
      const double x = (share - 0.5) * (options.length_m - 2);
      if (!clear_of_doors(x, doors)) continue;
      add_feature(features, x, static_cast<int>(5 * random.uniform(drawn, 3)), random.uniform(drawn, 4));
    }
    if (features.triangle_count() > 0) a.put(a.mesh(std::move(features).build()), Label::other, T);
  }
  const double end = options.length_m / 2, half = options.width_m / 2;
  MeshBuilder ends("end_walls");
  ends.use(interior_wall);
  add_box(ends, {-end - kWall_m, -half - kWall_m, kFoot_m}, {-end, half + kWall_m, options.height_m});
  add_box(ends, {end, -half - kWall_m, kFoot_m}, {end + kWall_m, half + kWall_m, options.height_m});
  a.put(a.mesh(std::move(ends).build()), Label::building);
}

void add_ceiling(Assembly& a, const CorridorOptions& options) {
  const double end = options.length_m / 2, half = options.width_m / 2;
  MeshBuilder lid("corridor_ceiling"), lamps("lamps_ceiling");
  lid.use(interior_wall);
  add_box(lid, {-end, -half - kWall_m, options.height_m}, {end, half + kWall_m, options.height_m + kWall_m});
  a.put(a.mesh(std::move(lid).build()), Label::building);
  if (options.light_pitch_m <= 0) return;
  lamps.use(gse_paint_white);
  for (double x = -end + options.light_pitch_m / 2; x < end - 0.7; x += options.light_pitch_m) {
    add_box(lamps, {x - 0.6, -0.15, options.height_m - 0.08}, {x + 0.6, 0.15, options.height_m});
  }
  a.put(a.mesh(std::move(lamps).build()), Label::light);
}

Scene make_corridor(const CorridorOptions& options, std::uint64_t seed) {
  const double end = options.length_m / 2, half = options.width_m / 2, shown = std::min(end, 30.0);
  Scene scene;
  scene.name = "corridor";
  scene.materials = materials();
  scene.interest_min = {-shown, -half - 1};
  scene.interest_max = {shown, half + 1};
  const auto ground = std::make_shared<WavyGround>(options.floor(), seed);
  scene.ground = ground;
  Assembly a(scene, *ground);
  constexpr double cell_m = 1;  // the shortest wave of the floor is 9 m long
  a.put(a.mesh("floor",
               [&](MeshBuilder& b) {
                 b.use(floor_vinyl);
                 add_ground_patch(b, *ground, {-end, -half - kRecess_m}, {end, half + kRecess_m}, cell_m);
               }),
        Label::pavement);
  add_walls(a, options, seed);
  add_ceiling(a, options);
  return scene;
}

CorridorOptions read(const core::ConfigNode& node) {
  return read_scene_options<CorridorOptions>(node);
}

}  // namespace

extern const SceneEntry corridor;
const SceneEntry corridor{
    .name = "corridor",
    .summary = "an indoor corridor with doors, lamps and wall features, or bare: then blind along its axis",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_corridor(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(read(node).floor(), seed);
    },
    .describe = [] { return core::describe_options<CorridorOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: corridor\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
