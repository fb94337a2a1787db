#include "scenes/cargo_yard/layout.h"

#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

CargoLayout cargo_layout(const CargoYardOptions& options) {
  constexpr double beside_lane_m = 2.2, behind_tail_m = 30, without_freighter_m = -60;
  CargoLayout l;
  l.shed = {.length_m = options.shed_length_m, .depth_m = 40, .height_m = options.shed_height_m, .with_bumpers = true};
  l.east_aisle_x_m = options.shed_length_m / 2 - 4;
  l.rack_from_x_m = CargoLayout::aisle_x_m + CargoLayout::lane_half_m + beside_lane_m;
  l.rack_to_x_m = l.east_aisle_x_m - CargoLayout::lane_half_m - beside_lane_m;
  l.south_edge_m = options.freighter == "none"
                       ? without_freighter_m
                       : CargoLayout::nose_y_m - aircraft_type(options.freighter).length_m - behind_tail_m;
  return l;
}

std::vector<Eigen::Vector2d> cargo_lane(const CargoYardOptions& options) {
  const CargoLayout l = cargo_layout(options);
  const double west = CargoLayout::aisle_x_m, east = l.east_aisle_x_m, south = CargoLayout::south_road_y_m,
               north = CargoLayout::north_road_y_m;
  return {{west, south}, {east, south}, {east, north}, {west, north}, {west, south}};
}

}  // namespace tarmac::scenes
