#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

namespace {

constexpr double pi = std::numbers::pi;

/// A section in heights above ground. Upper and lower half are half ellipses that meet at the widest line z_wide: both
/// stand upright there, so the skin is smooth.
struct Section {
  double top_m, bottom_m, half_width_m, z_wide_m;

  /// Angle of height z: -pi/2 at the bottom, 0 at the widest line, pi/2 at the top.
  double angle(double z_m) const {
    const double half = z_m >= z_wide_m ? top_m - z_wide_m : z_wide_m - bottom_m;
    return std::asin(std::clamp((z_m - z_wide_m) / half, -1.0, 1.0));
  }
  Eigen::Vector2d yz(double angle_rad) const {
    const double half = angle_rad >= 0 ? top_m - z_wide_m : z_wide_m - bottom_m;
    return {half_width_m * std::cos(angle_rad), z_wide_m + half * std::sin(angle_rad)};
  }
};

/// Monotone cubic through the stations (Fritsch and Carlson 1980): no bulge between two equal stations.
double monotone_cubic(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const std::size_t n = xs.size();
  const std::size_t k = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(xs.begin(), xs.end(), x) - xs.begin() - 1, 0, std::ptrdiff_t(n) - 2));
  const auto secant = [&](std::size_t i) { return (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i]); };
  const auto slope = [&](std::size_t i) {
    if (i == 0) return secant(0);
    if (i == n - 1) return secant(n - 2);
    const double a = secant(i - 1), b = secant(i);
    if (a * b <= 0) return 0.0;
    const double h0 = xs[i] - xs[i - 1], h1 = xs[i + 1] - xs[i];
    return 3 * (h0 + h1) / ((2 * h1 + h0) / a + (h1 + 2 * h0) / b);
  };
  const double h = xs[k + 1] - xs[k], s = (x - xs[k]) / h, r = 1 - s;
  return ys[k] * (1 + 2 * s) * r * r + ys[k + 1] * (1 + 2 * r) * s * s + h * s * r * (slope(k) * r - slope(k + 1) * s);
}

Section section_at(const AircraftType& type, double x_m) {
  std::vector<double> xs, top, bottom, width, wide;
  // The widest line of the cabin's constant part; nose and tail keep it as far as it lies inside them.
  const auto& widest = *std::max_element(type.stations.begin(), type.stations.end(),
                                         [](const auto& a, const auto& b) { return a.half_width_m < b.half_width_m; });
  const double z_cabin = (widest.top_m + widest.bottom_m) / 2;
  for (const FuselageStation& s : type.stations) {
    const double margin = 0.38 * (s.top_m - s.bottom_m);
    xs.push_back(s.x_m);
    top.push_back(s.top_m);
    bottom.push_back(s.bottom_m);
    width.push_back(s.half_width_m);
    wide.push_back(std::clamp(z_cabin, s.bottom_m + margin, s.top_m - margin));
  }
  const double x = std::max(x_m, xs.front());
  Section section{monotone_cubic(xs, top, x), monotone_cubic(xs, bottom, x), monotone_cubic(xs, width, x),
                  monotone_cubic(xs, wide, x)};
  if (x_m < xs.front()) {  // the tip in front of the first station: an ellipsoid's cap
    const double share = 1 - x_m / xs.front(), f = std::sqrt(std::max(0.0, 1 - share * share));
    section = {section.z_wide_m + f * (section.top_m - section.z_wide_m),
               section.z_wide_m + f * (section.bottom_m - section.z_wide_m), f * section.half_width_m,
               section.z_wide_m};
  }
  section.top_m += type.floor_z_m;
  section.bottom_m += type.floor_z_m;
  section.z_wide_m += type.floor_z_m;
  return section;
}

double interpolate(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
}

/// Heights above ground that lines of the skin follow from bottom to top, so that panes and doors have clean edges.
enum Line {
  bottom,
  hold_low,
  hold_high,
  sill,
  sill_seam,
  window_low,
  window_high,
  door_seam,
  door_high,
  post,
  crown,
  lines
};
constexpr std::array<int, lines - 1> quads_between{7, 5, 2, 1, 4, 2, 3, 1, 4, 1};

/// Ahead of the windshield and behind the last door nothing needs the lines: there they spread out evenly.
void spread_at_the_ends(const AircraftType& type, double x_m, std::array<double, lines>& angles) {
  double last_door = 0;
  for (const Door& door : type.doors) last_door = std::max(last_door, door.x_m + door.width_m);
  const double nose = 1 - std::clamp((x_m - 0.3) / (type.cockpit.windshield_from_x_m - 0.35), 0.0, 1.0);
  const double tail = std::clamp((x_m - last_door) / 3, 0.0, 1.0), share = std::max(nose, tail);
  const double total = std::accumulate(quads_between.begin(), quads_between.end(), 0);
  int quads = 0;
  for (std::size_t k = 1; k + 1 < lines; ++k) {
    quads += quads_between[k - 1];
    angles[k] += share * (pi * (quads / total - 0.5) - angles[k]);
  }
}

