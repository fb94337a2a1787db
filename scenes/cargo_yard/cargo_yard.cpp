// A cargo yard: a shed with docks, containers in racks, dolly trains, trucks behind a fence, a freighter being loaded.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "scenes/apron/marks.h"
#include "scenes/apron/turnaround.h"
#include "scenes/cargo_yard/layout.h"
#include "scenes/cargo_yard/parts.h"
#include "scenes/equipment/equipment.h"
#include "scenes/materials/materials.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double pi = std::numbers::pi, quarter = pi / 2;

PavingSpec paving(const CargoYardOptions& options, const CargoLayout& l) {
  constexpr double beside_m = 45;
  const double half = options.shed_length_m / 2 + beside_m;
  return options.paving.spec({-half, l.south_edge_m}, {half, CargoLayout::dock_y_m + 6}, "scenes/cargo_yard");
}

void add_shed(Assembly& a, const CargoLayout& l, const Ground& ground) {
  MeshBuilder b("cargo_shed");
  add_cargo_shed(b, l.shed);
  a.put(a.mesh(std::move(b).build()), Label::building,
        place(0, CargoLayout::dock_y_m, ground.height_m(0, CargoLayout::dock_y_m), -quarter));
}

/// Trucks backed up to the docks west of the fence, dollies in front of those east of it.
void add_docks(Props& props, const CargoYardOptions& options, const CargoLayout& l, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/cargo_yard/docks");
  constexpr double bumper_m = 0.45;
  for (int k = 0; k < dock_count(l.shed); ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double x = dock_y_m(l.shed, k), aside = 0.2 * (random.uniform(i, 1) - 0.5);
    if (x < CargoLayout::fence_x_m - 3) {
      if (random.uniform(i, 0) < options.truck_share)
        props.stand("articulated_truck", Label::vehicle, add_articulated_truck, x + aside,
                    CargoLayout::dock_y_m - bumper_m - 0.05 - kTruckTail_m, -quarter);
    } else if (x > CargoLayout::aisle_x_m + 5 && random.uniform(i, 0) < 0.6) {
      const bool loaded = random.uniform(i, 2) < 0.6;
      props.stand(
          loaded ? "dolly_with_container" : "dolly", Label::ground_equipment,
          [&](MeshBuilder& b) { add_container_dolly(b, loaded); }, x + aside, CargoLayout::dock_y_m - 7.4, quarter);
    }
  }
}

/// Rows of roller beds, back to back in pairs, with aisles between the pairs; containers on them, some with another on
/// top.
void add_racks(Props& props, const CargoYardOptions& options, const CargoLayout& l, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/cargo_yard/racks");
  constexpr double pitch_m = 2.5, pair_pitch_m = 9.5, pair_gap_m = 2.2, uld_height_m = 1.63;
  const auto stack = [&](int levels) {
    return [levels](MeshBuilder& b) {
      for (int level = 0; level < levels; ++level) {
        b.at(place(0, 0, kRollerBedHeight_m + uld_height_m * level));
        add_uld(b);
      }
      b.at(core::SE3::Identity());
    };
  };
  std::uint64_t cell = 0;
  for (double y = CargoLayout::racks_south_m + 1.5; y + pair_gap_m < CargoLayout::racks_north_m; y += pair_pitch_m) {
    for (const double row : {0.0, pair_gap_m}) {
      for (double x = l.rack_from_x_m + 1.3; x + 1.3 < l.rack_to_x_m; x += pitch_m, ++cell) {
        props.stand("roller_bed", Label::ground_equipment, add_roller_bed, x, y + row, 0);
        if (random.uniform(cell, 0) >= options.fill_share) continue;
        const int levels = random.uniform(cell, 1) < options.stacked_share ? 2 : 1;
        props.stand(levels == 2 ? "containers_stacked" : "container", Label::ground_equipment, stack(levels), x,
                    y + row, random.uniform(cell, 2) < 0.5 ? 0 : pi);
      }
    }
  }
}

/// Trains in two rows between the south road and the freighter, to its left and right.
void add_trains(Props& props, const CargoYardOptions& options, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/cargo_yard/trains");
  constexpr double first_x_m = 26, pitch_m = 4.5, front_y_m = -2, dolly_m = 4.4;
  for (int k = 0; k < options.dolly_trains; ++k) {
    const double side = k % 2 == 0 ? 1 : -1, x = side * (first_x_m + pitch_m * (k / 2));
    const auto i = static_cast<std::uint64_t>(k);
    props.stand("baggage_tractor", Label::vehicle, add_baggage_tractor, x, front_y_m, quarter);
    const int dollies = 3 + static_cast<int>(3 * random.uniform(i, 0));
    for (int j = 0; j < dollies; ++j) {
      const bool loaded = random.uniform(i, static_cast<std::uint32_t>(10 + j)) < 0.7;
      props.stand(
          loaded ? "dolly_with_container" : "dolly", Label::ground_equipment,
          [&](MeshBuilder& b) { add_container_dolly(b, loaded); },
          x + 0.15 * (random.uniform(i, static_cast<std::uint32_t>(30 + j)) - 0.5), front_y_m - dolly_m * (j + 1),
          quarter);
    }
  }
}

