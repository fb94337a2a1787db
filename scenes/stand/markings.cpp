#include <cmath>
#include <numbers>
#include <string>

#include "scenes/stand/layout.h"
#include "scenes/stand/parts.h"

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;
namespace l = layout;

namespace {

constexpr double taxilane_y_m = -66, lead_in_radius_m = 22, stop_y_m = l::nose_y_m - 5.07;

/// Yellow with a black outline on both sides, as on concrete.
void lead_in_line(Painter& p, const std::vector<Vector2d>& line, double width_m) {
  p.use(paint_yellow_marking).layer(2).line(line, width_m);
  constexpr double outline_m = 0.1;
  for (const double side : {-1.0, 1.0}) {
    std::vector<Vector2d> edge;
    for (std::size_t k = 0; k < line.size(); ++k) {
      const Vector2d d = (line[std::min(k + 1, line.size() - 1)] - line[k > 0 ? k - 1 : 0]).normalized();
      edge.emplace_back(line[k] + side * (width_m + outline_m) / 2 * Vector2d(-d.y(), d.x()));
    }
    p.use(paint_black_marking).layer(1).line(edge, outline_m);
  }
}

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

/// A digit of seven bars, readable by a pilot who comes from the south.
void digit(Painter& p, char c, const Vector2d& low_left, double height_m) {
  static constexpr std::array<const char*, 10> bars{"abcdef", "bc",     "abged", "abgcd",   "fgbc",
                                                    "afgcd",  "afgedc", "abc",   "abcdefg", "abcdfg"};
  const double w = 0.55 * height_m, t = 0.16 * height_m, h = height_m, m = h / 2;
  for (const char* bar = bars[static_cast<std::size_t>(c - '0')]; *bar != 0; ++bar) {
    const auto box = [&](double x0, double y0, double x1, double y1) {
      p.rectangle(low_left + Vector2d(x0, y0), low_left + Vector2d(x1, y1));
    };
    switch (*bar) {
      case 'a':
        box(t, h - t, w - t, h);
        break;
      case 'b':
        box(w - t, m, w, h);
        break;
      case 'c':
        box(w - t, 0, w, m);
        break;
      case 'd':
        box(t, 0, w - t, t);
        break;
      case 'e':
        box(0, 0, t, m);
        break;
      case 'f':
        box(0, m, t, h);
        break;
      default:
        box(t, m - t / 2, w - t, m + t / 2);
        break;
    }
  }
}

void number(Painter& p, const std::string& text, const Vector2d& low_left, double height_m) {
  for (std::size_t k = 0; k < text.size(); ++k)
    digit(p, text[k], low_left + Vector2d(0.75 * height_m * static_cast<double>(k), 0), height_m);
}

void hatch(Painter& p, const Vector2d& low, const Vector2d& high, double pitch_m) {
  p.line({low, {high.x(), low.y()}, high, {low.x(), high.y()}, low}, 0.15);
  for (double s = pitch_m; s < (high - low).sum(); s += pitch_m) {  // diagonals x + y = const
    const double w = (high - low).x(), h = (high - low).y();
    const Vector2d a = s < w ? Vector2d(s, 0) : Vector2d(w, s - w), b = s < h ? Vector2d(0, s) : Vector2d(s - h, h);
    if ((a - b).norm() > 0.6)
      p.line({low + a + 0.1 * (b - a).normalized(), low + b + 0.1 * (a - b).normalized()}, 0.15);
  }
}

void stand(Painter& p, double x, const std::string& name, bool neighbour) {
  std::vector<Vector2d> line = lead_in(x, x > 1 ? -1 : 1);
  line.emplace_back(x, stop_y_m);
  lead_in_line(p, line, 0.3);
  p.use(paint_yellow_marking).layer(3).rectangle({x - 3, stop_y_m - 0.08}, {x + 3, stop_y_m + 0.08});
  for (const double dy : {-3.3, -6.2}) p.rectangle({x - 1.5, stop_y_m + dy - 0.06}, {x + 1.5, stop_y_m + dy + 0.06});
  p.use(paint_yellow_marking).layer(1);
  number(p, name, {x + 1.2, -22}, 3);
  number(p, name, {x - 0.9, stop_y_m + 1.2}, 1.5);
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

void road(Painter& p, double centre_y, double west, double east, const std::vector<double>& crossings) {
  const double edge = l::lane_width_m;
  p.use(paint_white_marking).layer(0);
  for (const double side : {-1.0, 1.0}) {
    double from = west;
    for (const double x : crossings) {  // a zipper of blocks where aircraft cross
      const double y = centre_y + side * edge;
      p.line({{from, y}, {x - 10, y}}, 0.12);
      for (int k = 0; k < 20; ++k) {
        const double x0 = x - 10 + k, dy = k % 2 == 0 ? -0.16 : 0.16;
        p.rectangle({x0, y + dy - 0.14}, {x0 + 1, y + dy + 0.14});
      }
      from = x + 10;
    }
    p.line({{from, centre_y + side * edge}, {east, centre_y + side * edge}}, 0.12);
  }
  p.dashes({west, centre_y}, {east, centre_y}, 0.12, 2, 4);
}

}  // namespace

Mesh make_markings(const SlabSurface& slabs) {
  Painter p(slabs);
  const std::vector<double> stands{l::neighbour_west_x_m, 0, l::neighbour_east_x_m};
  lead_in_line(p, {{-110, taxilane_y_m}, {110, taxilane_y_m}}, 0.15);
  stand(p, l::neighbour_west_x_m, "11", true);
  stand(p, 0, "12", false);
  stand(p, l::neighbour_east_x_m, "13", true);
  road(p, l::tail_road_centre_y_m, -115, 112, stands);
  road(p, l::head_road_centre_y_m, -115, 115, {});
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
  hatch(p, {-14.5, 24.2}, {-9, 30.5}, 1.0);
  // No parking in front of the doors.
  p.use(paint_white_marking).layer(1);
  hatch(p, {-54, 45.1}, {-48, 47.4}, 0.8);
  return std::move(p).build();
}

}  // namespace tarmac::scenes
