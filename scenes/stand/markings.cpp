#include <cmath>
#include <numbers>
#include <string>

#include "scenes/apron/marks.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;
namespace l = layout;

namespace {

constexpr double taxilane_y_m = -66, lead_in_radius_m = 22, stop_y_m = l::nose_y_m - 5.07;

/// Quarter circle from the taxilane (eastbound or westbound) into the stand.
std::vector<Vector2d> lead_in(double stand_x_m, double direction) {
  std::vector<Vector2d> line;
  constexpr int n = 28;
  for (int k = 0; k <= n; ++k) {
    const double a = std::numbers::pi / 2 * k / n;
    line.emplace_back(stand_x_m - direction * lead_in_radius_m * (1 - std::sin(a)),
                      taxilane_y_m + lead_in_radius_m * (1 - std::cos(a)));
  }
  return line;
}

void stand(Painter& p, double x, const std::string& name, bool neighbour) {
  std::vector<Vector2d> line = lead_in(x, x > 1 ? -1 : 1);
  line.emplace_back(x, stop_y_m);
  paint_lead_in_line(p, line, 0.3);
  p.use(paint_yellow_marking).layer(3).rectangle({x - 3, stop_y_m - 0.08}, {x + 3, stop_y_m + 0.08});
  for (const double dy : {-3.3, -6.2}) p.rectangle({x - 1.5, stop_y_m + dy - 0.06}, {x + 1.5, stop_y_m + dy + 0.06});
  p.use(paint_yellow_marking).layer(1);
  paint_number(p, name, {x + 1.2, -22}, 3);
  paint_number(p, name, {x - 0.9, stop_y_m + 1.2}, 1.5);
  // Equipment restraint area: the envelope of span and length plus clearance.
  const double half = 22.2, north = l::nose_y_m + 3.5, south = -13;
  p.use(paint_red_marking)
      .layer(0)
      .line({{x - half, south}, {x + half, south}, {x + half, north}, {x - half, north}, {x - half, south}}, 0.15);
  p.use(paint_white_marking).line({{x + half + 0.25, south}, {x + half + 0.25, north}}, 0.1);
  p.line({{x - half - 0.25, south}, {x - half - 0.25, north}}, 0.1);
  // Equipment staging boxes.
  const double bx = neighbour ? x - 20 : x + 11;
  for (int k = 0; k < 3; ++k) {
    const double x0 = bx + 3.2 * k;
    p.line({{x0, 13}, {x0 + 3, 13}, {x0 + 3, 32}, {x0, 32}, {x0, 13}}, 0.1);
  }
}

}  // namespace

Mesh make_markings(const SlabSurface& slabs) {
  Painter p(slabs);
  const std::vector<double> stands{l::neighbour_west_x_m, 0, l::neighbour_east_x_m};
  paint_lead_in_line(p, {{-110, taxilane_y_m}, {110, taxilane_y_m}}, 0.15);
  stand(p, l::neighbour_west_x_m, "11", true);
  stand(p, 0, "12", false);
  stand(p, l::neighbour_east_x_m, "13", true);
  paint_road(p, l::tail_road_centre_y_m, -115, 112, l::lane_width_m, stands);
  paint_road(p, l::head_road_centre_y_m, -115, 115, l::lane_width_m, {});
  // The drive's strips beside the stand are roads that join head and tail.
  p.use(paint_white_marking).layer(0);
  for (const double x : {l::corridor_east_x_m, l::corridor_west_x_m}) {
    for (const double side : {-1.0, 1.0}) {
      const double half = l::corridor_width_m / 2 - 0.1;
      p.dashes({x + side * half, l::tail_road_centre_y_m + l::lane_width_m + 6},
               {x + side * half, l::head_road_centre_y_m - l::lane_width_m - 6}, 0.1, 1, 1);
    }
  }
  // Where the bridge's wheels go.
  p.use(paint_red_marking).layer(1);
  paint_hatch(p, {-14.5, 24.2}, {-9, 30.5}, 1.0);
  // No parking in front of the doors.
  p.use(paint_white_marking).layer(1);
  paint_hatch(p, {-54, 45.1}, {-48, 47.4}, 0.8);
  return std::move(p).build();
}

}  // namespace tarmac::scenes
