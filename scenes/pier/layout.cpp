#include "scenes/pier/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double bay_m = 7.5;
constexpr double west_gap_m = 24;  ///< between hall and first stand: the road that joins head and tail
constexpr double longest_c_m = 39.5, longest_e_m = 73.9;
constexpr double behind_tail_m = 9.5;  ///< from the tail to the middle of the road behind it
// From a taxilane's centre line to an object, and from a taxiway's, by code (aerodrome design rules).
constexpr double taxilane_clear_c_m = 22.5, taxilane_clear_e_m = 40, edge_c_m = 26, edge_e_m = 43.5;

void check(const PierOptions& options) {
  if (options.codes.empty() || options.codes.find_first_not_of("CE") != std::string::npos)
    throw core::InputError(fmt::format("codes: '{}' should be letters C and E, such as CCE", options.codes));
}

}  // namespace

PierLayout pier_layout(const PierOptions& options) {
  check(options);
  const auto code_of = [&](int k) { return options.codes[static_cast<std::size_t>(k) % options.codes.size()]; };
  PierLayout layout;
  layout.half_width_m = options.pier_width_m / 2;
  double needed = west_gap_m;
  bool wide = false;
  for (int k = 0; k < options.stands_per_side; ++k) {
    wide |= code_of(k) == 'E';
    needed += code_of(k) == 'E' ? options.pitch_e_m : options.pitch_c_m;
  }
  if (options.pier_length_m > 0 && options.pier_length_m < needed)
    throw core::InputError(fmt::format(
        "pier_length_m: {:.1f} is too short: its {} stands and the road before them need {:.1f} m; make the "
        "pier longer, or give it fewer stands",
        options.pier_length_m, options.stands_per_side, needed));
  const double length = bay_m * std::ceil(std::max(options.pier_length_m, needed) / bay_m - 1e-9);
  layout.west_m = -length / 2;
  layout.east_m = length / 2;
  layout.stand_length_m = wide ? longest_e_m : longest_c_m;
  layout.tail_road_m = PierLayout::nose_m + layout.stand_length_m + behind_tail_m;
  layout.taxilane_m = layout.tail_road_m + PierLayout::lane_width_m + (wide ? taxilane_clear_e_m : taxilane_clear_c_m);
  layout.edge_m = layout.taxilane_m + (wide ? edge_e_m : edge_c_m);
  layout.cross_road_x_m = layout.west_m + west_gap_m / 2 + 2;
  layout.end_road_x_m = layout.east_m + 10;
  for (const double side : {-1.0, 1.0}) {
    if (side > 0 && !options.both_sides) continue;
    double x = layout.west_m + west_gap_m;
    for (int k = 0; k < options.stands_per_side; ++k) {
      const double half = (code_of(k) == 'E' ? options.pitch_e_m : options.pitch_c_m) / 2;
      x += half;
      layout.stands.push_back({code_of(k), x, half, side, StandFrame{{x, layout.y(side, PierLayout::nose_m)}, -side},
                               (side < 0 ? 10 : 30) + k + 1});
      x += half;
    }
  }
  return layout;
}

std::vector<std::vector<Vector2d>> pier_lanes(const PierOptions& options) {
  const PierLayout l = pier_layout(options);
  const double lane = PierLayout::lane_width_m / 2;
  std::vector<std::vector<Vector2d>> lanes;
  for (const double side : {-1.0, 1.0}) {
    for (const double road : {PierLayout::head_road_m, l.tail_road_m}) {
      for (const double d : {-lane, lane})
        lanes.push_back({{l.cross_road_x_m, l.y(side, road + d)}, {l.end_road_x_m, l.y(side, road + d)}});
    }
  }
  for (const double x : {l.cross_road_x_m, l.end_road_x_m}) {
    for (const double d : {-lane, lane}) {
      for (const double side : {-1.0, 1.0})
        lanes.push_back({{x + d, l.y(side, PierLayout::head_road_m)}, {x + d, l.y(side, l.tail_road_m)}});
    }
  }
  lanes.push_back(
      {{l.end_road_x_m, l.y(-1, PierLayout::head_road_m)}, {l.end_road_x_m, l.y(1, PierLayout::head_road_m)}});
  for (const PierStand& stand : l.stands) {
    const double x = stand.centre_x_m + stand.half_width_m;
    lanes.push_back({{x, l.y(stand.side, PierLayout::head_road_m)}, {x, l.y(stand.side, l.tail_road_m)}});
  }
  return lanes;
}

}  // namespace tarmac::scenes
