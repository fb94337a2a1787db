#include "scenes/stand/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarmac::scenes::layout {

using Eigen::Vector2d;

namespace {

void append_line(std::vector<Vector2d>& line, const Vector2d& to, double step_m) {
  const Vector2d from = line.back();
  const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step_m)));
  for (int i = 1; i <= n; ++i) line.push_back(from + (to - from) * (static_cast<double>(i) / n));
}

/// A quarter turn to the left around `corner`, arriving with direction `heading`.
void append_left_turn(std::vector<Vector2d>& line, const Vector2d& corner, const Vector2d& heading, double step_m) {
  const double r = corridor_turn_radius_m;
  const Vector2d left(-heading.y(), heading.x());
  append_line(line, corner - r * heading, step_m);
  const Vector2d centre = corner - r * heading + r * left;
  const int n = std::max(4, static_cast<int>(std::ceil(r * std::numbers::pi / 2 / step_m)));
  for (int i = 1; i <= n; ++i) {
    const double a = std::numbers::pi / 2 * i / n;
    line.push_back(centre + r * (std::sin(a) * heading - std::cos(a) * left));
  }
}

}  // namespace

std::vector<Vector2d> corridor_centre_line(double step_m) {
  std::vector<Vector2d> line{{corridor_start_x_m, corridor_south_y_m}};
  append_left_turn(line, {corridor_east_x_m, corridor_south_y_m}, {1, 0}, step_m);
  append_left_turn(line, {corridor_east_x_m, corridor_north_y_m}, {0, 1}, step_m);
  append_left_turn(line, {corridor_west_x_m, corridor_north_y_m}, {-1, 0}, step_m);
  append_left_turn(line, {corridor_west_x_m, corridor_south_y_m}, {0, -1}, step_m);
  append_line(line, {corridor_end_x_m, corridor_south_y_m}, step_m);
  return line;
}

}  // namespace tarmac::scenes::layout
