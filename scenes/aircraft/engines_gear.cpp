#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

/// Height of the wing's lower side over (x, y), about.
double wing_underside_z_m(const SurfacePlan& w, double y_m) {
  const double z = w.root_z_m + (y_m - w.root_y_m) * std::tan(w.dihedral_deg * std::numbers::pi / 180);
  const double chord =
      w.root_chord_m + (w.kink_chord_m - w.root_chord_m) * (y_m - w.root_y_m) / (w.kink_y_m - w.root_y_m);
  return z - 0.4 * w.thickness_root * chord;
}

/// Spinner, fan disk, intake, polished lip, cowl, fan nozzle, core cowl and plug, turned about one axis in one piece.
std::vector<ProfilePoint> nacelle_profile(const Engine& e) {
  const double R = e.radius_m, L = e.length_m;
  using enum MaterialId;
  return {
      {-0.14 * L, 0, gse_chassis},
      {-0.20 * L, 0.13 * R, gse_chassis},
      {-0.25 * L, 0.27 * R, exhaust_metal},
      {-0.25 * L, 0.78 * R, aircraft_grey},
      {-0.12 * L, 0.79 * R, aircraft_grey},
      {-0.045 * L, 0.80 * R, polished_aluminium},
      {-0.012 * L, 0.83 * R, polished_aluminium},
      {0, 0.865 * R, polished_aluminium},
      {-0.010 * L, 0.90 * R, polished_aluminium},
      {-0.045 * L, 0.94 * R, aircraft_blue_topcoat},
      {-0.14 * L, 0.98 * R, aircraft_blue_topcoat},
      {-0.28 * L, R, aircraft_blue_topcoat},
      {-0.45 * L, 0.985 * R, aircraft_blue_topcoat},
      {-0.60 * L, 0.93 * R, aircraft_blue_topcoat},
      {-0.74 * L, 0.83 * R, exhaust_metal},
      {-0.735 * L, 0.80 * R, exhaust_metal},
      {-0.60 * L, 0.78 * R, exhaust_metal},
      {-0.60 * L, 0.60 * R, aircraft_grey},
      {-0.76 * L, 0.53 * R, exhaust_metal},
      {-0.90 * L, 0.40 * R, exhaust_metal},
      {-0.895 * L, 0.36 * R, exhaust_metal},
      {-0.84 * L, 0.35 * R, exhaust_metal},
      {-0.84 * L, 0.24 * R, exhaust_metal},
      {-0.93 * L, 0.17 * R, exhaust_metal},
      {-1.0 * L, 0, exhaust_metal},
  };
}

/// Blades in front of the fan disk, pitched by 50 degrees; x along the engine's axis.
void add_fan_blades(MeshBuilder& b, const Engine& e, const core::SE3& T_aircraft_engine) {
  constexpr int blades = 20;
  b.use(MaterialId::exhaust_metal);
  for (int k = 0; k < blades; ++k) {
    core::SE3 T = T_aircraft_engine;
    T.rotate(Eigen::AngleAxisd(2 * std::numbers::pi * k / blades, Vector3d::UnitX()));
    T.translate(Vector3d(-0.215 * e.length_m, 0, 0));
    T.rotate(Eigen::AngleAxisd(0.7, Vector3d::UnitZ()));
    b.at(T);
    const double r = e.radius_m;
    add_plate(b, {{-0.05 * r, 0.2 * r}, {0.05 * r, 0.2 * r}, {0.1 * r, 0.76 * r}, {-0.1 * r, 0.76 * r}}, -0.01 * r,
              0.01 * r);
  }
  b.at(core::SE3::Identity());
}

void add_pylon(MeshBuilder& b, const AircraftType& type, const Engine& e, double axis_z_m) {
  const double x0 = e.lip_x_m + 0.22 * e.length_m, x1 = e.lip_x_m + 1.05 * e.length_m;
  const double top = wing_underside_z_m(type.wing, e.y_m) + 0.12, half = 0.17;
  b.use(MaterialId::aircraft_grey);
  std::vector<Ring> rings;
  const std::array<std::array<double, 3>, 6> stations{
      {// share of length, lower and upper height over the nacelle's axis
       {0.0, 0.90, 1.01},
       {0.25, 0.84, 1.12},
       {0.5, 0.75, 1.22},
       {0.75, 0.66, 1.24},
       {0.9, 0.80, 1.24},
       {1.0, 1.08, 1.24}}};
  for (const auto& [s, low, high] : stations) {
    const double x = -(x0 + (x1 - x0) * s), w = half * (0.35 + 0.65 * std::sin(std::numbers::pi * (0.1 + 0.8 * s)));
    const double z0 = axis_z_m + low * e.radius_m;
    const double z1 = std::max(z0 + 0.08, std::min(axis_z_m + high * e.radius_m, top + 0.1));
    rings.push_back({{x, e.y_m - w, z0}, {x, e.y_m + w, z0}, {x, e.y_m + w, z1}, {x, e.y_m - w, z1}});
  }
  add_loft(b, rings);
}

