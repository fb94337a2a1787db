/// What a motion carries, as a box: what others must not run into.
#pragma once

namespace tarmac::sim::truth {

/// In the body frame (x forward, y left, z up). The defaults are a van, its origin on the ground under the rear axle.
struct BodyBox {
  double length_m = 5, width_m = 2;
  double rear_overhang_m = 1;  ///< from the origin to the rear end
  double height_m = 2.2;       ///< of its top above the origin
  double below_m = 0;          ///< from the origin down to its underside
  bool upright = false;        ///< it keeps to the world's axes and only moves along with the origin: a person
};

}  // namespace tarmac::sim::truth
