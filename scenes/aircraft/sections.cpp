#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/aircraft/parts.h"

namespace tarmac::scenes {

namespace {

constexpr double pi = std::numbers::pi;

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

}  // namespace

double FuselageSection::angle(double z_m) const {
  const double half = z_m >= z_wide_m ? top_m - z_wide_m : z_wide_m - bottom_m;
  return std::asin(std::clamp((z_m - z_wide_m) / half, -1.0, 1.0));
}

Eigen::Vector2d FuselageSection::yz(double angle_rad) const {
  const double half = angle_rad >= 0 ? top_m - z_wide_m : z_wide_m - bottom_m;
  return {half_width_m * std::cos(angle_rad), z_wide_m + half * std::sin(angle_rad)};
}

double FuselageSection::underside_m(double y_m) const {
  const double share = std::clamp(y_m / half_width_m, -1.0, 1.0);
  return z_wide_m - (z_wide_m - bottom_m) * std::sqrt(1 - share * share);
}

FuselageSection fuselage_section(const AircraftType& type, double x_m) {
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
  const double x = std::clamp(x_m, xs.front(), xs.back());
  FuselageSection section{monotone_cubic(xs, top, x), monotone_cubic(xs, bottom, x), monotone_cubic(xs, width, x),
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

double fuselage_half_width_m(const AircraftType& type, double x_m, double z_m) {
  if (x_m < 0 || x_m > type.stations.back().x_m) return 0;
  const FuselageSection section = fuselage_section(type, x_m);
  if (z_m >= section.top_m || z_m <= section.bottom_m) return 0;
  return section.yz(section.angle(z_m)).x();
}

// Nose laws over s = x / nose length, calibrated on the measured A320 sections (crown within 6 %, belly within 6 % and
// half width within 1.5 % of the full size): half width (1 - (1-s)^2)^0.6, belly (1 - (1-s)^2)^0.41, crown
// (1 - (1-s)^2.4)^forehead, each growing from the nose tip's height to the constant part's. Tail laws over t, from the
// end of the constant part to the last station: belly t^upsweep (1.2 on the A320), half width t^1.6, crown t^4.
std::vector<FuselageStation> fuselage_stations(const FuselageShape& shape) {
  const double top = shape.top_m, bottom = shape.top_m - shape.height_m, half = shape.width_m / 2;
  const double z_nose = bottom + shape.nose_tip * shape.height_m, z_tail = bottom + shape.tail_tip * shape.height_m;
  std::vector<FuselageStation> stations;
  for (const double s : {0.017, 0.05, 0.1, 0.167, 0.25, 0.333, 0.43, 0.54, 0.667, 0.83, 1.0}) {
    const double round = 1 - (1 - s) * (1 - s);
    stations.push_back({s * shape.nose_length_m,
                        z_nose + (top - z_nose) * std::pow(1 - std::pow(1 - s, 2.4), shape.forehead),
                        z_nose + (bottom - z_nose) * std::pow(round, 0.41), half * std::pow(round, 0.6)});
  }
  for (const double t : {0.0, 0.08, 0.16, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.93, 1.0}) {
    stations.push_back({shape.length_m - (1 - t) * shape.tail_length_m,
                        top + (z_tail + shape.tail_tip_half_height_m - top) * std::pow(t, 4),
                        bottom + (z_tail - shape.tail_tip_half_height_m - bottom) * std::pow(t, shape.upsweep),
                        half + (shape.tail_tip_half_width_m - half) * std::pow(t, 1.6)});
  }
  return stations;
}

double station_of_crown_m(const std::vector<FuselageStation>& stations, double top_m) {
  std::vector<double> xs, tops;
  for (const FuselageStation& s : stations) {
    xs.push_back(s.x_m);
    tops.push_back(s.top_m);
  }
  double low = xs.front(),
         high = *std::max_element(xs.begin(), xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2));
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (monotone_cubic(xs, tops, middle) < top_m ? low : high) = middle;
  }
  return low;
}

CockpitWindows derived_cockpit(const std::vector<FuselageStation>& stations, const CockpitShape& shape) {
  // The windshield begins where the crown is a hand above its lower edge and ends where it has cleared the upper one,
  // as on the measured type.
  const double from = station_of_crown_m(stations, shape.low_m + 0.35);
  const double to = std::max(from + 0.5, station_of_crown_m(stations, shape.high_m + 0.25));
  return {.windshield_from_x_m = from,
          .windshield_to_x_m = to,
          .side_to_x_m = to + shape.panes_length_m,
          .side_panes = shape.side_panes,
          .low_front_m = shape.low_m,
          .low_aft_m = shape.low_m + 0.18,
          .high_front_m = shape.high_m,
          .high_aft_m = shape.high_m - 0.15};
}

double surface_chord_m(const SurfacePlan& p, double y_m) {
  const bool inboard = y_m <= p.kink_y_m;
  const double y0 = inboard ? p.root_y_m : p.kink_y_m, y1 = inboard ? p.kink_y_m : p.tip_y_m;
  const double c0 = inboard ? p.root_chord_m : p.kink_chord_m, c1 = inboard ? p.kink_chord_m : p.tip_chord_m;
  return c0 + (c1 - c0) * (y_m - y0) / (y1 - y0);
}

double surface_le_x_m(const SurfacePlan& p, double y_m) {
  return p.root_le_x_m + (y_m - p.root_y_m) * std::tan(p.le_sweep_deg * pi / 180);
}

double surface_le_z_m(const SurfacePlan& p, double y_m) {
  return p.root_z_m + (y_m - p.root_y_m) * std::tan(p.dihedral_deg * pi / 180);
}

}  // namespace tarmac::scenes
