#include "scenes/remote_stand/layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr std::size_t most_stands = 10;
constexpr double behind_tail_m = 9.5, beside_row_m = 12;

/// Largest span of the code, the clearance it asks for, and a metre or two.
double stand_width_m(char code) {
  return code == 'F' ? 89 : code == 'E' ? 74 : code == 'D' ? 61 : 42;
}

}  // namespace

RemoteLayout remote_layout(const RemoteStandOptions& options) {
  if (options.types.empty() || options.types.size() > most_stands)
    throw core::InputError(fmt::format("types: {} aircraft; give one to {}", options.types.size(), most_stands));
  RemoteLayout l;
  double width = 0, longest = 0;
  for (const std::string& name : options.types) {
    const AircraftType& type = aircraft_type(name);
    width += stand_width_m(type.icao_code);
    longest = std::max(longest, type.length_m);
    l.wide |= type.icao_code > 'D';
  }
  l.west_m = -width / 2;
  l.east_m = width / 2;
  double x = l.west_m;
  for (const std::string& name : options.types) {
    const AircraftType& type = aircraft_type(name);
    const double half = stand_width_m(type.icao_code) / 2;
    l.stands.push_back({&type, half, StandFrame{{x + half, 0}, 1}});
    x += 2 * half;
  }
  l.stand_length_m = longest;
  l.tail_road_y_m = -(longest + behind_tail_m);
  l.taxilane_y_m = l.tail_road_y_m - RemoteLayout::lane_width_m - (l.wide ? 47.5 : 22.5);
  l.cross_road_west_x_m = l.west_m - beside_row_m;
  l.cross_road_east_x_m = l.east_m + beside_row_m;
  return l;
}

std::vector<std::vector<Vector2d>> remote_lanes(const RemoteStandOptions& options) {
  const RemoteLayout l = remote_layout(options);
  std::vector<std::vector<Vector2d>> lanes;
  const double lane = RemoteLayout::lane_width_m / 2, west = l.cross_road_west_x_m, east = l.cross_road_east_x_m;
  for (const double d : {-lane, lane}) {
    for (const double y : {RemoteLayout::head_road_y_m, l.tail_road_y_m})
      lanes.push_back({{west, y + d}, {east, y + d}});
    for (const double x : {west, east})
      lanes.push_back({{x + d, l.tail_road_y_m}, {x + d, RemoteLayout::head_road_y_m}});
  }
  for (const RemoteStand& stand : l.stands) {
    const double x = stand.frame.nose_m.x() + stand.half_width_m;
    if (x < l.east_m - 1) lanes.push_back({{x, l.tail_road_y_m}, {x, RemoteLayout::head_road_y_m}});
  }
  return lanes;
}

}  // namespace tarmac::scenes
