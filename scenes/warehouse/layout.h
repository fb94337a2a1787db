/// Where things stand in the warehouse. Aisles run along x; the docks are in the east.
#pragma once

#include "scenes/warehouse/options.h"

namespace tarmac::scenes::warehouse_layout {

inline constexpr double bay_m = 2.8, rack_depth_m = 1.1, flue_m = 0.36;  ///< flue: between racks back to back
inline constexpr double west_zone_m = 9, dock_zone_m = 16, side_m = 2.4;
inline constexpr double roof_over_top_m = 2.2;

inline double rack_length_m(const WarehouseOptions& o) {
  return o.bays * bay_m;
}
/// Racks span -rack_length/2 .. rack_length/2.
inline double west_m(const WarehouseOptions& o) {
  return -rack_length_m(o) / 2 - west_zone_m;
}
inline double east_m(const WarehouseOptions& o) {
  return rack_length_m(o) / 2 + dock_zone_m;
}
/// From aisle to aisle.
inline double pitch_m(const WarehouseOptions& o) {
  return o.aisle_width_m + 2 * rack_depth_m + flue_m;
}
inline double aisle_y_m(const WarehouseOptions& o, int aisle) {
  return (aisle - 0.5 * (o.aisles - 1)) * pitch_m(o);
}
inline double half_width_m(const WarehouseOptions& o) {
  return 0.5 * o.aisles * pitch_m(o) + rack_depth_m + side_m;
}
inline double roof_m(const WarehouseOptions& o) {
  return o.levels * o.level_height_m + roof_over_top_m;
}

}  // namespace tarmac::scenes::warehouse_layout
