#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double seam_m = 0.05;

double interpolate(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
}

/// Heights above ground that lines of the skin follow from bottom to top, so that panes and doors have clean edges.
enum Line : std::size_t {
  bottom,
  hold_low,
  hold_high,
  sill,
  sill_seam,
  window_low,
  window_high,
  door_seam,
  door_high,
  upper_sill,
  upper_sill_seam,
  upper_window_low,
  upper_window_high,
  upper_door_seam,
  upper_door_high,
  post,
  crown,
  lines
};
using Quads = std::array<int, lines - 1>;

/// Quads between each line and the next; a single deck has none between the lines of the upper one.
const Quads& quads_between(const AircraftType& type) {
  static constexpr Quads single{7, 5, 2, 1, 4, 2, 3, 1, 0, 0, 0, 0, 0, 0, 4, 1};
  static constexpr Quads twin{7, 5, 2, 1, 3, 2, 3, 1, 2, 1, 3, 2, 2, 1, 4, 1};
  return type.upper.floor_m > 0 ? twin : single;
}

/// Ahead of the windshield and behind the last door nothing needs the lines: there they spread out evenly.
void spread_at_the_ends(const AircraftType& type, double x_m, std::array<double, lines>& angles) {
  double last_door = 0;
  for (const Door& door : type.doors) last_door = std::max(last_door, door.x_m + door.width_m);
  const double nose = 1 - std::clamp((x_m - 0.3) / (type.cockpit.windshield_from_x_m - 0.35), 0.0, 1.0);
  const double tail = std::clamp((x_m - last_door) / 3, 0.0, 1.0), share = std::max(nose, tail);
  const Quads& between = quads_between(type);
  const double total = std::accumulate(between.begin(), between.end(), 0);
  int quads = 0;
  for (std::size_t k = 1; k + 1 < lines; ++k) {
    quads += between[k - 1];
    angles[k] += share * (pi * (quads / total - 0.5) - angles[k]);
  }
}

/// Heights of the lines above the cabin floor at station x, before they are fitted into the section.
std::array<double, lines> line_heights(const AircraftType& type, double x_m) {
  const CockpitWindows& c = type.cockpit;
  const double cabin_x = c.side_to_x_m + 0.6, door_height = type.doors.front().height_m;
  double low = interpolate(x_m, c.windshield_from_x_m, c.low_front_m, c.side_to_x_m, c.low_aft_m);
  low = interpolate(x_m, c.side_to_x_m, low, cabin_x, type.windows.low_m);
  double high = interpolate(x_m, c.windshield_to_x_m, c.high_front_m, c.side_to_x_m, c.high_aft_m);
  high = interpolate(x_m, c.side_to_x_m, high, cabin_x, type.windows.high_m);
  double belly = 0;
  for (const FuselageStation& s : type.stations) belly = std::min(belly, s.bottom_m);
  const Door& hold = type.doors.back();
  const bool has_hold = hold.sill_m < 0;
  std::array<double, lines> z{-1e3,
                              has_hold ? hold.sill_m : 0.6 * belly,
                              has_hold ? hold.sill_m + hold.height_m : 0.25 * belly,
                              0,
                              seam_m,
                              low,
                              high,
                              door_height - seam_m,
                              door_height};
  const UpperDeck& u = type.upper;
  const bool twin = u.floor_m > 0;
  const double u_high = u.floor_m + u.door_height_m;
  z[upper_sill] = twin ? u.floor_m : door_height;
  z[upper_sill_seam] = twin ? u.floor_m + seam_m : door_height;
  z[upper_window_low] = twin ? u.window_low_m : door_height;
  z[upper_window_high] = twin ? u.window_high_m : door_height;
  z[upper_door_seam] = twin ? u_high - seam_m : door_height;
  z[upper_door_high] = twin ? u_high : door_height;
  z[post] = z[crown] = 1e3;
  return z;
}

