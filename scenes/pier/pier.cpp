// A terminal pier with aircraft nosed in on one or both sides.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/apron/marks.h"
#include "scenes/apron/turnaround.h"
#include "scenes/bridge/bridge.h"
#include "scenes/buildings/terminal.h"
#include "scenes/equipment/equipment.h"
#include "scenes/materials/materials.h"
#include "scenes/pier/layout.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double pi = std::numbers::pi;

PavingSpec paving(const PierOptions& options, const PierLayout& l) {
  constexpr double east_m = 50, hall_m = 30, without_stands_m = 45;
  const double north = options.both_sides ? l.edge_m : without_stands_m;
  PavingSpec spec = options.paving.spec({l.west_m - (options.with_hall ? hall_m : 10), l.y(-1, l.edge_m)},
                                        {l.east_m + east_m, l.y(1, north)}, "scenes/pier");
  return spec;
}

/// Types that a bridge can serve on a stand of this code.
std::vector<const AircraftType*> fitting_types(char code) {
  constexpr double lowest_sill_m = 2.3;  // below it, the bridge would be too steep
  std::vector<const AircraftType*> types;
  for (const std::string& name : aircraft_names()) {
    const AircraftType& type = aircraft_type(name);
    const bool fits = type.icao_code == code && type.floor_z_m + type.doors.front().sill_m > lowest_sill_m;
    if (fits && type.engines.front().propeller.diameter_m <= 0) types.push_back(&type);
  }
  return types;
}

void put_terminal(Assembly& a, const TerminalSpec& spec, const core::SE3& T_world_terminal) {
  Terminal terminal = make_terminal(spec, T_world_terminal);
  a.put(a.mesh(std::move(terminal.building)), Label::building);
  a.put(a.mesh(std::move(terminal.glass)), Label::glass);
}

/// The pier's two fronts, back to back, and the front of the hall across its western end.
void add_buildings(Assembly& a, const PierOptions& options, const PierLayout& l, const Ground& ground) {
  for (const double side : {-1.0, 1.0}) {
    TerminalSpec spec{.west_m = l.west_m,
                      .east_m = l.east_m,
                      .facade_y_m = -l.half_width_m,
                      .back_y_m = 0,
                      .boarding_floor_m = PierLayout::boarding_floor_m,
                      .high_half_length_m = 0,
                      .tower_bays = {},
                      .roof_overhang_m = 0,
                      .portals_x_m = {},
                      .displays_x_m = {},
                      .plant_x_m = {}};
    for (const PierStand& stand : l.stands) {
      if (stand.side != side) continue;
      const double portal = stand.frame.world(PierLayout::rotunda_x_m(stand.code), 0).x();
      spec.portals_x_m.push_back(-side * portal);  // the northern front is turned by half a turn
      spec.displays_x_m.push_back(-side * stand.centre_x_m);
      spec.plant_x_m.push_back(-side * stand.centre_x_m + 6);
    }
    const double z0 = ground.height_m(0, l.y(side, 0));
    put_terminal(a, spec, place(0, 0, z0, side < 0 ? 0 : pi));
  }
  if (!options.with_hall) return;
  constexpr double bay = 7.5, beyond_pier_m = 60, depth_m = 25, hall_top_m = 22;
  const double half = bay * std::ceil((l.half_width_m + beyond_pier_m) / bay);
  const int bays = static_cast<int>(std::round(2 * half / bay));
  put_terminal(a,
               {.west_m = -half,
                .east_m = half,
                .facade_y_m = -l.west_m,
                .back_y_m = -l.west_m + depth_m,
                .boarding_floor_m = PierLayout::boarding_floor_m,
                .top_m = hall_top_m,
                .high_half_length_m = 0,
                .tower_bays = {2, bays - 3},
                .portals_x_m = {},
                .displays_x_m = {},
                .plant_x_m = {-half + 20, half - 26}},
               place(0, 0, ground.height_m(l.west_m, 0), pi / 2));
}

double floor_z_m(const PierLayout& l, const PierStand& stand, const Ground& ground) {
  return ground.height_m(0, l.y(stand.side, 0)) + PierLayout::boarding_floor_m;
}

void add_stand(Assembly& a, Props& props, const PierOptions& options, const PierLayout& l, const PierStand& stand,
               std::size_t index, const Ground& ground, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/pier/stands"), crew(seed, "scenes/pier/equipment");
  const std::vector<const AircraftType*> types = fitting_types(stand.code);
  const auto pick = static_cast<std::size_t>(random.uniform(index, 1) * static_cast<double>(types.size()));
  const AircraftType& type = *types[pick];
  const bool occupied = random.uniform(index, 0) < options.occupied_share;
  const double rotunda_x = PierLayout::rotunda_x_m(stand.code);
  const BridgeSite site{.rotunda_m = stand.frame.world(rotunda_x, PierLayout::nose_m - PierLayout::rotunda_m),
                        .terminal_m = stand.frame.world(rotunda_x, PierLayout::nose_m - 0.02),
                        .floor_z_m = floor_z_m(l, stand, ground)};
  // On an empty stand the bridge waits where it would serve an aircraft that stands two metres nearer to it.
  const Vector2d nose = occupied ? stand.frame.nose_m : stand.frame.world(-2, 0);
  const core::SE3 T_world_aircraft = park(type, ground, nose.x(), nose.y(), stand.frame.heading_rad());
  a.put(a.mesh(make_jet_bridge(site, type, T_world_aircraft, ground)), Label::jet_bridge);
  const Turnaround turnaround{
      .frame = stand.frame, .half_width_m = stand.half_width_m, .density = options.equipment_density, .stand = index};
  if (!occupied) return add_empty_stand(props, turnaround, crew);
  props.put(
      "aircraft_" + type.name, Label::aircraft, [&] { return make_aircraft(type, 0); }, T_world_aircraft);
  add_turnaround(props, type, turnaround, crew);
}

