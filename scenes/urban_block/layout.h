/// Where things lie: nine blocks, the one in the middle whole, and the streets between them. World: x east, y north.
#pragma once

#include <Eigen/Core>

#include "scenes/urban_block/options.h"

namespace tarmac::scenes::urban_layout {

inline constexpr double parking_m = 2.1;  ///< a lane of parked cars on either side of the carriageway

/// From house to house across a street.
inline double street_m(const UrbanBlockOptions& o) {
  return o.carriageway_m + 2 * (parking_m + o.sidewalk_m);
}
/// Half the size of the block in the middle.
inline Eigen::Vector2d half_block(const UrbanBlockOptions& o) {
  return {o.block_x_m / 2, o.block_y_m / 2};
}
/// Centre lines of the four streets lie at x = +-this.x() and y = +-this.y().
inline Eigen::Vector2d street_centre(const UrbanBlockOptions& o) {
  return half_block(o) + Eigen::Vector2d::Constant(street_m(o) / 2);
}
/// How far the world reaches.
inline Eigen::Vector2d half_world(const UrbanBlockOptions& o) {
  return half_block(o) + Eigen::Vector2d::Constant(street_m(o) + o.outlook_m);
}

/// The ground that houses stand on: block (i, j), i and j in -1, 0, 1.
struct Block {
  Eigen::Vector2d low_m, high_m;
};
inline Block block(const UrbanBlockOptions& o, int i, int j) {
  const auto span = [&](int k, double half, double world) -> Eigen::Vector2d {
    if (k == 0) return {-half, half};
    return k > 0 ? Eigen::Vector2d(half + street_m(o), world) : Eigen::Vector2d(-world, -half - street_m(o));
  };
  const Eigen::Vector2d x = span(i, half_block(o).x(), half_world(o).x()),
                        y = span(j, half_block(o).y(), half_world(o).y());
  return {{x[0], y[0]}, {x[1], y[1]}};
}

}  // namespace tarmac::scenes::urban_layout
