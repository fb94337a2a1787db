#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr int points_a_side = 14;

/// Half thickness of a NACA four-digit section over chord share s, for thickness 1 (Jacobs et al. 1933), with 0.2 % of
/// chord left at the trailing edge.
double half_thickness(double s) {
  const double shape =
      0.2969 * std::sqrt(s) - 0.1260 * s - 0.3516 * s * s + 0.2843 * s * s * s - 0.1036 * s * s * s * s;
  return 5 * shape;
}

/// Section in its own plane: chord along -x from the leading edge, thickness along `up`.
Ring airfoil(const Vector3d& leading_edge, double chord_m, double thickness, const Vector3d& up) {
  Ring ring;
  const auto point = [&](double s, double side) {
    const double half = (half_thickness(s) * thickness + 0.001 * s) * chord_m;
    return Vector3d(leading_edge - Vector3d::UnitX() * (s * chord_m) + up * (side * half));
  };
  const auto share = [](int k) { return 0.5 * (1 - std::cos(std::numbers::pi * k / points_a_side)); };
  for (int k = points_a_side; k >= 0; --k) ring.push_back(point(share(k), 1));  // over the top to the nose
  for (int k = 1; k <= points_a_side; ++k) ring.push_back(point(share(k), -1));
  return ring;
}

/// A station along the span: leading edge, chord, thickness share, direction of thickness.
struct SpanStation {
  Vector3d leading_edge;
  double chord_m, thickness;
  Vector3d up;
};

/// Unit vector across the span, up, for a surface with dihedral.
Vector3d up_of(const SurfacePlan& plan) {
  return {0, -std::sin(plan.dihedral_deg * deg), std::cos(plan.dihedral_deg * deg)};
}

std::vector<SpanStation> wing_stations(const SurfacePlan& plan, bool from_centre_line) {
  std::vector<SpanStation> stations;
  const auto add = [&](double y) {
    const double t = std::max(0.0, (y - plan.root_y_m) / (plan.tip_y_m - plan.root_y_m));
    stations.push_back({Vector3d(-surface_le_x_m(plan, y), y, surface_le_z_m(plan, y)), surface_chord_m(plan, y),
                        plan.thickness_root + t * (plan.thickness_tip - plan.thickness_root), up_of(plan)});
  };
  // From inside the fuselage outward.
  const double from = from_centre_line ? 0 : plan.root_y_m / 2;
  const auto span = [&](double y0, double y1, int n) {
    for (int k = 0; k < n; ++k) add(y0 + (y1 - y0) * k / n);
  };
  span(from, plan.kink_y_m, 8);
  if (plan.tip_y_m > plan.kink_y_m) span(plan.kink_y_m, plan.tip_y_m, 16);
  add(plan.tip_y_m);
  return stations;
}

/// The span bends upward, so that its outermost point is the type's half span: sharklets, blended winglets, curved
/// tips.
void append_sharklet(std::vector<SpanStation>& stations, const AircraftType& type) {
  const SpanStation tip = stations.back();
  const double tip_chord = type.device.tip_chord_share * tip.chord_m, thickness = 0.08;
  const double reach = type.span_m / 2 - tip.leading_edge.y() - 0.5 * thickness * tip_chord - 0.002;
  const double rise = type.device.rise_m, sweep = std::tan(type.device.sweep_deg * deg);
  const double start = std::atan2(-tip.up.y(), tip.up.z());  // direction of span, from horizontal
  // A quadratic Bezier from the tip along its own direction, then up: p(u) in the y-z plane.
  const Eigen::Vector2d p0(0, 0), p1(type.device.bend * reach, type.device.bend * reach * std::tan(start)),
      p2(reach, rise);
  constexpr int n = 14;
  Eigen::Vector2d before = p0;
  double arc = 0;
  for (int k = 1; k <= n; ++k) {
    const double u = static_cast<double>(k) / n;
    const Eigen::Vector2d p = (1 - u) * (1 - u) * p0 + 2 * u * (1 - u) * p1 + u * u * p2;
    const Eigen::Vector2d d = (2 * (1 - u) * (p1 - p0) + 2 * u * (p2 - p1)).normalized();
    arc += (p - before).norm();
    before = p;
    stations.push_back({Vector3d(tip.leading_edge.x() - 0.62 * arc * sweep, tip.leading_edge.y() + p.x(),
                                 tip.leading_edge.z() + p.y()),
                        tip.chord_m + (tip_chord - tip.chord_m) * u, tip.thickness + (thickness - tip.thickness) * u,
                        Vector3d(0, -d.y(), d.x())});
  }
}

