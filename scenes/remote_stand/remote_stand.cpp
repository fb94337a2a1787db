// A row of remote stands: aircraft of several types, stairs and buses, no building near.
#include <numbers>

#include "core/error.h"
#include "scenes/apron/marks.h"
#include "scenes/apron/turnaround.h"
#include "scenes/equipment/equipment.h"
#include "scenes/materials/materials.h"
#include "scenes/registry.h"
#include "scenes/remote_stand/layout.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

PavingSpec paving(const RemoteStandOptions& options, const RemoteLayout& l) {
  constexpr double around_m = 60, north_m = 60, code_c_m = 26, code_e_m = 51;
  return options.paving.spec({l.west_m - around_m, l.taxilane_y_m - (l.wide ? code_e_m : code_c_m)},
                             {l.east_m + around_m, north_m}, "scenes/remote_stand");
}

void add_stand(Props& props, const RemoteStandOptions& options, const RemoteStand& stand, std::size_t index,
               const Ground& ground, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/remote_stand/stands"), crew(seed, "scenes/remote_stand/equipment");
  const Turnaround turnaround{.frame = stand.frame,
                              .half_width_m = stand.half_width_m,
                              .density = options.equipment_density,
                              .remote = true,
                              .stand = index};
  if (random.uniform(index, 0) >= options.occupied_share) return add_empty_stand(props, turnaround, crew);
  // A metre or so of the pilot's own: not all stop on the line.
  const double short_of_line = 0.6 * random.uniform(index, 1), beside = 0.4 * (random.uniform(index, 2) - 0.5);
  Turnaround there = turnaround;
  there.frame.nose_m = stand.frame.world(beside, -short_of_line);
  const AircraftType& type = *stand.type;
  props.put(
      "aircraft_" + type.name, Label::aircraft, [&] { return make_aircraft(type, 0); },
      park(type, ground, there.frame.nose_m.x(), there.frame.nose_m.y(), stand.frame.heading_rad()));
  add_turnaround(props, type, there, crew);
}

void add_masts(Props& props, const RemoteLayout& l) {
  constexpr double height_m = 30, from_edge_m = 7, ahead_of_nose_m = 4;
  for (const RemoteStand& stand : l.stands) {
    const Vector2d p = stand.frame.world(stand.half_width_m - from_edge_m, ahead_of_nose_m);
    props.found(
        "lighting_mast", Label::mast, [&](MeshBuilder& b) { add_lighting_mast(b, height_m); }, p.x(), p.y(), 0);
  }
}

Mesh paint(const RemoteLayout& l, const SlabSurface& slabs) {
  Painter p(slabs);
  paint_lead_in_line(p, {{l.west_m - 50, l.taxilane_y_m}, {l.east_m + 50, l.taxilane_y_m}}, 0.15);
  std::vector<double> crossings;
  int number = 61;
  for (const RemoteStand& stand : l.stands) {
    const double x = stand.frame.nose_m.x();
    crossings.push_back(x);
    paint_stand(p, {.frame = stand.frame,
                    .half_width_m = stand.half_width_m,
                    .length_m = l.stand_length_m,
                    .nose_gear_m = stand.type->nose_gear.x_m,
                    .taxilane_m = -l.taxilane_y_m,
                    .lead_in_radius_m = stand.half_width_m > 30 ? 45.0 : 22.0,
                    .lead_in_from = x > 0 ? -1.0 : 1.0,
                    .number = std::to_string(number++)});
  }
  const double lane = RemoteLayout::lane_width_m, west = l.cross_road_west_x_m, east = l.cross_road_east_x_m;
  paint_road(p, l.tail_road_y_m, west + lane, east - lane, lane, crossings);
  paint_road(p, RemoteLayout::head_road_y_m, west + lane, east - lane, lane, {});
  for (const double x : {west, east})
    paint_cross_road(p, x, l.tail_road_y_m + lane, RemoteLayout::head_road_y_m - lane, lane);
  return std::move(p).build();
}

Scene make_remote_stand(const RemoteStandOptions& options, const RemoteLayout& l, std::uint64_t seed) {
  Scene scene;
  scene.name = "remote-stand";
  scene.materials = materials();
  scene.interest_min = {l.west_m - 18, l.tail_road_y_m - 12};
  scene.interest_max = {l.east_m + 18, 28};
  const PavingSpec spec = paving(options, l);
  const auto ground = std::make_shared<WavyGround>(spec, seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(spec, seed);
  Assembly a(scene, *ground);
  const SlabSurface slabs(spec, seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  a.put(a.mesh(paint(l, slabs)), Label::marking);
  Props props(a);
  for (std::size_t k = 0; k < l.stands.size(); ++k) add_stand(props, options, l.stands[k], k, *ground, seed);
  add_masts(props, l);
  return scene;
}

struct Read {
  RemoteStandOptions options;
  RemoteLayout layout;
};

Read read(const core::ConfigNode& node) {
  const auto options = read_scene_options<RemoteStandOptions>(node);
  try {
    return {options, remote_layout(options)};
  } catch (const core::InputError& error) {
    node.fail(error.what());
  }
}

}  // namespace

extern const SceneEntry remote_stand;
const SceneEntry remote_stand{
    .name = "remote-stand",
    .summary = "remote stands in a row: any aircraft types side by side, stairs, buses, people, no building",
    .make =
        [](const core::ConfigNode& node, std::uint64_t seed) {
          const Read r = read(node);
          return make_remote_stand(r.options, r.layout, seed);
        },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      const Read r = read(node);
      return std::make_shared<WavyGround>(paving(r.options, r.layout), seed);
    },
    .describe = [] { return core::describe_options<RemoteStandOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) {
          return "  kind: remote-stand\n" + core::write_options(read(node).options, 2);
        },
};

}  // namespace tarmac::scenes
