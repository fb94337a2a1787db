#include "scenes/stand/stand.h"

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/equipment/equipment.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"
#include "scenes/stand/tug.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
namespace l = layout;

namespace {

constexpr double pi = std::numbers::pi;

void add_buildings(Assembly& a, const Ground& ground, bool with_surroundings) {
  Terminal terminal = make_stand_terminal(ground.height_m(0, l::facade_y_m));
  a.put(a.mesh(std::move(terminal.building)), Label::building);
  a.put(a.mesh(std::move(terminal.glass)), Label::glass);
  if (with_surroundings) {
    a.put(a.mesh(make_hangar(ground.height_m(118, -47))), Label::building);
    a.put(a.mesh(make_cargo_shed(ground.height_m(-124, -65))), Label::building);
    a.put(a.mesh(make_blast_fence(ground)), Label::other);
  }
  const std::uint32_t mast = a.mesh("lighting_mast", [](MeshBuilder& b) { add_lighting_mast(b, 25); });
  for (const double x : {-100.0, -36.5, 34.5, 98.0}) a.found(mast, Label::mast, x, 33, 0);
  if (!with_surroundings) return;
  for (const double x : {-95.0, 25.0, 85.0}) a.found(mast, Label::mast, x, -97, pi);
}

/// Carts in two trains beside the aircraft, then in rows on the neighbouring stand; each a little off its place.
void add_carts(Assembly& a, int count, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/stand/carts");
  const std::uint32_t cart = a.mesh("baggage_cart", add_baggage_cart);
  for (int k = 0; k < count; ++k) {
    const auto draw = [&](std::uint32_t j) { return 2 * random.uniform(static_cast<std::uint64_t>(k), j) - 1; };
    const int row = k / 4, place_in_row = k % 4;
    constexpr double pitch_m = 4.0;
    const std::array<Vector3d, 4> head{Vector3d(16.2, 26.6, 0.5 * pi), Vector3d(13.0, 6.5, 0.5 * pi),
                                       Vector3d(l::neighbour_east_x_m - 12, 29, 0.5 * pi),
                                       Vector3d(l::neighbour_east_x_m - 8.5, 29, 0.5 * pi)};
    const Vector3d& h = head[static_cast<std::size_t>(row)];
    a.stand(cart, Label::ground_equipment, h.x() + 0.25 * draw(0), h.y() - pitch_m * place_in_row + 0.15 * draw(1),
            h.z() + 0.06 * draw(2));
  }
}

void add_cones(Assembly& a, int count, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/stand/cones");
  const std::uint32_t cone = a.mesh("cone", [](MeshBuilder& b) { add_traffic_cone(b); });
  // Wing tips, tail, engines, nose; then the wings' rear edges and the belt loaders.
  constexpr std::array<std::array<double, 2>, 12> places{{{18.6, 8.4},
                                                          {-18.6, 8.4},
                                                          {0, -9.6},
                                                          {5.9, 19.8},
                                                          {-5.9, 20.2},
                                                          {1.6, 32},
                                                          {-1.6, 32},
                                                          {8, -2.5},
                                                          {-8, -2.5},
                                                          {18.9, 5.6},
                                                          {-18.9, 5.6},
                                                          {10.6, 21.9}}};
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const auto& [x, y] = places[i];
    a.stand(cone, Label::cone, x + 0.15 * (2 * random.uniform(i, 0) - 1), y + 0.15 * (2 * random.uniform(i, 1) - 1),
            pi * random.uniform(i, 2));
  }
}

