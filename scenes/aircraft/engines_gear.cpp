#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

/// Height of the wing's lower side over y, about.
double wing_underside_z_m(const SurfacePlan& w, double y_m) {
  return surface_le_z_m(w, y_m) - 0.4 * w.thickness_root * surface_chord_m(w, y_m);
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

/// Profile turned about the engine's axis, its lower half flattened by the engine's measure: the intake, which ends at
/// the fan (a circle), less than the cowl.
void add_nacelle(MeshBuilder& b, const Engine& e, const std::vector<ProfilePoint>& profile) {
  MeshBuilder round("");
  add_lathe(round, profile, 48);
  const Mesh mesh = std::move(round).build();
  std::vector<std::uint32_t> index;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    Vector3d p = v.cast<double>();
    const double r = std::hypot(p.y(), p.z());
    // Flat where the cowl is widest, a full circle from the fan inwards and at the core nozzle.
    const double flat = 1 - (1 - e.flat_bottom) * std::clamp((r / e.radius_m - 0.78) / 0.15, 0.0, 1.0);
    p.z() = std::max(p.z(), -r * flat);
    index.push_back(b.vertex(p));
  }
  const std::size_t first = b.triangle_count();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    b.use(static_cast<MaterialId>(mesh.materials[t]));
    const auto& [i, j, k] = mesh.triangles[t];
    b.triangle(index[i], index[j], index[k]);
  }
  b.orient_outward(first);
}

/// Blades of a fan or propeller around the engine's axis, at x over it, pitched; radii of root and tip.
struct Blades {
  int count;
  double x_m, root_m, tip_m, root_chord_m, tip_chord_m, thickness_m, pitch_rad;
};
void add_blades(MeshBuilder& b, const Blades& blades, const core::SE3& T_aircraft_engine) {
  for (int k = 0; k < blades.count; ++k) {
    core::SE3 T = T_aircraft_engine;
    T.rotate(Eigen::AngleAxisd(2 * std::numbers::pi * k / blades.count, Vector3d::UnitX()));
    T.translate(Vector3d(blades.x_m, 0, 0));
    T.rotate(Eigen::AngleAxisd(blades.pitch_rad, Vector3d::UnitZ()));
    b.at(T);
    const double r = blades.root_chord_m / 2, t = blades.tip_chord_m / 2, h = blades.thickness_m / 2;
    add_plate(b, {{-r, blades.root_m}, {r, blades.root_m}, {t, blades.tip_m}, {-t, blades.tip_m}}, -h, h);
  }
  b.at(core::SE3::Identity());
}

/// Spinner, propeller and a nacelle that runs back under the wing.
void add_turboprop(MeshBuilder& b, const Engine& e, const core::SE3& T_aircraft_engine) {
  const double R = e.radius_m, L = e.length_m, tip = e.propeller.diameter_m / 2;
  b.at(T_aircraft_engine);
  using enum MaterialId;
  add_lathe(b,
            {{0.32, 0, gse_chassis},
             {0.24, 0.12, gse_chassis},
             {0.08, 0.26, gse_chassis},
             {-0.16, 0.32, gse_chassis},
             {-0.16, 0, gse_chassis}},
            24);
  std::vector<Ring> rings;
  for (const auto& [s, wide, up, down] : std::vector<std::array<double, 4>>{{0.06, 0.56, 0.52, 0.75},
                                                                            {0.10, 0.68, 0.60, 1.0},
                                                                            {0.25, 0.90, 0.85, 1.12},
                                                                            {0.45, 1.0, 1.0, 1.05},
                                                                            {0.65, 0.95, 1.0, 0.85},
                                                                            {0.85, 0.70, 0.95, 0.45},
                                                                            {1.0, 0.28, 0.85, -0.25}}) {
    Ring ring;
    for (int j = 0; j < 32; ++j) {
      const double a = 2 * std::numbers::pi * j / 32, c = std::cos(a), d = std::sin(a);
      const double middle = 0.5 * (up - down), half = 0.5 * (up + down);
      ring.emplace_back(-s * L, R * wide * c, R * (middle + half * d));
    }
    rings.push_back(std::move(ring));
  }
  b.use(aircraft_white_topcoat);
  add_loft(b, rings);
  b.use(exhaust_metal);
  add_frustum(b, {-0.55 * L, R * 0.8, -0.1}, {-0.72 * L, R * 1.15, -0.15}, 0.2, 0.17, 20);
  b.use(gse_chassis);
  add_blades(b, {e.propeller.blades, 0, 0.2, tip, 0.22, 0.26, 0.05, 1.1}, T_aircraft_engine);
}

