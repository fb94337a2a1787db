// A hangar with its doors open: the apron before it, and all that stands inside.
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/apron/marks.h"
#include "scenes/apron/props.h"
#include "scenes/equipment/equipment.h"
#include "scenes/equipment/person.h"
#include "scenes/hangar/layout.h"
#include "scenes/hangar/workshop.h"
#include "scenes/materials/materials.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double pi = std::numbers::pi;

PavingSpec paving(const HangarOptions& options) {
  return options.paving.spec({-HangarLayout::apron_half_m, HangarLayout::apron_south_m},
                             {HangarLayout::apron_half_m, options.depth_m + 12}, "scenes/hangar");
}

/// Cabinets and benches along both side walls and the back, in turn; fronts towards the middle.
void add_cabinets(Props& props, const HangarOptions& options, const HangarLayout& l, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/hangar/cabinets");
  constexpr double pitch_m = 2.4, off_wall_m = 0.6, first_m = 6;
  struct Place {
    double x, y, yaw;
  };
  std::vector<Place> places;
  const double x = l.clear_half_width_m - off_wall_m, back = l.clear_depth_m - off_wall_m;
  for (double y = first_m; y < back - 2; y += pitch_m) {
    places.push_back({x, y, pi});
    places.push_back({-x, y, 0});
  }
  for (double along = -x + 3; along < x - 3; along += pitch_m) places.push_back({along, back, -pi / 2});
  // Every place has a number drawn for it, and the smallest take part: more cabinets move none.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < places.size(); ++k) order.emplace_back(random.uniform(k, 0), k);
  std::ranges::sort(order);
  const auto count = std::min(order.size(), static_cast<std::size_t>(options.cabinets));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = order[i].second;
    const Place& p = places[k];
    const double kind = random.uniform(k, 1), along = 0.15 * (random.uniform(k, 2) - 0.5);
    const double at_x = p.yaw == -pi / 2 ? p.x + along : p.x, at_y = p.yaw == -pi / 2 ? p.y : p.y + along;
    if (kind < 0.6) {
      props.found("tool_cabinet", Label::other, add_tool_cabinet, at_x, at_y, p.yaw);
    } else {
      props.found("work_bench", Label::other, add_work_bench, at_x, at_y, p.yaw);
    }
  }
}

/// Carts, ladders, drums and people between the aircraft and the lane, and under the wings.
void add_loose_items(Props& props, const HangarOptions& options, const HangarLayout& l, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/hangar/loose_items");
  const double inner = 6, outer = l.lane_x_m - 3.4, south = 8, north = l.nose_y_m - 22;
  int placed = 0;
  std::vector<Vector2d> taken;
  for (std::uint64_t k = 0; placed < options.loose_items && k < 400; ++k) {
    const double side = random.uniform(k, 0) < 0.5 ? -1 : 1;
    const Vector2d p(side * (inner + (outer - inner) * random.uniform(k, 1)),
                     south + (std::max(north, south + 12) - south) * random.uniform(k, 2));
    const bool free = std::ranges::all_of(taken, [&](const Vector2d& q) { return (p - q).norm() > 2.4; });
    if (!free) continue;
    taken.push_back(p);
    ++placed;
    const double kind = random.uniform(k, 3), yaw = 2 * pi * random.uniform(k, 4);
    if (kind < 0.4) {
      props.stand("tool_cart", Label::ground_equipment, add_tool_cart, p.x(), p.y(), yaw);
    } else if (kind < 0.6) {
      props.stand("step_ladder", Label::ground_equipment, add_step_ladder, p.x(), p.y(), yaw);
    } else if (kind < 0.8) {
      props.stand("oil_drum", Label::other, add_oil_drum, p.x(), p.y(), yaw);
    } else {
      props.stand_mesh(
          "person_standing", Label::person, [] { return make_person({}); }, StandFrame{}, p.x(), p.y(), yaw);
    }
  }
}

/// Stores in the corners at the back, vehicles and a closed hangar outside.
void add_fixed_items(Assembly& a, Props& props, const HangarOptions& options, const HangarLayout& l,
                     const Ground& ground) {
  const double corner_x = l.lane_x_m - 6;
  props.stand("engine_stand", Label::ground_equipment, add_engine_stand, -corner_x, l.lane_back_y_m - 6, pi / 2);
  props.stand("wheel_rack", Label::ground_equipment, add_wheel_rack, corner_x, l.lane_back_y_m - 5, 0);
  const double front_x = options.width_m / 2 + 9;
  props.stand("towbarless_tractor", Label::vehicle, add_towbarless_tractor, front_x, -9, pi / 2);
  props.stand("ground_power_unit", Label::ground_equipment, add_ground_power_unit, -front_x, -7, 0.3);
  props.stand(
      "belt_loader", Label::ground_equipment, [](MeshBuilder& b) { add_belt_loader(b, 2.2); }, -front_x - 6, -20, 1.2);
  props.stand("follow_me_car", Label::vehicle, add_follow_me_car, front_x + 6, -26, 2.0);
  for (const double x : {-options.width_m / 2 - 14, options.width_m / 2 + 14})
    props.found(
        "lighting_mast", Label::mast, [](MeshBuilder& b) { add_lighting_mast(b, 20); }, x, -4, 0);
  const HangarSpec closed{.width_m = 44, .depth_m = 40};
  const double x = options.width_m / 2 + 20 + closed.width_m / 2;
  if (x + closed.width_m / 2 > HangarLayout::apron_half_m + 20) return;
  MeshBuilder b("hangar_closed");
  add_hangar_shell(b, closed);
  a.put(a.mesh(std::move(b).build()), Label::building, place(x, 2, ground.height_m(x, 2), pi / 2));
}