void add_parked_vehicles(Assembly& a) {
  const AircraftType& type = airbus_a320();
  // Belt loaders at the two hold doors on the right side, belt end just below the sill.
  const std::uint32_t loader = a.mesh(
      "belt_loader", [&](MeshBuilder& b) { add_belt_loader(b, type.floor_z_m + type.doors.back().sill_m - 0.05); });
  for (const Door& door : type.doors) {
    if (door.side == -1) a.stand(loader, Label::ground_equipment, 5.5, l::nose_y_m - door.x_m, pi);
  }
  const std::uint32_t tractor = a.mesh(make_tug());
  a.stand(tractor, Label::vehicle, 16.3, 30.6, 0.5 * pi);
  a.stand(tractor, Label::vehicle, l::neighbour_west_x_m + 6, 27, -0.5 * pi);
  const std::uint32_t gpu = a.mesh("ground_power_unit", add_ground_power_unit);
  a.stand(gpu, Label::ground_equipment, 4.6, 28.2, 0.5 * pi);
  a.stand(gpu, Label::ground_equipment, l::neighbour_east_x_m - 19, 20, 0.5 * pi);
  const std::uint32_t loaded = a.mesh("dolly_with_container", [](MeshBuilder& b) { add_container_dolly(b, true); });
  const std::uint32_t empty = a.mesh("dolly", [](MeshBuilder& b) { add_container_dolly(b, false); });
  for (int k = 0; k < 5; ++k) {
    a.stand(k == 3 ? empty : loaded, Label::ground_equipment, l::neighbour_west_x_m - 18.4, 16 + 3.6 * k, 0.5 * pi);
  }
  a.stand(a.mesh("catering_truck", add_catering_truck), Label::vehicle, l::neighbour_east_x_m + 14, 22, -0.5 * pi);
  a.stand(a.mesh("passenger_stairs", [](MeshBuilder& b) { add_passenger_stairs(b); }), Label::ground_equipment,
          l::neighbour_west_x_m + 15, 20, 0.5 * pi);
}

void add_chocks(Assembly& a, const AircraftType& type) {
  const std::uint32_t chock = a.mesh("chock", add_chock);
  const auto put = [&](const LandingGear& gear, double x) {
    for (const double side : {-1.0, 1.0}) {
      a.stand(chock, Label::ground_equipment, x, l::nose_y_m - gear.x_m + side * (0.8 * gear.wheel_radius_m + 0.1),
              0.5 * pi);
    }
  };
  put(type.nose_gear, 0);
  for (const LandingGear& gear : type.main_gear) {
    put(gear, gear.half_track_m);
    put(gear, -gear.half_track_m);
  }
}

void add_tug(Assembly& a, Scene& scene, const StandOptions& options, const std::shared_ptr<const WavyGround>& ground,
             std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/stand/tug");
  const LaneMotion::Lane lane{.from_x_m = l::tug_from_x_m,
                              .to_x_m = l::tug_to_x_m,
                              .y_m = l::tug_y_m,
                              .phase_rad = 2 * pi * random.uniform(0),
                              .speed_m_s = options.tug_speed_m_s,
                              .start_s = options.tug_start_s};
  Mesh mesh = make_tug();
  scene.actors.push_back({"tug", std::make_shared<LaneMotion>(lane, ground), mesh_radius_m(mesh)});
  a.put(a.mesh(std::move(mesh)), Label::vehicle, core::SE3::Identity(), static_cast<int>(scene.actors.size()) - 1);
}

StandOptions read(const core::ConfigNode& node) {
  return read_scene_options<StandOptions>(node);
}

}  // namespace

BridgeSite stand_bridge_site(const Ground& ground) {
  return {.rotunda_m = {l::rotunda_x_m, l::rotunda_y_m},
          .terminal_m = {l::rotunda_x_m, l::facade_y_m - 0.02},
          .floor_z_m = ground.height_m(0, l::facade_y_m) + l::boarding_floor_z_m};
}

Scene make_stand(const StandOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "stand";
  scene.materials = materials();
  scene.interest_min = {-75, -45};
  scene.interest_max = {75, 60};
  const auto ground = std::make_shared<WavyGround>(options.paving(), seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(options.paving(), seed);

  Assembly a(scene, *ground);
  const SlabSurface slabs(options.paving(), seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_markings(slabs)), Label::marking);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  add_buildings(a, *ground, options.with_surroundings);

  const AircraftType& type = airbus_a320();
  const core::SE3 T_world_aircraft = park(type, *ground, 0, l::nose_y_m, pi / 2);
  a.put(a.mesh(make_jet_bridge(stand_bridge_site(*ground), type, T_world_aircraft, *ground)), Label::jet_bridge);
  if (options.with_aircraft) {
    a.put(a.mesh(make_aircraft(type, /*open_left_door=*/0)), Label::aircraft, T_world_aircraft);
    add_chocks(a, type);
  }
  if (options.with_equipment) {
    add_parked_vehicles(a);
    add_carts(a, options.carts, seed);
    add_cones(a, options.cones, seed);
  }
  if (options.with_tug) add_tug(a, scene, options, ground, seed);
  return scene;
}

extern const SceneEntry stand;
const SceneEntry stand{
    .name = "stand",
    .summary = "an airside stand: A320 nosed in, jet bridge, terminal, equipment, a tug that drives by",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_stand(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(read(node).paving(), seed);
    },
    .describe = [] { return core::describe_options<StandOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: stand\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
