/// A height along one coordinate: straight grades with rounded breaks, infinitely differentiable.
#pragma once

#include <vector>

namespace tarmac::scenes {

/// z(u) = z_0 + g_0 (u - u_0) + sum_k (g_k - g_(k-1)) w_k ln(1 + exp((u - u_k) / w_k)): the polyline through the given
/// points, each break rounded over a few w_k. The grade changes by a logistic function, so the vertical curve at break
/// k has its smallest radius, 4 w_k / |g_k - g_(k-1)|, at the break. Beyond its ends the polyline goes on straight.
class RoundedProfile {
 public:
  /// A point of the polyline; `rounding_m` is w, unused at the first and last point.
  struct Point {
    double u_m, z_m, rounding_m = 0.5;
  };
  struct Value {
    double z_m = 0, grade = 0, curvature_per_m = 0;
  };

  RoundedProfile() = default;  ///< height 0 everywhere
  /// At least two points, u strictly increasing, roundings above 0. Throws std::invalid_argument otherwise.
  explicit RoundedProfile(const std::vector<Point>& points);
  Value at(double u_m) const;

 private:
  struct Break {
    double u_m, grade_change, rounding_m;
  };
  double u0_m_ = 0, z0_m_ = 0, grade0_ = 0;
  std::vector<Break> breaks_;
};

}  // namespace tarmac::scenes
