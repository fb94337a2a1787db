/// Where things are in the cargo yard. World: x east, y north; the shed's docks face south [m].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/buildings/cargo_shed.h"
#include "scenes/cargo_yard/options.h"

namespace tarmac::scenes {

struct CargoLayout {
  static constexpr double dock_y_m = 62;                    ///< the docks' plane
  static constexpr double north_road_y_m = 49;              ///< along the airside docks, east of the fence
  static constexpr double south_road_y_m = 8;               ///< between racks and freighter
  static constexpr double fence_x_m = -12, fence_y_m = 22;  ///< trucks west of it, north of that
  static constexpr double aisle_x_m = -3;                   ///< road that joins the two along the fence
  static constexpr double racks_south_m = 15, racks_north_m = 42;
  static constexpr double nose_y_m = -6;  ///< of the freighter, which points north
  static constexpr double lane_half_m = 2;
  double east_aisle_x_m = 0;  ///< the road at the racks' eastern end
  double rack_from_x_m = 0, rack_to_x_m = 0;
  double south_edge_m = 0;
  CargoShedSpec shed;
};

/// Throws core::InputError for an aircraft that there is not.
CargoLayout cargo_layout(const CargoYardOptions& options);
/// The loop that is kept free, closed: north road, eastern aisle, south road, aisle along the fence.
std::vector<Eigen::Vector2d> cargo_lane(const CargoYardOptions& options);

}  // namespace tarmac::scenes
