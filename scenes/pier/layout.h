/// Where things are at a pier. World: x east along the pier, y north, the pier's axis is y = 0 [m].
#pragma once

#include <vector>

#include "scenes/apron/stand_frame.h"
#include "scenes/pier/options.h"

namespace tarmac::scenes {

struct PierStand {
  char code;
  double centre_x_m, half_width_m;
  double side;       ///< -1 south of the pier (noses point north), 1 north of it
  StandFrame frame;  ///< origin at the nose
  int number;
};

/// Distances called `..._m` without a coordinate's name are from the façade outwards.
struct PierLayout {
  // How far things are from the façade: as on the scene `stand`.
  static constexpr double nose_m = 16.5, rotunda_m = 15.5, head_road_m = 6.25, lane_width_m = 4.5;
  static constexpr double boarding_floor_m = 5.0;

  double west_m = 0, east_m = 0;                       ///< ends of the pier
  double half_width_m = 15;                            ///< façades at y = +- this
  double stand_length_m = 40;                          ///< of the longest code
  double tail_road_m = 0, taxilane_m = 0, edge_m = 0;  ///< centre lines; end of the pavement
  double cross_road_x_m = 0;                           ///< along the hall
  double end_road_x_m = 0;                             ///< around the pier's head
  std::vector<PierStand> stands;

  /// World y of what is `distance_m` from the façade on a side.
  double y(double side, double distance_m) const { return side * (half_width_m + distance_m); }
  /// Rotunda's x in a stand's frame.
  static double rotunda_x_m(char code) { return code == 'E' ? -24 : -17.5; }
};

/// Throws core::InputError for a pattern of codes that it cannot read or a pier too short for its stands.
PierLayout pier_layout(const PierOptions& options);

/// Centre lines of all lanes that are kept free, as polylines: head-of-stand and tail-of-stand roads, the roads that
/// join them at either end, and the strips between neighbouring stands.
std::vector<std::vector<Eigen::Vector2d>> pier_lanes(const PierOptions& options);

}  // namespace tarmac::scenes
