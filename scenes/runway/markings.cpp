#include <cmath>
#include <numbers>

#include "scenes/paving/ground_painter.h"
#include "scenes/runway/parts.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;

namespace {

void runway(GroundPainter& p, const RunwayLayout& l) {
  p.use(paint_white_marking).layer(0);
  for (const double side : {-1.0, 1.0}) {
    const double y = side * (l.half_m - 0.45);
    p.line({{l.threshold_m, y}, {l.east_m, y}}, 0.9);
  }
  // Threshold: a line across, then stripes of 30 m beside each other, 1.8 m wide with 1.8 m between.
  p.line({{l.threshold_m + 0.9, -l.half_m + 0.9}, {l.threshold_m + 0.9, l.half_m - 0.9}}, 1.8);
  constexpr double stripe_m = 1.8;
  const int stripes = static_cast<int>((l.half_m - 3) / (2 * stripe_m));
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k < stripes; ++k) {
      const double y = side * (stripe_m * (1 + 2 * k) + stripe_m / 2);
      p.line({{l.threshold_m + 6, y}, {l.threshold_m + 36, y}}, stripe_m);
    }
  }
  p.text("09", {l.threshold_m + 48, 0}, 0, 9);
  p.dashes({l.threshold_m + 70, 0}, {l.east_m, 0}, 0.9, 30, 20);
  // Aiming point, 400 m from the threshold.
  if (l.threshold_m + 460 < l.east_m) {
    for (const double side : {-1.0, 1.0}) {
      const double y = side * (0.4 * l.half_m + 4);
      p.rectangle({l.threshold_m + 400, y}, 0, {0, -4}, {60, 4});
    }
  }
}

/// Two solid lines on the side where aircraft hold, two dashed ones on the runway's side.
void holding_position(GroundPainter& p, const RunwayLayout& l, double towards_runway) {
  const double y0 = -towards_runway * l.hold_m, half = l.taxiway.edge_m;
  constexpr double width = 0.3;
  for (int k = 0; k < 2; ++k) {
    const double solid = y0 + towards_runway * (2 * k * width), dashed = y0 + towards_runway * (4 + 2 * k) * width;
    p.line({{-half, solid}, {half, solid}}, width);
    p.dashes({-half, dashed}, {half, dashed}, width, 0.9, 0.9);
  }
}

void taxiway(GroundPainter& p, const RunwayLayout& l) {
  p.use(paint_yellow_marking);
  for (const auto& [from, to, towards] : {std::tuple{l.south_m, -l.half_m - 1, 1.0}, {l.north_m, l.half_m + 1, -1.0}}) {
    p.layer(1).line({{0, from}, {0, to}}, 0.3);
    for (const double side : {-1.0, 1.0}) {
      for (const double inward : {0.1, 0.4}) {
        const double x = side * (l.taxiway.edge_m - inward);
        p.layer(0).line({{x, from}, {x, -towards * (l.shoulder_m + l.fillet_m)}}, 0.15);
      }
    }
    p.layer(2);
    holding_position(p, l, towards);
  }
}

void road(GroundPainter& p, const RunwayLayout& l) {
  const double edge = l.taxiway.shoulder_m, reach = l.road_reach_m, half = l.road_half_m - 0.2, y = l.road_y_m;
  p.use(paint_white_marking).layer(1);
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-1.0, 1.0}) p.line({{end * reach, y + side * half}, {end * edge, y + side * half}}, 0.12);
    // A zipper of blocks across the taxiway.
    const int n = static_cast<int>(2 * edge);
    for (int k = 0; k < n; ++k)
      p.rectangle({-edge + k, y + side * half + (k % 2 == 0 ? -0.15 : 0.15)}, 0, {0, -0.14}, {1, 0.14});
    p.line({{side * (edge + 3), y}, {side * (edge + 3), y - side * half}}, 0.4);  // stop line, lane on the left
  }
  p.dashes({-reach, y}, {-edge - 4, y}, 0.12, 2, 4);
  p.dashes({edge + 4, y}, {reach, y}, 0.12, 2, 4);
}

}  // namespace

Mesh make_runway_markings(const RunwayLayout& layout, const Ground& ground) {
  GroundPainter p(ground, "markings");
  runway(p, layout);
  taxiway(p, layout);
  if (layout.has_road) road(p, layout);
  return std::move(p).build();
}

}  // namespace tarmac::scenes
