// An open apron: pavement, and as much around it as two dials allow.
#include <cmath>
#include <numbers>

#include "scenes/apron/marks.h"
#include "scenes/assembly.h"
#include "scenes/buildings/terminal.h"
#include "scenes/equipment/equipment.h"
#include "scenes/materials/materials.h"
#include "scenes/open_apron/clutter.h"
#include "scenes/open_apron/layout.h"
#include "scenes/open_apron/options.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
namespace l = open_apron;

namespace {

constexpr double nearest_facade_m = 12, largest_overhang_m = 1.5;

/// What may stand about, and how often.
struct Kind {
  const char* mesh;
  Label label;
  double weight;
  void (*add)(MeshBuilder& b);
};
constexpr std::array<Kind, 9> kinds{
    {{"cone", Label::cone, 3, add_traffic_cone},
     {"baggage_cart", Label::ground_equipment, 5, add_baggage_cart},
     {"dolly", Label::ground_equipment, 2, [](MeshBuilder& b) { add_container_dolly(b, false); }},
     {"dolly_with_container", Label::ground_equipment, 3, [](MeshBuilder& b) { add_container_dolly(b, true); }},
     {"baggage_tractor", Label::vehicle, 2, add_baggage_tractor},
     {"belt_loader", Label::ground_equipment, 2, [](MeshBuilder& b) { add_belt_loader(b, 2.2); }},
     {"ground_power_unit", Label::ground_equipment, 2, add_ground_power_unit},
     {"catering_truck", Label::vehicle, 1, add_catering_truck},
     {"passenger_stairs", Label::ground_equipment, 1, [](MeshBuilder& b) { add_passenger_stairs(b); }}}};

double plan_radius_m(const Mesh& mesh) {
  float radius = 0;
  for (const Eigen::Vector3f& p : mesh.vertices) radius = std::max(radius, p.head<2>().norm());
  return static_cast<double>(radius);
}

bool has_facade(const OpenApronOptions& options) {
  return options.facade_distance_m > 0;
}

PavingSpec paving(const OpenApronOptions& options) {
  const double behind_facade = has_facade(options) ? options.facade_distance_m + 6 : 0;
  return options.paving.spec({l::west_m, l::south_m}, {l::east_m, std::max(l::north_m, behind_facade)},
                             "scenes/open_apron");
}

/// Distance to the building's outline from outside; negative inside.
double distance_to_building_m(const Vector2d& p, double facade_y_m) {
  const Vector2d half(l::facade_half_length_m + largest_overhang_m, l::facade_depth_m / 2 + largest_overhang_m);
  const Vector2d beyond = (p - Vector2d(0, facade_y_m + l::facade_depth_m / 2)).cwiseAbs() - half;
  return beyond.maxCoeff() < 0 ? beyond.maxCoeff() : beyond.cwiseMax(0).norm();
}

void add_clutter(Assembly& a, const OpenApronOptions& options, std::uint64_t seed) {
  constexpr double edge_m = 3, square_metres_per_ha = 1e4;
  std::vector<Mesh> meshes;
  ClutterField field{.low_m = {l::west_m + edge_m, l::south_m + edge_m},
                     .high_m = {l::east_m - edge_m, l::north_m - edge_m},
                     .radius_m = {},
                     .weight = {},
                     .free_m = {}};
  for (const Kind& kind : kinds) {
    MeshBuilder b(kind.mesh);
    kind.add(b);
    meshes.push_back(std::move(b).build());
    field.radius_m.push_back(plan_radius_m(meshes.back()));
    field.weight.push_back(kind.weight);
  }
  field.free_m = [&](const Vector2d& p) {
    const double lane = l::distance_to_lane_m(p) - l::lane_free_m;
    return has_facade(options) ? std::min(lane, distance_to_building_m(p, options.facade_distance_m)) : lane;
  };
  const std::vector<ClutterItem> items =
      scatter(field, options.clutter_per_ha / square_metres_per_ha, seed, "scenes/open_apron/clutter");
  std::array<std::int64_t, kinds.size()> mesh_of{};
  mesh_of.fill(-1);  // a mesh that nothing shows stays out of the scene
  for (const ClutterItem& item : items) {
    if (mesh_of[item.kind] < 0) mesh_of[item.kind] = a.mesh(meshes[item.kind]);
    a.stand(static_cast<std::uint32_t>(mesh_of[item.kind]), kinds[item.kind].label, item.x_m, item.y_m, item.yaw_rad);
  }
}

void add_facade(Assembly& a, const Ground& ground, double facade_y_m) {
  Terminal terminal = make_terminal({.west_m = -l::facade_half_length_m,
                                     .east_m = l::facade_half_length_m,
                                     .facade_y_m = facade_y_m,
                                     .back_y_m = facade_y_m + l::facade_depth_m,
                                     .portals_x_m = {},
                                     .displays_x_m = {},
                                     .plant_x_m = {-90, -66, -31, -8, 19, 52, 84}},
                                    place(0, 0, ground.height_m(0, facade_y_m)));
  a.put(a.mesh(std::move(terminal.building)), Label::building);
  a.put(a.mesh(std::move(terminal.glass)), Label::glass);
}

Mesh make_markings(const SlabSurface& slabs) {
  Painter p(slabs);
  std::vector<Vector2d> lane;
  for (const Vector2d& point : l::lane_centre_line(1.5)) lane.push_back(point);
  paint_lead_in_line(p, lane, 0.15);
  constexpr double stop_y = -110, pitch = 42, radius = 22;
  int number = 51;
  for (double x = -63; x <= 22; x += pitch, ++number) {
    std::vector<Vector2d> line;
    constexpr int n = 20;
    for (int k = 0; k <= n; ++k) {  // off the lane's southern side, southwards
      const double angle = std::numbers::pi / 2 * k / n;
      line.emplace_back(x + radius * (1 - std::sin(angle)),
                        -2 * l::lane_turn_radius_m - radius * (1 - std::cos(angle)));
    }
    line.emplace_back(x, stop_y);
    paint_lead_in_line(p, line, 0.3);
    p.use(MaterialId::paint_yellow_marking).layer(3).rectangle({x - 3, stop_y - 0.16}, {x + 3, stop_y});
    p.layer(1);
    paint_number(p, std::to_string(number), {x - 1.2, -78}, 3, -1);
  }
  return std::move(p).build();
}

OpenApronOptions read(const core::ConfigNode& node) {
  const auto options = read_scene_options<OpenApronOptions>(node);
  if (has_facade(options) && options.facade_distance_m < nearest_facade_m)
    node.child("facade_distance_m").fail("is 0 for no façade, or at least 12: nearer, the façade stands on the lane");
  return options;
}

Scene make_open_apron(const OpenApronOptions& options, std::uint64_t seed) {
  Scene scene;
  scene.name = "open-apron";
  scene.materials = materials();
  scene.interest_min = {-120, -115};
  scene.interest_max = {120, has_facade(options) ? std::max(40.0, options.facade_distance_m + 20) : 60};
  const PavingSpec spec = paving(options);
  const auto ground = std::make_shared<WavyGround>(spec, seed);
  scene.ground = ground;
  scene.relief = std::make_shared<SlabRelief>(spec, seed);
  Assembly a(scene, *ground);
  const SlabSurface slabs(spec, seed, *ground);
  a.put(a.mesh(make_pavement(slabs)), Label::pavement);
  a.put(a.mesh(make_grass(*ground, slabs.grid())), Label::vegetation);
  if (options.with_markings) a.put(a.mesh(make_markings(slabs)), Label::marking);
  if (has_facade(options)) add_facade(a, *ground, options.facade_distance_m);
  add_clutter(a, options, seed);
  return scene;
}

}  // namespace

extern const SceneEntry open_apron_scene;
const SceneEntry open_apron_scene{
    .name = "open-apron",
    .summary = "an open apron with two dials: equipment per hectare and distance to a façade, down to bare pavement",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_open_apron(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<WavyGround>(paving(read(node)), seed);
    },
    .describe = [] { return core::describe_options<OpenApronOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: open-apron\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