std::array<double, lines> line_angles(const AircraftType& type, const FuselageSection& section, double x_m) {
  const std::array<double, lines> z = line_heights(type, x_m);
  const Quads& between = quads_between(type);
  std::array<double, lines> angles{};
  for (std::size_t k = 0; k < lines; ++k) angles[k] = section.angle(type.floor_z_m + z[k]);
  // The windshield reaches up to the centre post, a few centimetres off the crown.
  angles[post] = std::acos(std::min(0.9, 0.04 / std::max(section.half_width_m, 0.05)));
  if (type.upper.floor_m == 0) {
    const double on_windshield = 1 - std::clamp((x_m - type.cockpit.windshield_to_x_m) / 0.12, 0.0, 1.0);
    angles[window_high] += on_windshield * (angles[post] - 0.06 - angles[window_high]);
  }
  // Where the section is too small for a line, the lines share what angle there is.
  constexpr double least = 0.012;
  for (std::size_t k = 1; k < lines; ++k) angles[k] = std::max(angles[k], angles[k - 1] + least * between[k - 1]);
  for (std::size_t k = lines - 1; k-- > 0;) {
    const double ceiling = k + 2 == lines ? pi / 2 : angles[k + 1];
    angles[k] = std::min(angles[k], ceiling - least * between[k]);
  }
  angles[crown] = pi / 2;
  angles[bottom] = -pi / 2;
  spread_at_the_ends(type, x_m, angles);
  return angles;
}

/// Stations of all rings: every edge of a door or window, filled up so that no two are further apart than 0.3 m on a
/// narrow body, in proportion on a wide one.
std::vector<double> ring_stations(const AircraftType& type) {
  std::vector<double> xs{0.0015, 0.012, 0.04, type.stations.front().x_m, type.stations.back().x_m - 0.01};
  const auto edges = [&xs](double centre, double width) {
    for (const double d : {-width / 2, -width / 2 + seam_m, width / 2 - seam_m, width / 2}) xs.push_back(centre + d);
  };
  for (const Door& door : type.doors) edges(door.x_m, door.width_m);
  const CabinWindows& w = type.windows;
  for (double x = w.from_x_m; x <= w.to_x_m; x += w.pitch_m) {
    xs.push_back(x - w.width_m / 2);
    xs.push_back(x + w.width_m / 2);
  }
  const CockpitWindows& c = type.cockpit;
  xs.push_back(c.windshield_from_x_m);
  xs.push_back(c.windshield_to_x_m);
  for (int k = 0; k < c.side_panes; ++k) {
    const double pane = (c.side_to_x_m - c.windshield_to_x_m) / c.side_panes;
    xs.push_back(c.windshield_to_x_m + k * pane + 0.12);
    xs.push_back(c.windshield_to_x_m + (k + 1) * pane);
  }
  std::sort(xs.begin(), xs.end());
  double half_width = 0;
  for (const FuselageStation& s : type.stations) half_width = std::max(half_width, s.half_width_m);
  const double scale = std::max(1.0, half_width / 1.98);
  std::vector<double> kept{xs.front()};
  for (std::size_t k = 1; k < xs.size(); ++k) {
    const double gap = xs[k] - kept.back();
    if (xs[k] > 0.1 && gap < 0.012) continue;  // two features meet: one ring serves both
    const double widest = xs[k] < 4 ? 0.15 : 0.3 * scale;
    const int n = static_cast<int>(std::ceil(gap / widest));
    const double from = kept.back();
    for (int i = 1; i <= n; ++i) kept.push_back(from + gap * i / n);
  }
  return kept;
}

/// Angles of the vertices from bottom to crown on one side.
std::vector<double> side_angles(const AircraftType& type, const FuselageSection& section, double x_m) {
  const std::array<double, lines> at = line_angles(type, section, x_m);
  const Quads& between = quads_between(type);
  std::vector<double> angles;
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    for (int q = 0; q < between[k]; ++q) angles.push_back(at[k] + (at[k + 1] - at[k]) * q / between[k]);
  }
  angles.push_back(pi / 2);
  return angles;
}