std::array<double, lines> line_angles(const AircraftType& type, const Section& section, double x_m) {
  const CockpitWindows& c = type.cockpit;
  const Door& door = type.doors.front();
  const double cabin_x = c.side_to_x_m + 0.6, seam_m = 0.05;
  double low = interpolate(x_m, c.windshield_from_x_m, c.low_front_m, c.side_to_x_m, c.low_aft_m);
  low = interpolate(x_m, c.side_to_x_m, low, cabin_x, type.windows.low_m);
  double high = interpolate(x_m, c.windshield_to_x_m, c.high_front_m, c.side_to_x_m, c.high_aft_m);
  high = interpolate(x_m, c.side_to_x_m, high, cabin_x, type.windows.high_m);
  const double hold_sill = type.doors.back().sill_m, hold_top = hold_sill + type.doors.back().height_m;
  std::array<double, lines> z{-1e3,          hold_sill, hold_top, 0, seam_m, low, high, door.height_m - seam_m,
                              door.height_m, 1e3,       1e3};
  std::array<double, lines> angles{};
  for (std::size_t k = 0; k < lines; ++k) angles[k] = section.angle(type.floor_z_m + z[k]);
  // The windshield reaches up to the centre post, a few centimetres off the crown.
  angles[post] = std::acos(std::min(0.9, 0.04 / std::max(section.half_width_m, 0.05)));
  const double on_windshield = 1 - std::clamp((x_m - c.windshield_to_x_m) / 0.12, 0.0, 1.0);
  angles[window_high] += on_windshield * (angles[post] - 0.06 - angles[window_high]);
  // Where the section is too small for a line, the lines share what angle there is.
  constexpr double least = 0.012;
  for (std::size_t k = 1; k < lines; ++k) angles[k] = std::max(angles[k], angles[k - 1] + least * quads_between[k - 1]);
  for (std::size_t k = lines - 1; k-- > 0;) {
    const double ceiling = k + 2 == lines ? pi / 2 : angles[k + 1];
    angles[k] = std::min(angles[k], ceiling - least * quads_between[k]);
  }
  angles[crown] = pi / 2;
  angles[bottom] = -pi / 2;
  spread_at_the_ends(type, x_m, angles);
  return angles;
}

/// Stations of all rings: every edge of a door or window, filled up so that no two are further apart than 0.3 m.
std::vector<double> ring_stations(const AircraftType& type) {
  std::vector<double> xs{0.0015, 0.012, 0.04, type.stations.front().x_m, type.length_m - 0.01};
  const auto edges = [&xs](double centre, double width) {
    for (const double d : {-width / 2, -width / 2 + 0.05, width / 2 - 0.05, width / 2}) xs.push_back(centre + d);
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
  std::vector<double> kept{xs.front()};
  for (std::size_t k = 1; k < xs.size(); ++k) {
    const double gap = xs[k] - kept.back();
    if (xs[k] > 0.1 && gap < 0.012) continue;  // two features meet: one ring serves both
    const double widest = xs[k] < 4 ? 0.15 : 0.3;
    const int n = static_cast<int>(std::ceil(gap / widest));
    const double from = kept.back();
    for (int i = 1; i <= n; ++i) kept.push_back(from + gap * i / n);
  }
  return kept;
}

/// Angles of the vertices from bottom to crown on one side.
std::vector<double> side_angles(const AircraftType& type, const Section& section, double x_m) {
  const std::array<double, lines> at = line_angles(type, section, x_m);
  std::vector<double> angles;
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    for (int q = 0; q < quads_between[k]; ++q) angles.push_back(at[k] + (at[k + 1] - at[k]) * q / quads_between[k]);
  }
  angles.push_back(pi / 2);
  return angles;
}

/// The line at or below quad j of one side.
Line line_below(std::size_t j) {
  int sum = 0;
  for (std::size_t k = 0; k + 1 < lines; ++k) {
    sum += quads_between[k];
    if (static_cast<int>(j) < sum) return static_cast<Line>(k);
  }
  return post;
}

bool on_seam(const Door& door, double x_m, Line line, int side) {
  if (door.side != 0 && door.side != side) return false;
  const double off = std::abs(x_m - door.x_m), half = door.width_m / 2;
  if (off > half) return false;
  const bool upright = off > half - 0.05;
  if (door.sill_m < 0) return line == hold_low && upright;
  return line == sill || line == door_seam || (upright && line >= sill && line <= door_seam);
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
    if (door.side == 0 && std::abs(x_m - door.x_m) < door.width_m / 2 + 0.2) return MaterialId::aircraft_white_topcoat;
  }
  const CabinWindows& w = type.windows;
  if (line == window_low && x_m > w.from_x_m - w.width_m && x_m < w.to_x_m + w.width_m) {
    const double off = std::abs(std::remainder(x_m - w.from_x_m, w.pitch_m));
    if (off < w.width_m / 2) return MaterialId::acrylic_cabin_window;
  }
  if (x_m > type.length_m - 0.32) return MaterialId::exhaust_metal;
  return MaterialId::aircraft_white_topcoat;
}

}  // namespace

double fuselage_half_width_m(const AircraftType& type, double x_m, double z_m) {
  const Section section = section_at(type, x_m);
  if (z_m >= section.top_m || z_m <= section.bottom_m) return 0;
  return section.yz(section.angle(z_m)).x();
}

void add_fuselage(MeshBuilder& b, const AircraftType& type) {
  const std::vector<double> xs = ring_stations(type);
  std::vector<Ring> rings;
  for (const double x : xs) {
    const Section section = section_at(type, x);
    const std::vector<double> side = side_angles(type, section, x);
    Ring ring;  // up the left side and down the right one
    for (const double a : side) ring.emplace_back(-x, section.yz(a).x(), section.yz(a).y());
    ring.front().y() = ring.back().y() = 0;
    for (std::size_t k = side.size() - 2; k > 0; --k)
      ring.emplace_back(-x, -section.yz(side[k]).x(), section.yz(side[k]).y());
    rings.push_back(std::move(ring));
  }
  const std::size_t half = rings.front().size() / 2;
  add_loft(b, rings, [&](std::size_t i, std::size_t j) {
    const bool left = j < half;
    return skin(type, (xs[i] + xs[i + 1]) / 2, line_below(left ? j : 2 * half - 1 - j), left ? 1 : -1);
  });
}

}  // namespace tarmac::scenes
