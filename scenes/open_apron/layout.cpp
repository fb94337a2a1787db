#include "scenes/open_apron/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarmac::scenes::open_apron {

using Eigen::Vector2d;

std::vector<Vector2d> lane_centre_line(double step_m) {
  const double r = lane_turn_radius_m, half = lane_half_length_m, turn = std::numbers::pi * r;
  std::vector<Vector2d> line;
  const auto straight = [&](double from, double to, double y) {
    const int n = static_cast<int>(std::ceil(std::abs(to - from) / step_m));
    for (int k = 0; k < n; ++k) line.emplace_back(from + (to - from) * k / n, y);
  };
  const auto half_turn = [&](double x, double side) {  // clockwise, about (x, -r)
    const int n = static_cast<int>(std::ceil(turn / step_m));
    for (int k = 0; k < n; ++k) {
      const double a = std::numbers::pi * k / n;
      line.emplace_back(x + side * r * std::sin(a), -r + side * r * std::cos(a));
    }
  };
  straight(-half, half, 0);
  half_turn(half, 1);
  straight(half, -half, -2 * r);
  half_turn(-half, -1);
  line.push_back(line.front());
  return line;
}

double distance_to_lane_m(const Vector2d& p) {
  // The lane is what lies at a distance of r from the segment between the centres of its turns.
  const Vector2d nearest(std::clamp(p.x(), -lane_half_length_m, lane_half_length_m), -lane_turn_radius_m);
  return std::abs((p - nearest).norm() - lane_turn_radius_m);
}

}  // namespace tarmac::scenes::open_apron
