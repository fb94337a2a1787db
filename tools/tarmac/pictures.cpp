#include "tools/tarmac/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "reports/contact_sheet.h"
#include "reports/report.h"
#include "scenarios/scenario.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/equipment/equipment.h"
#include "scenes/equipment/person.h"
#include "scenes/registry.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {
namespace {

using Eigen::Vector3d;

constexpr int kPictureWidth_px = 1600, kPictureHeight_px = 900;
constexpr int kSheetQuality_percent = 78;

/// A thing on a flat floor of concrete, in a scene of its own, its front to -x.
struct Showroom {
  scenes::Scene scene;
  std::vector<Vector3d> points;
  Eigen::AlignedBox3d box;
};

void put(Showroom& room, scenes::Mesh mesh, scenes::Label label, const core::SE3& T_thing_mesh) {
  const core::SE3 T_world_mesh = scenes::place(0, 0, 0, std::numbers::pi) * T_thing_mesh;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    room.points.push_back(T_world_mesh * p.cast<double>());
    room.box.extend(room.points.back());
  }
  room.scene.meshes.push_back(std::move(mesh));
  room.scene.instances.push_back({static_cast<std::uint32_t>(room.scene.meshes.size() - 1), label, -1, T_world_mesh});
}

/// Adds the floor, which reaches a good way beyond what stands on it.
void finish(Showroom& room) {
  const double beyond = 0.6 * room.box.sizes().head<2>().norm() + 2;
  const Vector3d low = room.box.min().array() - beyond, high = room.box.max().array() + beyond;
  scenes::MeshBuilder floor("floor");
  floor.use(scenes::MaterialId::concrete_dry);
  scenes::add_patch(floor, {low.x(), low.y(), 0}, {high.x(), low.y(), 0}, {high.x(), high.y(), 0},
                    {low.x(), high.y(), 0}, 8, 8);
  room.scene.meshes.push_back(std::move(floor).build());
  room.scene.instances.push_back(
      {static_cast<std::uint32_t>(room.scene.meshes.size() - 1), scenes::Label::pavement, -1, core::SE3::Identity()});
  room.scene.materials = scenes::materials();
  room.scene.interest_min = room.box.min().head<2>();
  room.scene.interest_max = room.box.max().head<2>();
}

/// With a person of 1.75 m beside the left inner engine, for scale.
Showroom show_aircraft(const std::string& name) {
  const scenes::AircraftType& type = scenes::aircraft_type(name);
  Showroom room;
  put(room, scenes::make_aircraft(type), scenes::Label::aircraft, core::SE3::Identity());
  const scenes::Engine& e = type.engines.front();
  const double beside = std::max(e.radius_m, e.propeller.diameter_m / 2) + 0.9;
  put(room, scenes::make_person({}), scenes::Label::person, scenes::place(-e.lip_x_m - 0.3, e.y_m + beside, 0, 0.6));
  finish(room);
  return room;
}

/// With a person beside it, unless it is one.
Showroom show_equipment(const std::string& name) {
  const scenes::EquipmentEntry& entry = scenes::equipment_entry(name);
  Showroom room;
  put(room, scenes::make_equipment(name), entry.label, core::SE3::Identity());
  if (entry.label != scenes::Label::person) {
    put(room, scenes::make_person({}), scenes::Label::person,
        scenes::place(-0.1 * entry.length_m, -room.box.min().y() + 0.7, 0, 0.6));
  }
  finish(room);
  return room;
}

scenes::Scene default_scene(const std::string& name) {
  return scenes::make_scene(core::ConfigNode::parse("kind: " + name + "\n", "describe scene " + name), 1);
}

reports::Image sheet_of_exhibits(const std::vector<std::string>& names, Showroom (*show)(const std::string&),
                                 int columns, int width_px, int height_px, int outline_px) {
  std::vector<Showroom> rooms;
  double widest_m = 0, tallest_m = 0;
  for (const std::string& name : names) {
    rooms.push_back(show(name));
    const Vector3d size = rooms.back().box.sizes();
    widest_m = std::max(widest_m, size.x() + size.y());
    tallest_m = std::max(tallest_m, size.z());
  }
  const double m_per_px = std::max(widest_m / (width_px - 24), tallest_m / (outline_px - 8));
  std::vector<reports::Tile> tiles;
  for (std::size_t k = 0; k < names.size(); ++k) {
    tiles.push_back({names[k], reports::exhibit_tile({&rooms[k].scene, rooms[k].points}, m_per_px, width_px, height_px,
                                                     outline_px)});
  }
  return reports::contact_sheet(tiles, columns);
}

