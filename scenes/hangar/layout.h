/// Where things are in and before the hangar. World: x east, y north; the door is the plane y = 0 and opens to the
/// south, x = 0 its middle [m].
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/hangar/options.h"

namespace tarmac::scenes {

struct HangarLayout {
  static constexpr double apron_south_m = -97.5, apron_half_m = 97.5;
  double nose_y_m = 0;                               ///< the aircraft's nose
  double clear_half_width_m = 0, clear_depth_m = 0;  ///< between columns; before the posts at the back
  double lane_x_m = 0;                               ///< the drive in and out: x = +-this
  double lane_back_y_m = 0;                          ///< and across in front of the nose
  static constexpr double cabinet_depth_m = 1.1;     ///< along the walls, taken from the clear width
};

/// Throws core::InputError where door, aircraft and lane do not fit into the hangar: which, by how much, what to
/// change.
HangarLayout hangar_layout(const HangarOptions& options);
/// Centre line of the lane that is kept free: in on the eastern side, around the nose, out on the western side.
std::vector<Eigen::Vector2d> hangar_lane(const HangarOptions& options);

}  // namespace tarmac::scenes
