#include "scenes/apron/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector2d;
using enum MaterialId;

/// Yellow with a black outline on both sides, as on concrete.
void paint_lead_in_line(Painter& p, const std::vector<Vector2d>& line, double width_m) {
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

namespace {

/// A digit of seven bars, readable by a pilot who comes from the south.
void paint_digit(Painter& p, char c, const Vector2d& low_left, double height_m, double sign) {
  static constexpr std::array<const char*, 10> bars{"abcdef", "bc",     "abged", "abgcd",   "fgbc",
                                                    "afgcd",  "afgedc", "abc",   "abcdefg", "abcdfg"};
  const double w = 0.55 * height_m, t = 0.16 * height_m, h = height_m, m = h / 2;
  for (const char* bar = bars[static_cast<std::size_t>(c - '0')]; *bar != 0; ++bar) {
    const auto box = [&](double x0, double y0, double x1, double y1) {
      const Vector2d a = low_left + sign * Vector2d(x0, y0), b = low_left + sign * Vector2d(x1, y1);
      p.rectangle(a.cwiseMin(b), a.cwiseMax(b));
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

}  // namespace

void paint_number(Painter& p, const std::string& text, const Vector2d& low_left, double height_m, double sign) {
  for (std::size_t k = 0; k < text.size(); ++k)
    paint_digit(p, text[k], low_left + sign * Vector2d(0.75 * height_m * static_cast<double>(k), 0), height_m, sign);
}

void paint_hatch(Painter& p, const Vector2d& low, const Vector2d& high, double pitch_m) {
  p.line({low, {high.x(), low.y()}, high, {low.x(), high.y()}, low}, 0.15);
  for (double s = pitch_m; s < (high - low).sum(); s += pitch_m) {  // diagonals x + y = const
    const double w = (high - low).x(), h = (high - low).y();
    const Vector2d a = s < w ? Vector2d(s, 0) : Vector2d(w, s - w), b = s < h ? Vector2d(0, s) : Vector2d(s - h, h);
    if ((a - b).norm() > 0.6)
      p.line({low + a + 0.1 * (b - a).normalized(), low + b + 0.1 * (a - b).normalized()}, 0.15);
  }
}

void paint_road(Painter& p, double centre_y, double west, double east, double lane_width_m,
                const std::vector<double>& crossings) {
  const double edge = lane_width_m;
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

void paint_cross_road(Painter& p, double centre_x, double south, double north, double lane_width_m) {
  p.use(paint_white_marking).layer(0);
  for (const double side : {-1.0, 1.0})
    p.line({{centre_x + side * lane_width_m, south}, {centre_x + side * lane_width_m, north}}, 0.12);
  p.dashes({centre_x, south}, {centre_x, north}, 0.12, 2, 4);
}

void paint_stand(Painter& p, const StandPaint& s) {
  const StandFrame& f = s.frame;
  const auto bar = [&](double x0, double y0, double x1, double y1) {
    const Vector2d a = f.world(x0, y0), b = f.world(x1, y1);
    p.rectangle(a.cwiseMin(b), a.cwiseMax(b));
  };
  std::vector<Vector2d> line;
  constexpr int n = 28;
  for (int k = 0; k <= n; ++k) {
    const double angle = std::numbers::pi / 2 * k / n, r = s.lead_in_radius_m;
    line.push_back(f.world(s.lead_in_from * r * (1 - std::sin(angle)), -s.taxilane_m + r * (1 - std::cos(angle))));
  }
  line.push_back(f.world(0, -s.nose_gear_m));
  paint_lead_in_line(p, line, 0.3);
  p.use(paint_yellow_marking).layer(3);
  bar(-3, -s.nose_gear_m - 0.08, 3, -s.nose_gear_m + 0.08);
  for (const double dy : {-3.3, -6.2}) bar(-1.5, -s.nose_gear_m + dy - 0.06, 1.5, -s.nose_gear_m + dy + 0.06);
  p.use(paint_yellow_marking).layer(1);
  paint_number(p, s.number, f.world(1.2, -s.length_m + 1), 3, f.sign);
  paint_number(p, s.number, f.world(-0.9, -s.nose_gear_m + 1.2), 1.5, f.sign);
  const double half = s.half_width_m - 0.6, north = 3.5, south = -s.length_m - 2;
  const auto loop = [&](double w, double front, double e, double back) {
    return std::vector<Vector2d>{f.world(w, back), f.world(e, back), f.world(e, front), f.world(w, front),
                                 f.world(w, back)};
  };
  p.use(paint_red_marking).layer(0).line(loop(-half, north, half, south), 0.15);
  p.use(paint_white_marking);
  for (const double side : {-1.0, 1.0})
    p.line({f.world(side * (half + 0.25), south), f.world(side * (half + 0.25), north)}, 0.1);
  for (int k = 0; k < 2; ++k) {  // staging boxes
    const double east = half - 0.9 - 3.2 * k;
    p.line(loop(east - 3, 2.8, east, -17), 0.1);
  }
}

}  // namespace tarmac::scenes