reports::Image sheet_of_scenes() {
  constexpr int columns = 4, width_px = 420, height_px = 240;
  std::vector<reports::Tile> tiles;
  for (const auto* entry : scenes::scenes()) {
    const scenes::Scene scene = default_scene(entry->name);
    tiles.push_back({entry->name, reports::Stills(scene, core::Time{}).overview(width_px, height_px)});
  }
  return reports::contact_sheet(tiles, std::min(columns, static_cast<int>(tiles.size())));
}

reports::Image sheet_of(const std::string& kind) {
  if (kind == "scene") return sheet_of_scenes();
  if (kind == "aircraft") return sheet_of_exhibits(scenes::aircraft_names(), show_aircraft, 4, 520, 410, 110);
  if (kind == "equipment") {
    std::vector<std::string> names;
    for (const scenes::EquipmentEntry& entry : scenes::equipment()) names.emplace_back(entry.name);
    return sheet_of_exhibits(names, show_equipment, 5, 340, 300, 84);
  }
  throw core::InputError("describe " + kind + " all -o: a contact sheet exists of scene, aircraft and equipment only");
}

reports::Image picture_of(const Showroom& room, const std::optional<reports::EyeView>& from) {
  if (from) {
    return reports::Stills(room.scene, core::Time{}).seen_from(*from, kPictureWidth_px, kPictureHeight_px);
  }
  return reports::exhibit_picture({&room.scene, room.points}, kPictureWidth_px, kPictureHeight_px);
}

std::optional<reports::EyeView> eye_of(const DescribeArguments& arguments) {
  if (arguments.eye.empty() && arguments.look_at.empty()) return {};
  if (arguments.eye.empty() || arguments.look_at.empty())
    throw core::InputError("--eye and --look-at belong together: give both (x,y,z in metres) or neither");
  if (arguments.name == "all")
    throw core::InputError("--eye: a contact sheet has views of its own; name one thing instead of all");
  const reports::EyeView view{reports::point_from("--eye", arguments.eye),
                              reports::point_from("--look-at", arguments.look_at)};
  reports::check(view);
  return view;
}

}  // namespace

void check_picture(const DescribeArguments& arguments) {
  if (arguments.picture.empty() && !(arguments.eye.empty() && arguments.look_at.empty()))
    throw core::InputError("--eye and --look-at say where a picture is seen from: add -o picture.png");
  eye_of(arguments);
}

void draw_picture(const DescribeArguments& arguments) {
  const std::optional<reports::EyeView> from = eye_of(arguments);
  if (arguments.name == "all") {
    reports::write_picture(arguments.picture, sheet_of(arguments.kind), kSheetQuality_percent);
  } else if (arguments.kind == "aircraft") {
    reports::write_picture(arguments.picture, picture_of(show_aircraft(arguments.name), from));
  } else if (arguments.kind == "equipment") {
    reports::write_picture(arguments.picture, picture_of(show_equipment(arguments.name), from));
  } else if (arguments.kind == "scene") {
    reports::render_scene(arguments.picture, default_scene(arguments.name), core::Time{}, kPictureWidth_px,
                          kPictureHeight_px, from);
  } else if (arguments.kind == "scenario") {
    const auto scenario = scenarios::load_scenario(scenarios::find_scenario(arguments.name, scenario_folders()), {});
    const scenes::Scene scene = scenes::make_scene(scenario.scene, static_cast<std::uint64_t>(scenario.seed));
    reports::render_scene(arguments.picture, scene, core::time_from_s(scenario.duration_s / 2), kPictureWidth_px,
                          kPictureHeight_px, from);
  } else {
    throw core::InputError(
        fmt::format("describe {} -o: only scene, scenario, aircraft and equipment have a picture", arguments.kind));
  }
}

}  // namespace tarmac::tools