void add_boundary(Assembly& a, Props& props, const CargoYardOptions& options, const CargoLayout& l,
                  const Ground& ground) {
  const double west = -l.shed.length_m / 2 - 40, half = l.shed.length_m / 2;
  if (options.with_fence) {
    MeshBuilder b("fence");
    constexpr double off_dock_m = 5.2;  // the fence ends below the canopy's edge
    add_fence(b, ground, {CargoLayout::fence_x_m, CargoLayout::dock_y_m - off_dock_m},
              {CargoLayout::fence_x_m, CargoLayout::fence_y_m});
    add_fence(b, ground, {CargoLayout::fence_x_m, CargoLayout::fence_y_m}, {west, CargoLayout::fence_y_m});
    a.put(a.mesh(std::move(b).build()), Label::other);
    for (double x = CargoLayout::fence_x_m - 4; x > -half; x -= 3.4)
      props.stand("barrier", Label::other, add_barrier, x, CargoLayout::fence_y_m + 1.5, 0);
  }
  for (const double x : {-half + 10, half + 12})
    props.found(
        "lighting_mast", Label::mast, [](MeshBuilder& b) { add_lighting_mast(b, 25); }, x, 2.5, 0);
  props.stand(
      "container_loader_low", Label::ground_equipment, [](MeshBuilder& b) { add_container_loader(b, 1.2); },
      l.east_aisle_x_m + 12, 24, 1.2);
  props.stand(
      "pushback_tractor_wide", Label::vehicle, [](MeshBuilder& b) { add_pushback_tractor(b, true); },
      l.east_aisle_x_m + 12, 38, quarter);
}

void add_freighter(Props& props, const CargoYardOptions& options, const Ground& ground, std::uint64_t seed) {
  if (options.freighter == "none") return;
  const AircraftType& type = aircraft_type(options.freighter);
  const StandFrame frame{{0, CargoLayout::nose_y_m}, 1};
  props.put(
      "aircraft_" + type.name, Label::aircraft, [&] { return make_aircraft(type); },
      park(type, ground, 0, CargoLayout::nose_y_m, frame.heading_rad()));
  add_turnaround(props, type, {.frame = frame, .half_width_m = 22, .density = 1.3, .stand = 0},
                 core::RandomStream(seed, "scenes/cargo_yard/freighter"));
}

Mesh paint(const CargoYardOptions& options, const CargoLayout& l, const SlabSurface& slabs) {
  Painter p(slabs);
  const std::vector<Vector2d> loop = cargo_lane(options);
  p.use(MaterialId::paint_white_marking).layer(0);
  constexpr double half = CargoLayout::lane_half_m;
  const double w = loop[0].x(), s = loop[0].y(), e = loop[2].x(), n = loop[2].y();
  for (const double d : {-half, half})
    p.line({{w - d, s - d}, {e + d, s - d}, {e + d, n + d}, {w - d, n + d}, {w - d, s - d}}, 0.12);
  paint_lead_in_line(p, {{0, l.south_edge_m + 4}, {0, CargoLayout::nose_y_m - 5.5}}, 0.3);
  p.use(MaterialId::paint_red_marking).layer(1);
  for (int k = 0; k < dock_count(l.shed); ++k) {
    const double x = dock_y_m(l.shed, k);
    p.line({{x - 1.8, CargoLayout::dock_y_m - 0.8}, {x - 1.8, CargoLayout::dock_y_m - 9}}, 0.12);
    p.line({{x + 1.8, CargoLayout::dock_y_m - 0.8}, {x + 1.8, CargoLayout::dock_y_m - 9}}, 0.12);
  }
  return std::move(p).build();
}

Scene make_cargo_yard(const CargoYardOptions& options, const CargoLayout& l, std::uint64_t seed) {
  Scene scene;
  scene.name = "cargo-yard";
  scene.materials = materials();
  scene.interest_min = {-options.shed_length_m / 2 - 15, -40};
  scene.interest_max = {options.shed_length_m / 2 + 20, CargoLayout::dock_y_m + 20};
  const PavingSpec spec = paving(options, l);
  const auto ground = std::make_shared<WavyGround>(spec, seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(spec, seed);
  Assembly a(scene, *ground);
  const SlabSurface slabs(spec, seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  a.put(a.mesh(paint(options, l, slabs)), Label::marking);
  add_shed(a, l, *ground);
  Props props(a);
  add_docks(props, options, l, seed);
  add_racks(props, options, l, seed);
  add_trains(props, options, seed);
  add_boundary(a, props, options, l, *ground);
  add_freighter(props, options, *ground, seed);
  return scene;
}

struct Read {
  CargoYardOptions options;
  CargoLayout layout;
};

Read read(const core::ConfigNode& node) {
  const auto options = read_scene_options<CargoYardOptions>(node);
  try {
    return {options, cargo_layout(options)};
  } catch (const core::InputError& error) {
    node.fail(error.what());
  }
}

}  // namespace

extern const SceneEntry cargo_yard;
const SceneEntry cargo_yard{
    .name = "cargo-yard",
    .summary = "a cargo yard: shed with docks, container racks, dolly trains, trucks behind a fence, a freighter",
    .make =
        [](const core::ConfigNode& node, std::uint64_t seed) {
          const Read r = read(node);
          return make_cargo_yard(r.options, r.layout, seed);
        },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      const Read r = read(node);
      return std::make_shared<WavyGround>(paving(r.options, r.layout), seed);
    },
    .describe = [] { return core::describe_options<CargoYardOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) {
          return "  kind: cargo-yard\n" + core::write_options(read(node).options, 2);
        },
};

}  // namespace tarmac::scenes