/// The line at or below quad j of one side.
Line line_below(const AircraftType& type, std::size_t j) {
  const Quads& between = quads_between(type);
  int sum = 0;
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    sum += between[k];
    if (static_cast<int>(j) < sum) return static_cast<Line>(k);
  }
  return post;
}

/// Lowest and highest seam line of a door.
std::pair<Line, Line> seams(const Door& door) {
  return door.sill_m < 0   ? std::pair{hold_low, hold_low}
         : door.sill_m > 0 ? std::pair{upper_sill, upper_door_seam}
                           : std::pair{sill, door_seam};
}

bool on_seam(const Door& door, double x_m, Line line, int side) {
  if (door.side != 0 && door.side != side) return false;
  const double off = std::abs(x_m - door.x_m), half = door.width_m / 2;
  if (off > half) return false;
  const bool upright = off > half - seam_m;
  const auto [low, high] = seams(door);
  if (low == high) return line == low && upright;
  return line == low || line == high || (upright && line >= low && line <= high);
}

MaterialId skin(const AircraftType& type, double x_m, Line line, int side) {
  const CockpitWindows& c = type.cockpit;
  if (x_m > c.windshield_from_x_m && x_m < c.side_to_x_m && line == window_low) {
    if (x_m < c.windshield_to_x_m) return MaterialId::acrylic_cabin_window;
    const double pane = (c.side_to_x_m - c.windshield_to_x_m) / c.side_panes;
    const double into = std::fmod(x_m - c.windshield_to_x_m, pane);
    return into > 0.11 ? MaterialId::acrylic_cabin_window : MaterialId::aircraft_white_topcoat;
  }
  for (const Door& door : type.doors) {
    if (on_seam(door, x_m, line, side)) return MaterialId::aircraft_grey;
    const auto [low, high] = seams(door);
    if (door.sill_m >= 0 && (door.side == 0 || door.side == side) && line >= low && line <= high &&
        std::abs(x_m - door.x_m) < door.width_m / 2 + 0.2)
      return MaterialId::aircraft_white_topcoat;
  }
  const CabinWindows& w = type.windows;
  const bool on_window = std::abs(std::remainder(x_m - w.from_x_m, w.pitch_m)) < w.width_m / 2;
  if (on_window && line == window_low && x_m > w.from_x_m - w.width_m && x_m < w.to_x_m + w.width_m)
    return MaterialId::acrylic_cabin_window;
  const UpperDeck& u = type.upper;
  if (on_window && line == upper_window_low && x_m > u.windows_from_x_m && x_m < u.windows_to_x_m)
    return MaterialId::acrylic_cabin_window;
  if (x_m > type.stations.back().x_m - 0.32) return MaterialId::exhaust_metal;
  return MaterialId::aircraft_white_topcoat;
}

/// The skin as rings of vertex indices; the vertices of a ring go up the left side and down the right one.
struct Skin {
  std::vector<double> xs;
  std::vector<Ring> rings;
  std::vector<std::vector<std::uint32_t>> index;
  std::size_t half = 0;  ///< vertices 0..half of a ring are on the left side, both ends on the plane of symmetry

  /// True for the quad between rings i, i + 1 and vertices j, j + 1 in a hole.
  std::size_t hole_i0 = 0, hole_i1 = 0, hole_j0 = 0, hole_j1 = 0;
  bool in_hole(std::size_t i, std::size_t j) const {
    return i >= hole_i0 && i < hole_i1 && j >= hole_j0 && j < hole_j1;
  }
};

Skin make_skin(MeshBuilder& b, const AircraftType& type) {
  Skin s;
  s.xs = ring_stations(type);
  for (const double x : s.xs) {
    const FuselageSection section = fuselage_section(type, x);
    const std::vector<double> side = side_angles(type, section, x);
    Ring ring;
    for (const double a : side) ring.emplace_back(-x, section.yz(a).x(), section.yz(a).y());
    ring.front().y() = ring.back().y() = 0;
    for (std::size_t k = side.size() - 2; k > 0; --k)
      ring.emplace_back(-x, -section.yz(side[k]).x(), section.yz(side[k]).y());
    std::vector<std::uint32_t> index;
    for (const Vector3d& p : ring) index.push_back(b.vertex(p));
    s.rings.push_back(std::move(ring));
    s.index.push_back(std::move(index));
  }
  s.half = s.rings.front().size() / 2;
  return s;
}

