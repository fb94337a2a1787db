/// Equipment left standing about.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace tarmac::scenes {

/// A place taken by object `kind` of a list of kinds.
struct ClutterItem {
  std::size_t kind;
  double x_m, y_m, yaw_rad;
};

struct ClutterField {
  Eigen::Vector2d low_m, high_m;
  std::vector<double> radius_m;  ///< of a circle around each kind's footprint
  std::vector<double> weight;    ///< how often each kind comes
  double gap_m = 1;              ///< between circles
  /// Distance from (x, y) to where nothing may stand; negative inside [m].
  std::function<double(const Eigen::Vector2d&)> free_m;
};

/// `per_m2` objects on each square metre of the field on which something may stand, at uniform places, none closer than
/// gap_m to another. With one seed, fewer objects are the first ones of more: raising the density adds objects and
/// moves none. A field that is full gets fewer.
std::vector<ClutterItem> scatter(const ClutterField& field, double per_m2, std::uint64_t seed, const char* stream);

}  // namespace tarmac::scenes