void add_pylon(MeshBuilder& b, const AircraftType& type, const Engine& e, double axis_z_m) {
  const double x0 = e.lip_x_m + 0.22 * e.length_m;
  const double x1 = std::max(e.lip_x_m + 1.05 * e.length_m,  // at least into the wing's nose
                             surface_le_x_m(type.wing, e.y_m) + 0.12 * surface_chord_m(type.wing, e.y_m));
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

/// Where the two halves of a leg are, and what holds them.
struct LegPlace {
  double y_m, top_y_m, top_z_m;
};

/// Leg from the axle up, two wheels a row, a beam along the rows, torque link.
void add_leg(MeshBuilder& b, const LandingGear& gear, const LegPlace& leg) {
  const double axle_z = gear.wheel_radius_m, x = -gear.x_m, y = leg.y_m, half = gear.wheel_spacing_m / 2;
  const int rows = std::max(1, gear.wheels / 2);
  for (int row = 0; row < rows; ++row) {
    const double dx = (row - (rows - 1) / 2.0) * gear.row_spacing_m;
    for (const double side : {-half, half})
      add_wheel(b, {x + dx, y + side, 0}, gear.wheel_radius_m, gear.wheel_width_m);
    b.use(MaterialId::galvanised_steel);
    add_frustum(b, {x + dx, y - half, axle_z}, {x + dx, y + half, axle_z}, 0.2 * axle_z, 0.2 * axle_z, 12);
  }
  if (rows > 1) {
    const double reach = (rows - 1) / 2.0 * gear.row_spacing_m + 0.15;
    add_beam(b, {x - reach, y, axle_z}, {x + reach, y, axle_z}, 0.25, 0.3);
  }
  const double r = 0.24 * axle_z, mid = axle_z + 0.45 * (leg.top_z_m - axle_z), lean = leg.top_y_m - y;
  add_frustum(b, {x, y, axle_z}, {x, y + 0.3 * lean, mid}, 0.7 * r, 0.7 * r, 14);
  add_frustum(b, {x, y + 0.28 * lean, mid - 0.1}, {x, leg.top_y_m, leg.top_z_m}, r, 1.1 * r, 14);
  add_beam(b, {x - 0.12, y, axle_z}, {x - 0.42 * axle_z - 0.12, y, (axle_z + mid) / 2}, 0.12, 0.06);
  add_beam(b, {x - 0.42 * axle_z - 0.12, y, (axle_z + mid) / 2}, {x - 0.12, y, mid}, 0.12, 0.06);
}

/// Leg and the two open doors of its bay, their upper edges inside the skin.
void add_nose_gear(MeshBuilder& b, const AircraftType& type) {
  const LandingGear& gear = type.nose_gear;
  const double scale = gear.wheel_radius_m / 0.381, forward = 0.7 * scale, aft = 0.15 * scale;
  add_leg(b, gear, {0, 0, fuselage_section(type, gear.x_m).bottom_m + 0.4});
  b.use(MaterialId::aircraft_white_topcoat);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * 0.42 * scale, x = -gear.x_m;
    const auto skin = [&](double station) { return fuselage_section(type, station).underside_m(y) + 0.06; };
    const double z_aft = skin(gear.x_m + aft), z_fore = skin(gear.x_m - forward), low = skin(gear.x_m) - 0.68 * scale;
    add_plate(b, {{x - aft, z_aft}, {x - aft, low}, {x + forward, low}, {x + forward, z_fore}}, y - 0.015, y + 0.015);
  }
}