/// The rings and lines along the edges of a left door.
void cut_hole(Skin& s, const AircraftType& type, const Door& door) {
  const auto ring_at = [&](double x) {
    const auto nearest = std::min_element(s.xs.begin(), s.xs.end(),
                                          [x](double a, double b) { return std::abs(a - x) < std::abs(b - x); });
    return static_cast<std::size_t>(nearest - s.xs.begin());
  };
  s.hole_i0 = ring_at(door.x_m - door.width_m / 2);
  s.hole_i1 = ring_at(door.x_m + door.width_m / 2);
  const Quads& between = quads_between(type);
  const auto vertex_of = [&](std::size_t line) {
    return static_cast<std::size_t>(std::accumulate(between.begin(), between.begin() + static_cast<long>(line), 0));
  };
  const auto [low, high] = seams(door);
  s.hole_j0 = vertex_of(low);
  s.hole_j1 = vertex_of(high + 1);
}

/// Where the skin quads of the hole would have their boundary, in their winding.
std::vector<std::pair<std::size_t, std::size_t>> hole_boundary(const Skin& s) {
  std::vector<std::pair<std::size_t, std::size_t>> loop;
  for (std::size_t j = s.hole_j0; j < s.hole_j1; ++j) loop.emplace_back(s.hole_i0, j);
  for (std::size_t i = s.hole_i0; i < s.hole_i1; ++i) loop.emplace_back(i, s.hole_j1);
  for (std::size_t j = s.hole_j1; j > s.hole_j0; --j) loop.emplace_back(s.hole_i1, j);
  for (std::size_t i = s.hole_i1; i > s.hole_i0; --i) loop.emplace_back(i, s.hole_j0);
  return loop;
}

constexpr double entry_flare_m = 0.35, entry_flare_depth_m = 0.25;

/// Depth at which the door frame ends: inside the skin for all of the entry area behind it.
double frame_y_m(const AircraftType& type, const Door& door) {
  const double top = type.floor_z_m + door.sill_m + door.height_m, low = type.floor_z_m + door.sill_m;
  const double half = door.width_m / 2;
  double y = 1e9;
  for (const double z : {low, top}) {
    for (const double side : {-1.0, 1.0}) {
      y = std::min(y, fuselage_half_width_m(type, door.x_m + side * half, z) - 0.1);
      const double room = fuselage_half_width_m(type, door.x_m + side * (half + entry_flare_m), z);
      y = std::min(y, room - 0.1 + entry_flare_depth_m);
    }
  }
  return y;
}

/// Door frame, and behind it a dark entry area from the door across the cabin, joined to the skin's hole.
void line_hole(MeshBuilder& b, const AircraftType& type, const Door& door, const Skin& s) {
  const auto boundary = hole_boundary(s);
  const double frame = frame_y_m(type, door), room = frame - entry_flare_depth_m;
  std::vector<std::uint32_t> outer;
  std::array<std::vector<std::uint32_t>, 3> loops;  // frame, front and far wall of the entry
  for (const auto& [i, j] : boundary) {
    const Vector3d& p = s.rings[i][j];
    outer.push_back(s.index[i][j]);
    const double wide = -door.x_m + (p.x() + door.x_m) * (1 + entry_flare_m / (door.width_m / 2));
    loops[0].push_back(b.vertex({p.x(), frame, p.z()}));
    loops[1].push_back(b.vertex({wide, room, p.z()}));
    loops[2].push_back(b.vertex({wide, -room, p.z()}));
  }
  const auto floor = [&](std::size_t k) {
    return boundary[k].second == s.hole_j0 && boundary[(k + 1) % boundary.size()].second == s.hole_j0;
  };
  for (const auto& inner : loops) {
    for (std::size_t k = 0; k < outer.size(); ++k) {
      const std::size_t next = (k + 1) % outer.size();
      b.use(&inner == loops.data() ? MaterialId::aircraft_grey
            : floor(k)             ? MaterialId::bellows
                                   : MaterialId::gse_chassis);
      b.quad(outer[k], outer[next], inner[next], inner[k]);
    }
    outer = inner;
  }
  const std::uint32_t centre = b.vertex({-door.x_m, -room, type.floor_z_m + door.sill_m + door.height_m / 2});
  for (std::size_t k = 0; k < outer.size(); ++k) b.triangle(centre, outer[k], outer[(k + 1) % outer.size()]);
}