/// The last metres of the span with more sweep, in the wing's own plane, down to a narrow end.
void append_raked_tip(std::vector<SpanStation>& stations, const AircraftType& type) {
  const SpanStation tip = stations.back();
  const double sweep = std::tan(type.device.sweep_deg * deg), tip_chord = type.device.tip_chord_share * tip.chord_m;
  const double rise = std::tan(type.wing.dihedral_deg * deg), leaning = -tip.up.y() * 0.5 * tip.thickness * tip_chord;
  const double reach = type.span_m / 2 - tip.leading_edge.y() - leaning - 0.001;
  constexpr int n = 8;
  for (int k = 1; k <= n; ++k) {
    const double u = static_cast<double>(k) / n;
    stations.push_back({tip.leading_edge + Vector3d(-u * reach * sweep, u * reach, u * reach * rise),
                        tip.chord_m + (tip_chord - tip.chord_m) * u, tip.thickness, tip.up});
  }
}

/// A swept plate that stands up and down at the wing's end, its outer face at the type's half span.
void add_fence(MeshBuilder& b, const SpanStation& tip, const AircraftType& type) {
  const double c = tip.chord_m, x = tip.leading_edge.x(), z = tip.leading_edge.z(), rise = type.device.rise_m;
  const double y = type.span_m / 2;
  b.use(MaterialId::aircraft_blue_topcoat);
  add_plate(b,
            {{x - 0.12 * c, z},
             {x - 0.72 * c, z - rise},
             {x - 1.02 * c, z - rise},
             {x - 1.10 * c, z},
             {x - 1.02 * c, z + rise},
             {x - 0.72 * c, z + rise}},
            y - 0.10, y);
}

/// Slat noses are bare metal, the box grey; the device wears the livery.
void loft_surface(MeshBuilder& b, const std::vector<SpanStation>& stations, std::size_t livery_from, MaterialId livery,
                  MaterialId body) {
  std::vector<Ring> rings;
  for (const SpanStation& s : stations) rings.push_back(airfoil(s.leading_edge, s.chord_m, s.thickness, s.up));
  add_loft(b, rings, [&](std::size_t i, std::size_t j) {
    if (i >= livery_from) return livery;
    return std::abs(static_cast<int>(j) - points_a_side) <= 3 ? MaterialId::polished_aluminium : body;
  });
}

/// A ring of a pod whose section is a squarish ellipse; `up` and `down` are its half heights.
Ring pod_ring(double x, double z, double half_width, double up, double down) {
  constexpr int around = 20;
  Ring ring;
  for (int j = 0; j < around; ++j) {
    const double a = 2 * std::numbers::pi * j / around, c = std::cos(a), d = std::sin(a);
    const double squarish = 1 / std::pow(std::pow(std::abs(c), 2.8) + std::pow(std::abs(d), 2.8), 1 / 2.8);
    ring.emplace_back(x, half_width * squarish * c, z + (d < 0 ? down : up) * squarish * d);
  }
  return ring;
}

/// The fairing where wing and body meet: a flat-bottomed pod below the fuselage, or one on top for a high wing.
void add_wing_fairing(MeshBuilder& b, const AircraftType& type) {
  const SurfacePlan& w = type.wing;
  const double beyond = 0.3625 * w.root_chord_m, half = w.root_y_m;
  const double from = w.root_le_x_m - beyond, to = w.root_le_x_m + w.root_chord_m + beyond;
  const double z = w.root_z_m + 0.1, low = z - type.belly_clearance_m;
  std::vector<Ring> rings;
  constexpr int n = 24;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n, x = from + (to - from) * s;
    const double swell = std::pow(std::max(0.02, std::sin(std::numbers::pi * s)), 0.35);
    rings.push_back(type.high_wing ? pod_ring(-x, z - 0.25, 0.72 * half * swell, 0.5 * swell, 0.7 * swell)
                                   : pod_ring(-x, z, 1.04 * half * swell, 0.28 * half * swell, low * swell));
  }
  b.use(MaterialId::aircraft_white_topcoat);
  add_loft(b, rings);
}