void add_main_gear(MeshBuilder& b, const AircraftType& type, const LandingGear& gear, int side) {
  const double y = side * gear.half_track_m, r = gear.wheel_radius_m;
  if (type.high_wing) {
    const Sponson& s = type.sponson;
    add_leg(b, gear, {y, side * (s.half_width_m - 0.25), (s.low_z_m + s.high_z_m) / 2});
    return;
  }
  const double top = wing_underside_z_m(type.wing, gear.half_track_m) + 0.2;
  add_leg(b, gear, {y, y - side * 0.15, top});
  b.use(MaterialId::aircraft_grey);
  const double door_y = y + side * 0.126 * gear.wheel_spacing_m, x = -gear.x_m, k = r / 0.584;
  add_plate(b, {{x - 0.35 * k, top}, {x - 0.25 * k, 2.2 * r}, {x + 0.25 * k, 2.2 * r}, {x + 0.35 * k, top}},
            door_y - 0.02, door_y + 0.02);
}

/// The bulge at the fuselage's left side (mirrored by the builder for the right one).
void add_sponson(MeshBuilder& b, const Sponson& s) {
  std::vector<Ring> rings;
  constexpr int n = 20, around = 24;
  const double z = (s.low_z_m + s.high_z_m) / 2, half_height = (s.high_z_m - s.low_z_m) / 2, depth = 0.75;
  for (int i = 0; i <= n; ++i) {
    const double share = static_cast<double>(i) / n;
    const double swell = std::max(0.1, std::pow(std::sin(std::numbers::pi * share), 0.6));
    Ring ring;
    for (int j = 0; j < around; ++j) {
      const double a = 2 * std::numbers::pi * j / around;
      ring.emplace_back(-(s.from_x_m + (s.to_x_m - s.from_x_m) * share),
                        s.half_width_m - depth + depth * swell * std::cos(a), z + half_height * swell * std::sin(a));
    }
    rings.push_back(std::move(ring));
  }
  b.use(MaterialId::aircraft_white_topcoat);
  add_loft(b, rings);
}

}  // namespace

void add_engines(MeshBuilder& b, const AircraftType& type) {
  for (const bool right : {false, true}) {
    b.mirror_y(right);
    for (const Engine& e : type.engines) {
      const bool propeller = e.propeller.blades > 0;
      const double axis_z = e.ground_gap_m + (propeller ? e.propeller.diameter_m / 2 : e.flat_bottom * e.radius_m);
      // mirror_y acts before the placement, so the right nacelle is placed by its own y.
      const core::SE3 T_aircraft_engine = place(-e.lip_x_m, right ? -e.y_m : e.y_m, axis_z);
      if (propeller) {
        add_turboprop(b, e, T_aircraft_engine);
        continue;
      }
      b.at(T_aircraft_engine);
      add_nacelle(b, e, nacelle_profile(e));
      const double r = e.radius_m;
      b.use(MaterialId::exhaust_metal);
      add_blades(b, {20, -0.215 * e.length_m, 0.2 * r, 0.76 * r, 0.1 * r, 0.2 * r, 0.02 * r, 0.7}, T_aircraft_engine);
      add_pylon(b, type, e, axis_z);
    }
  }
  b.mirror_y(false);
}

void add_gear(MeshBuilder& b, const AircraftType& type) {
  add_nose_gear(b, type);
  for (const LandingGear& gear : type.main_gear) {
    for (const int side : {1, -1}) add_main_gear(b, type, gear, side);
  }
  if (type.sponson.half_width_m == 0) return;
  for (const bool right : {false, true}) {
    b.mirror_y(right);
    add_sponson(b, type.sponson);
  }
  b.mirror_y(false);
}

}  // namespace tarmac::scenes