/// The open leaf: a shell that follows the skin ahead of the opening, held by two arms.
void add_door_leaf(MeshBuilder& b, const AircraftType& type, const Door& door) {
  constexpr double off_skin_m = 0.10, thickness_m = 0.08, ahead_m = 0.08;
  const double aft = door.x_m - door.width_m / 2 - ahead_m, forward = aft - door.width_m;
  const double z0 = type.floor_z_m + door.sill_m + 0.02, height = door.height_m - 0.04;
  std::vector<Ring> rings;
  constexpr int n = 16;
  for (int k = 0; k <= n; ++k) {
    const double z = z0 + height * k / n;
    const auto skin_y = [&](double x) { return fuselage_half_width_m(type, x, z) + off_skin_m; };
    rings.push_back({{-aft, skin_y(aft), z},
                     {-forward, skin_y(forward), z},
                     {-forward, skin_y(forward) + thickness_m, z},
                     {-aft, skin_y(aft) + thickness_m, z}});
  }
  add_loft(b, rings, [](std::size_t, std::size_t j) {
    return j == 2 ? MaterialId::aircraft_white_topcoat : MaterialId::aircraft_grey;
  });
  b.use(MaterialId::galvanised_steel);
  for (const double share : {0.45, 0.62}) {
    const double z = z0 + share * height, from = door.x_m - door.width_m / 2;
    add_beam(b, {-from, fuselage_half_width_m(type, from, z) - 0.03, z},
             {-aft + 0.25, fuselage_half_width_m(type, aft - 0.25, z) + off_skin_m + 0.02, z}, 0.05, 0.05);
  }
}

}  // namespace

void add_fuselage(MeshBuilder& b, const AircraftType& type, std::optional<std::size_t> open_left_door) {
  const std::size_t first = b.triangle_count();
  Skin s = make_skin(b, type);
  if (open_left_door) cut_hole(s, type, type.doors[*open_left_door]);
  const auto add_cap = [&](std::size_t ring, bool forward) {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& p : s.rings[ring]) sum += p;
    const std::uint32_t c = b.vertex(sum / static_cast<double>(s.rings[ring].size()));
    const auto& index = s.index[ring];
    for (std::size_t j = 0; j < index.size(); ++j) {
      const std::uint32_t p = index[j], q = index[(j + 1) % index.size()];
      forward ? b.triangle(c, p, q) : b.triangle(c, q, p);
    }
  };
  b.use(MaterialId::aircraft_white_topcoat);
  add_cap(0, false);
  for (std::size_t i = 0; i + 1 < s.rings.size(); ++i) {
    for (std::size_t j = 0; j < s.rings[i].size(); ++j) {
      if (s.in_hole(i, j)) continue;
      const std::size_t k = (j + 1) % s.rings[i].size();
      const bool left = j < s.half;
      b.use(skin(type, (s.xs[i] + s.xs[i + 1]) / 2, line_below(type, left ? j : 2 * s.half - 1 - j), left ? 1 : -1));
      b.quad(s.index[i][j], s.index[i][k], s.index[i + 1][k], s.index[i + 1][j]);
    }
  }
  if (open_left_door) line_hole(b, type, type.doors[*open_left_door], s);
  b.use(MaterialId::exhaust_metal);
  add_cap(s.rings.size() - 1, true);
  b.orient_outward(first);
  if (open_left_door) add_door_leaf(b, type, type.doors[*open_left_door]);
}

}  // namespace tarmac::scenes
