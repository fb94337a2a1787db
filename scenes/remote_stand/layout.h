/// Where things are on remote stands. World: x east along the row, y north; noses point north and lie on y = 0 [m].
#pragma once

#include <vector>

#include "scenes/aircraft/aircraft.h"
#include "scenes/apron/stand_frame.h"
#include "scenes/remote_stand/options.h"

namespace tarmac::scenes {

struct RemoteStand {
  const AircraftType* type;
  double half_width_m;
  StandFrame frame;
};

struct RemoteLayout {
  static constexpr double lane_width_m = 4.5, head_road_y_m = 18;
  std::vector<RemoteStand> stands;
  double west_m = 0, east_m = 0;                            ///< ends of the row
  double stand_length_m = 40;                               ///< of the longest type
  double tail_road_y_m = 0, taxilane_y_m = 0;               ///< centre lines
  double cross_road_west_x_m = 0, cross_road_east_x_m = 0;  ///< roads that join head and tail
  bool wide = false;                                        ///< a type of code E or F is among them
};

/// Throws core::InputError for a type that there is not, no type at all or more than ten.
RemoteLayout remote_layout(const RemoteStandOptions& options);
/// Centre lines of all lanes that are kept free.
std::vector<std::vector<Eigen::Vector2d>> remote_lanes(const RemoteStandOptions& options);

}  // namespace tarmac::scenes
