#include <algorithm>

#include "core/config.h"
#include "core/error.h"
#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

const std::vector<AircraftType>& types() {
  static const std::vector<AircraftType> all = [] {
    std::vector<AircraftType> list = regional_types();
    for (const auto& more : {narrow_body_types(), wide_body_types()}) list.insert(list.end(), more.begin(), more.end());
    std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return list;
  }();
  return all;
}

}  // namespace

std::vector<std::string> aircraft_names() {
  std::vector<std::string> names;
  for (const AircraftType& type : types()) names.push_back(type.name);
  return names;
}

const AircraftType& aircraft_type(const std::string& name) {
  for (const AircraftType& type : types()) {
    if (type.name == name) return type;
  }
  std::string message = "there is no aircraft '" + name + "'; known:";
  for (const std::string& known : aircraft_names()) message += " " + known;
  if (const std::string meant = core::did_you_mean(name, aircraft_names()); !meant.empty())
    message += "; did you mean " + meant + "?";
  throw core::InputError(message);
}

Mesh make_aircraft(const AircraftType& type, std::optional<std::size_t> open_left_door) {
  if (open_left_door && (*open_left_door >= type.doors.size() || type.doors[*open_left_door].side < 0 ||
                         type.doors[*open_left_door].sill_m < 0)) {
    throw core::InputError("aircraft " + type.name + ": door " + std::to_string(*open_left_door) +
                           " cannot be opened: it is no passenger door on the left side");
  }
  MeshBuilder b("aircraft_" + type.name);
  add_fuselage(b, type, open_left_door);
  add_wings(b, type);
  add_tail(b, type);
  add_engines(b, type);
  add_gear(b, type);
  return std::move(b).build();
}

core::SE3 park(const AircraftType& type, const Ground& ground, double nose_x_m, double nose_y_m, double heading_rad) {
  // The outermost main legs carry; a bogie more or less changes the plane by less than its tyres give.
  const LandingGear& main = *std::max_element(type.main_gear.begin(), type.main_gear.end(),
                                              [](auto& a, auto& b) { return a.half_track_m < b.half_track_m; });
  const core::SE3 T_flat = place(nose_x_m, nose_y_m, 0, heading_rad);
  const auto on_ground = [&](double station_m, double y_m) {
    const Vector3d p = T_flat * Vector3d(-station_m, y_m, 0);
    return Vector3d(p.x(), p.y(), ground.height_m(p.x(), p.y()));
  };
  const Vector3d nose = on_ground(type.nose_gear.x_m, 0);
  const Vector3d left = on_ground(main.x_m, main.half_track_m), right = on_ground(main.x_m, -main.half_track_m);
  const Vector3d forward = (nose - 0.5 * (left + right)).normalized();
  const Vector3d up = forward.cross(left - right).normalized();
  core::SE3 T = core::SE3::Identity();
  T.linear() << forward, up.cross(forward), up;
  T.translation() = nose + type.nose_gear.x_m * forward;
  return T;
}

Vector3d door_sill_world(const AircraftType& type, const core::SE3& T_world_aircraft, std::size_t door) {
  const Door& d = type.doors.at(door);
  const double z = type.floor_z_m + d.sill_m;
  return T_world_aircraft * Vector3d(-d.x_m, fuselage_half_width_m(type, d.x_m, z), z);
}

}  // namespace tarmac::scenes