/// A tyre with hub; axis along y, standing on z = 0.
void add_wheel(MeshBuilder& b, const Vector3d& centre_on_ground, double radius_m, double width_m) {
  using enum MaterialId;
  const double r = radius_m, h = width_m / 2;
  core::SE3 T = core::SE3::Identity();
  T.linear().col(0) = Vector3d::UnitY();
  T.linear().col(1) = -Vector3d::UnitX();
  T.linear().col(2) = Vector3d::UnitZ();
  T.translation() = centre_on_ground + Vector3d(0, 0, r);
  b.at(T);
  add_lathe(b,
            {{-0.6 * h, 0, galvanised_steel},
             {-0.6 * h, 0.5 * r, tyre_rubber},
             {-0.95 * h, 0.58 * r, tyre_rubber},
             {-h, 0.78 * r, tyre_rubber},
             {-0.8 * h, 0.95 * r, tyre_rubber},
             {-0.4 * h, r, tyre_rubber},
             {0.4 * h, r, tyre_rubber},
             {0.8 * h, 0.95 * r, tyre_rubber},
             {h, 0.78 * r, tyre_rubber},
             {0.95 * h, 0.58 * r, tyre_rubber},
             {0.6 * h, 0.5 * r, galvanised_steel},
             {0.6 * h, 0, galvanised_steel}},
            28);
  b.at(core::SE3::Identity());
}

/// Leg from the axle up to `top_z_m`, two wheels a row, torque link and one gear door.
void add_leg(MeshBuilder& b, const LandingGear& gear, double y_m, double top_z_m, double lean_y_m) {
  const double axle_z = gear.wheel_radius_m, x = -gear.x_m, half = gear.wheel_spacing_m / 2;
  const int rows = std::max(1, gear.wheels / 2);
  for (int row = 0; row < rows; ++row) {
    const double dx = (row - (rows - 1) / 2.0) * 2.3 * gear.wheel_radius_m;
    for (const double side : {-half, half})
      add_wheel(b, {x + dx, y_m + side, 0}, gear.wheel_radius_m, gear.wheel_width_m);
    b.use(MaterialId::galvanised_steel);
    add_frustum(b, {x + dx, y_m - half, axle_z}, {x + dx, y_m + half, axle_z}, 0.2 * axle_z, 0.2 * axle_z, 12);
  }
  if (rows > 1) add_beam(b, {x - 1.2 * rows * axle_z, y_m, axle_z}, {x + 1.2 * rows * axle_z, y_m, axle_z}, 0.25, 0.3);
  const double r = 0.24 * axle_z, mid = axle_z + 0.45 * (top_z_m - axle_z);
  add_frustum(b, {x, y_m, axle_z}, {x, y_m + 0.3 * lean_y_m, mid}, 0.7 * r, 0.7 * r, 14);
  add_frustum(b, {x, y_m + 0.28 * lean_y_m, mid - 0.1}, {x, y_m + lean_y_m, top_z_m}, r, 1.1 * r, 14);
  add_beam(b, {x - 0.12, y_m, axle_z}, {x - 0.42 * axle_z - 0.12, y_m, (axle_z + mid) / 2}, 0.12, 0.06);
  add_beam(b, {x - 0.42 * axle_z - 0.12, y_m, (axle_z + mid) / 2}, {x - 0.12, y_m, mid}, 0.12, 0.06);
}

}  // namespace

void add_engines(MeshBuilder& b, const AircraftType& type) {
  for (const bool right : {false, true}) {
    b.mirror_y(right);
    for (const Engine& e : type.engines) {
      const double axis_z = e.ground_gap_m + e.radius_m;
      // mirror_y acts before the placement, so the right nacelle is placed by its own y.
      const core::SE3 T_aircraft_engine = place(-e.lip_x_m, right ? -e.y_m : e.y_m, axis_z);
      b.at(T_aircraft_engine);
      add_lathe(b, nacelle_profile(e), 48);
      add_fan_blades(b, e, T_aircraft_engine);
      add_pylon(b, type, e, axis_z);
    }
  }
  b.mirror_y(false);
}

void add_gear(MeshBuilder& b, const AircraftType& type) {
  double belly = 0;
  for (const FuselageStation& s : type.stations) belly = std::min(belly, s.bottom_m);
  add_leg(b, type.nose_gear, 0, type.floor_z_m + 0.75 * belly, 0);
  b.use(MaterialId::aircraft_white_topcoat);
  for (const double y : {-0.42, 0.42}) {  // open doors of the nose gear bay, their upper edge inside the skin
    const double x = -type.nose_gear.x_m, z = type.floor_z_m + 0.93 * belly;
    add_plate(b, {{x - 0.15, z}, {x - 0.15, z - 0.62}, {x + 0.7, z - 0.62}, {x + 0.7, z}}, y - 0.015, y + 0.015);
  }
  for (const LandingGear& gear : type.main_gear) {
    for (const int side : {1, -1}) {
      const double y = side * gear.half_track_m, top = wing_underside_z_m(type.wing, gear.half_track_m) + 0.2;
      add_leg(b, gear, y, top, -side * 0.15);
      b.use(MaterialId::aircraft_grey);
      const double door_y = y + side * 0.42 * gear.wheel_spacing_m * 0.3, x = -gear.x_m;
      add_plate(b,
                {{x - 0.35, top},
                 {x - 0.25, 2.2 * gear.wheel_radius_m},
                 {x + 0.25, 2.2 * gear.wheel_radius_m},
                 {x + 0.35, top}},
                door_y - 0.02, door_y + 0.02);
    }
  }
}

}  // namespace tarmac::scenes
