#include "scenes/hangar/layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "scenes/aircraft/aircraft.h"

namespace tarmac::scenes {

using core::InputError;

namespace {

constexpr double lane_half_m = 2, beside_m = 0.4;  ///< free half width of the lane; and from there to anything
constexpr double tail_in_m = 4.5, before_nose_m = 1.8;
constexpr double fin_gap_m = 0.5;

}  // namespace

HangarLayout hangar_layout(const HangarOptions& options) {
  HangarLayout l;
  const HangarSpec spec = options.spec();
  l.clear_half_width_m = hangar_clear_width_m(spec) / 2;
  l.clear_depth_m = hangar_clear_depth_m(spec);
  if (options.door_width_m > options.width_m - 2)
    throw InputError(fmt::format("door_width_m: {} m does not fit into a front of {} m: leave a metre at either side",
                                 options.door_width_m, options.width_m));
  if (options.door_height_m > options.eaves_m - 1)
    throw InputError(fmt::format("door_height_m: {} m leaves less than a metre below eaves of {} m",
                                 options.door_height_m, options.eaves_m));
  const double outermost = std::min(options.door_width_m / 2, l.clear_half_width_m - HangarLayout::cabinet_depth_m);
  l.lane_x_m = outermost - lane_half_m - beside_m;
  l.lane_back_y_m = l.clear_depth_m - HangarLayout::cabinet_depth_m - lane_half_m - beside_m;
  if (options.aircraft == "none") return l;
  const AircraftType& type = aircraft_type(options.aircraft);
  const double span_needed = type.span_m / 2 + lane_half_m, depth_needed = tail_in_m + type.length_m + before_nose_m;
  if (l.lane_x_m < span_needed)
    throw InputError(
        fmt::format("aircraft: a lane beside the wing tips of {} lies at {:.1f} m from the middle, and the "
                    "hangar leaves {:.1f} m: make width_m and door_width_m {:.0f} m larger",
                    type.name, span_needed, l.lane_x_m, 2 * (span_needed - l.lane_x_m) + 1));
  if (l.lane_back_y_m - lane_half_m < depth_needed)
    throw InputError(
        fmt::format("aircraft: {} needs {:.1f} m before the lane at the back, and there are {:.1f} m: make "
                    "depth_m larger",
                    type.name, depth_needed, l.lane_back_y_m - lane_half_m));
  if (type.height_max_m + fin_gap_m > options.door_height_m)
    throw InputError(
        fmt::format("aircraft: the fin of {} is {:.1f} m high and door_height_m is {:.1f} m: make the door "
                    "higher",
                    type.name, type.height_max_m, options.door_height_m));
  l.nose_y_m = l.lane_back_y_m - lane_half_m - before_nose_m;
  return l;
}

std::vector<Eigen::Vector2d> hangar_lane(const HangarOptions& options) {
  const HangarLayout l = hangar_layout(options);
  constexpr double before_door_m = 60;
  return {{l.lane_x_m, -before_door_m},
          {l.lane_x_m, l.lane_back_y_m},
          {-l.lane_x_m, l.lane_back_y_m},
          {-l.lane_x_m, -before_door_m}};
}

}  // namespace tarmac::scenes