void add_masts(Props& props, const PierLayout& l) {
  constexpr double height_m = 25, ahead_of_nose_m = 3.2, from_edge_m = 7;
  for (const PierStand& stand : l.stands) {
    const Vector2d p = stand.frame.world(stand.half_width_m - from_edge_m, ahead_of_nose_m);
    props.found(
        "lighting_mast", Label::mast, [&](MeshBuilder& b) { add_lighting_mast(b, height_m); }, p.x(), p.y(),
        stand.side < 0 ? 0 : pi);
  }
}

Mesh paint(const PierOptions& options, const PierLayout& l, const SlabSurface& slabs) {
  Painter p(slabs);
  for (const double side : {-1.0, 1.0}) {
    if (side > 0 && !options.both_sides) continue;
    const double taxilane_y = l.y(side, l.taxilane_m);
    paint_lead_in_line(p, {{l.west_m + 5, taxilane_y}, {l.east_m + 40, taxilane_y}}, 0.15);
    std::vector<double> crossings;
    for (const PierStand& stand : l.stands) {
      if (stand.side != side) continue;
      crossings.push_back(stand.centre_x_m);
      const bool wide = stand.code == 'E';
      paint_stand(p, {.frame = stand.frame,
                      .half_width_m = stand.half_width_m,
                      .length_m = l.stand_length_m,
                      .nose_gear_m = 5.5,
                      .taxilane_m = l.taxilane_m - PierLayout::nose_m,
                      .lead_in_radius_m = wide ? 45.0 : 22.0,
                      .lead_in_from = stand.centre_x_m > 0 ? -stand.frame.sign : stand.frame.sign,
                      .number = std::to_string(stand.number)});
    }
    std::ranges::sort(crossings);
    const double lane = PierLayout::lane_width_m;
    paint_road(p, l.y(side, l.tail_road_m), l.cross_road_x_m + lane, l.end_road_x_m - lane, lane, crossings);
    paint_road(p, l.y(side, PierLayout::head_road_m), l.cross_road_x_m + lane, l.end_road_x_m - lane, lane, {});
    for (const double x : {l.cross_road_x_m, l.end_road_x_m}) {
      const double y0 = l.y(side, PierLayout::head_road_m + lane), y1 = l.y(side, l.tail_road_m - lane);
      paint_cross_road(p, x, std::min(y0, y1), std::max(y0, y1), lane);
    }
  }
  return std::move(p).build();
}

Scene make_pier(const PierOptions& options, const PierLayout& l, std::uint64_t seed) {
  Scene scene;
  scene.name = "pier";
  scene.materials = materials();
  scene.interest_min = {l.west_m - 5, l.y(-1, l.tail_road_m + 10)};
  scene.interest_max = {l.east_m + 25, l.y(1, options.both_sides ? l.tail_road_m + 10 : 12)};
  const PavingSpec spec = paving(options, l);
  const auto ground = std::make_shared<WavyGround>(spec, seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(spec, seed);
  Assembly a(scene, *ground);
  const SlabSurface slabs(spec, seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  a.put(a.mesh(paint(options, l, slabs)), Label::marking);
  add_buildings(a, options, l, *ground);
  Props props(a);
  for (std::size_t k = 0; k < l.stands.size(); ++k) add_stand(a, props, options, l, l.stands[k], k, *ground, seed);
  add_masts(props, l);
  return scene;
}

struct Read {
  PierOptions options;
  PierLayout layout;
};

Read read(const core::ConfigNode& node) {
  const auto options = read_scene_options<PierOptions>(node);
  try {
    return {options, pier_layout(options)};
  } catch (const core::InputError& error) {
    node.fail(error.what());
  }
}

}  // namespace

extern const SceneEntry pier;
const SceneEntry pier{
    .name = "pier",
    .summary = "a terminal pier: stands of code C and E along it, aircraft nosed in, a bridge each, roads around",
    .make =
        [](const core::ConfigNode& node, std::uint64_t seed) {
          const Read r = read(node);
          return make_pier(r.options, r.layout, seed);
        },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      const Read r = read(node);
      return std::make_shared<WavyGround>(paving(r.options, r.layout), seed);
    },
    .describe = [] { return core::describe_options<PierOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: pier\n" + core::write_options(read(node).options, 2); },
};

}  // namespace tarmac::scenes