/// Canoe fairings of the flap tracks, under the trailing edge.
void add_flap_tracks(MeshBuilder& b, const std::vector<SpanStation>& stations) {
  b.use(MaterialId::aircraft_grey);
  for (const std::size_t k : {std::size_t{11}, std::size_t{14}, std::size_t{17}}) {
    const SpanStation& s = stations[k];
    const Vector3d aft =
        s.leading_edge - Vector3d::UnitX() * (0.62 * s.chord_m) - Vector3d::UnitZ() * (0.06 * s.chord_m);
    const double length = 0.62 * s.chord_m, r = 0.055 * s.chord_m;
    std::vector<Ring> rings;
    for (const auto& [along, size] : {std::pair{0.0, 0.15}, {0.15, 0.7}, {0.4, 1.0}, {0.7, 0.75}, {1.0, 0.08}}) {
      Ring ring;
      for (int j = 0; j < 10; ++j) {
        const double a = 2 * std::numbers::pi * j / 10;
        ring.emplace_back(aft - Vector3d(along * length, -r * size * std::cos(a),
                                         0.04 * along * length - 1.4 * r * size * std::sin(a)));
      }
      rings.push_back(std::move(ring));
    }
    add_loft(b, rings);
  }
}

/// A low fin of triangular outline that leads into the fin.
void add_dorsal_fin(MeshBuilder& b, const Fin& fin, double slope) {
  const double x = -fin.le_x_m - 0.4 * slope, z = fin.root_z_m;
  b.use(MaterialId::aircraft_blue_topcoat);
  add_plate(b,
            {{x + fin.dorsal_length_m, z - 0.5},
             {x - 1.5, z - 0.5},
             {x - 1.5 - slope * fin.dorsal_height_m, z + fin.dorsal_height_m},
             {x - slope * fin.dorsal_height_m, z + fin.dorsal_height_m}},
            -0.06, 0.06);
}

/// The body at the top of a T-tail's fin; its aft end is the aircraft's.
void add_tail_bullet(MeshBuilder& b, const AircraftType& type) {
  const SurfacePlan& p = type.tailplane;
  const double from = p.root_le_x_m - 0.8, to = type.length_m;
  const double z = p.root_z_m, r = (type.height_min_m + type.height_max_m) / 2 - z;
  std::vector<Ring> rings;
  constexpr int n = 12;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    const double swell = std::max(0.05, std::pow(std::sin(std::numbers::pi * std::pow(s, 0.7)), 0.6));
    rings.push_back(pod_ring(-(from + (to - from) * s), z, 0.8 * r * swell, r * swell, r * swell));
  }
  b.use(MaterialId::aircraft_white_topcoat);
  add_loft(b, rings);
}

}  // namespace

void add_wings(MeshBuilder& b, const AircraftType& type) {
  std::vector<SpanStation> stations = wing_stations(type.wing, type.high_wing);
  const std::size_t livery_from = stations.size();
  const SpanStation tip = stations.back();
  if (type.device.kind == WingTip::sharklet) append_sharklet(stations, type);
  if (type.device.kind == WingTip::raked) append_raked_tip(stations, type);
  const bool livery = type.device.kind == WingTip::sharklet;
  for (const bool right : {false, true}) {
    b.mirror_y(right);
    loft_surface(b, stations, livery ? livery_from : stations.size(), MaterialId::aircraft_blue_topcoat,
                 MaterialId::aircraft_grey);
    if (type.device.kind == WingTip::fence) add_fence(b, tip, type);
    add_flap_tracks(b, stations);
  }
  b.mirror_y(false);
  add_wing_fairing(b, type);
}

void add_tail(MeshBuilder& b, const AircraftType& type) {
  const std::vector<SpanStation> half = wing_stations(type.tailplane, true);
  for (const bool right : {false, true}) {
    b.mirror_y(right);
    loft_surface(b, half, half.size(), MaterialId::aircraft_grey, MaterialId::aircraft_grey);
  }
  b.mirror_y(false);

  const Fin& fin = type.fin;
  const double slope = std::tan(fin.le_sweep_deg * deg);
  std::vector<SpanStation> stations;
  constexpr int n = 12;
  for (int k = -2; k <= n; ++k) {  // from inside the fuselage
    const double s = static_cast<double>(k) / n, h = s * fin.height_m;
    const double chord = fin.root_chord_m + s * (fin.tip_chord_m - fin.root_chord_m);
    // Where the tail cone is thin, what begins deeper would come out below it.
    const double trailing_x = fin.le_x_m + h * slope + chord;
    if (k < 0 && fin.root_z_m + h < fuselage_section(type, trailing_x).bottom_m) continue;
    stations.push_back(
        {Vector3d(-(fin.le_x_m + h * slope), 0, fin.root_z_m + h), chord, fin.thickness, Vector3d::UnitY()});
  }
  loft_surface(b, stations, 0, MaterialId::aircraft_blue_topcoat, MaterialId::aircraft_blue_topcoat);
  if (fin.dorsal_length_m > 0) add_dorsal_fin(b, fin, slope);
  if (type.t_tail) add_tail_bullet(b, type);
}

}  // namespace tarmac::scenes