Mesh paint(const HangarOptions& options, const HangarLayout& l, const SlabSurface& slabs) {
  Painter p(slabs);
  paint_lead_in_line(p, {{0, HangarLayout::apron_south_m + 5}, {0, l.clear_depth_m - 6}}, 0.15);
  p.use(MaterialId::paint_yellow_marking).layer(0);
  const double x0 = l.lane_x_m - 2, x1 = l.lane_x_m + 2, y0 = l.lane_back_y_m - 2, y1 = l.lane_back_y_m + 2;
  p.line({{x1, 2}, {x1, y1}, {-x1, y1}, {-x1, 2}}, 0.1);
  p.line({{x0, 2}, {x0, y0}, {-x0, y0}, {-x0, 2}}, 0.1);
  p.use(MaterialId::paint_red_marking).layer(1);
  p.rectangle({-options.door_width_m / 2, -1.6}, {options.door_width_m / 2, -1.45});
  return std::move(p).build();
}

Scene make_hangar_scene(const HangarOptions& options, const HangarLayout& l, std::uint64_t seed) {
  Scene scene;
  scene.name = "hangar";
  scene.materials = materials();
  scene.interest_min = {-options.width_m / 2 - 12, -35};
  scene.interest_max = {options.width_m / 2 + 12, options.depth_m + 4};
  const PavingSpec spec = paving(options);
  const auto ground = std::make_shared<WavyGround>(spec, seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(spec, seed);
  Assembly a(scene, *ground);
  const SlabSurface slabs(spec, seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  a.put(a.mesh(paint(options, l, slabs)), Label::marking);

  const HangarSpec hangar = options.spec();
  const core::SE3 T_world_hangar = place(0, 0, ground->height_m(0, options.depth_m / 2), pi / 2);
  const auto put_part = [&](const char* name, void (*add)(MeshBuilder&, const HangarSpec&)) {
    MeshBuilder b(name);
    add(b, hangar);
    a.put(a.mesh(std::move(b).build()), Label::building, T_world_hangar);
  };
  put_part("hangar_walls", add_hangar_shell);
  put_part("hangar_columns", add_hangar_columns);
  put_part("hangar_ceiling", add_hangar_roof);

  Props props(a);
  if (options.aircraft != "none") {
    const AircraftType& type = aircraft_type(options.aircraft);
    a.put(a.mesh(make_aircraft(type, 0)), Label::aircraft, park(type, *ground, 0, l.nose_y_m, pi / 2));
    for (const double side : {-1.0, 1.0})
      props.stand("chock", Label::ground_equipment, add_chock, 0,
                  l.nose_y_m - type.nose_gear.x_m + side * (0.8 * type.nose_gear.wheel_radius_m + 0.1), pi / 2);
    if (options.with_docking)
      props.found(
          "docking", Label::ground_equipment, [&](MeshBuilder& b) { add_docking(b, type); }, 0, l.nose_y_m, pi / 2);
  }
  add_cabinets(props, options, l, seed);
  add_loose_items(props, options, l, seed);
  add_fixed_items(a, props, options, l, *ground);
  return scene;
}

struct Read {
  HangarOptions options;
  HangarLayout layout;
};

Read read(const core::ConfigNode& node) {
  const auto options = read_scene_options<HangarOptions>(node);
  try {
    return {options, hangar_layout(options)};
  } catch (const core::InputError& error) {
    node.fail(error.what());
  }
}

}  // namespace

extern const SceneEntry hangar;
const SceneEntry hangar{
    .name = "hangar",
    .summary = "a hangar with open doors: trusses, columns, an aircraft in docking, cabinets; drive in and around",
    .make =
        [](const core::ConfigNode& node, std::uint64_t seed) {
          const Read r = read(node);
          return make_hangar_scene(r.options, r.layout, seed);
        },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(paving(read(node).options), seed);
    },
    .describe = [] { return core::describe_options<HangarOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: hangar\n" + core::write_options(read(node).options, 2); },
};

}  // namespace tarmac::scenes
