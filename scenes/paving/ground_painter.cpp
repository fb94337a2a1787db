#include "scenes/paving/ground_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double piece_m = 1.25;  ///< of paint, at most: it follows the ground as the pavement's facets do

Vector2d left_of(const Vector2d& d) {
  return {-d.y(), d.x()};
}

/// Which of the bars a (top), b, c (right), d (bottom), e, f (left), g (middle) make a character.
const char* bars_of(char c) {
  static constexpr std::array<const char*, 10> digits{"abcdef", "bc",     "abged", "abgcd",   "fgbc",
                                                      "afgcd",  "afgedc", "abc",   "abcdefg", "abcdfg"};
  if (c >= '0' && c <= '9') return digits[static_cast<std::size_t>(c - '0')];
  switch (c) {
    case 'A':
      return "abcefg";
    case 'C':
      return "afed";
    case 'E':
      return "afged";
    case 'F':
      return "afge";
    case 'L':
      return "fed";
    case 'P':
      return "abgfe";
    case 'U':
      return "fedcb";
    default:
      throw std::invalid_argument(std::string("GroundPainter: no bars for '") + c + "'");
  }
}

}  // namespace

void GroundPainter::polygon(const std::vector<Vector2d>& convex_counter_clockwise) {
  std::vector<std::uint32_t> v;
  for (const Vector2d& p : convex_counter_clockwise)
    v.push_back(builder_.vertex({p.x(), p.y(), ground_->height_m(p.x(), p.y()) + thickness_m_}));
  for (std::size_t k = 2; k < v.size(); ++k) builder_.triangle(v[0], v[k - 1], v[k]);
}

void GroundPainter::rectangle(const Vector2d& at, double yaw_rad, const Vector2d& low, const Vector2d& high) {
  const Vector2d along(std::cos(yaw_rad), std::sin(yaw_rad)), left = left_of(along);
  const int nx = std::max(1, static_cast<int>(std::ceil((high - low).x() / piece_m)));
  const int ny = std::max(1, static_cast<int>(std::ceil((high - low).y() / piece_m)));
  const auto place = [&](int i, int j) -> Vector2d {
    const Vector2d p = low + (high - low).cwiseProduct(Vector2d(double(i) / nx, double(j) / ny));
    return at + p.x() * along + p.y() * left;
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) polygon({place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)});
  }
}

void GroundPainter::line(const std::vector<Vector2d>& points, double width_m) {
  std::vector<Vector2d> offset;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector2d in = k > 0 ? Vector2d((points[k] - points[k - 1]).normalized()) : Vector2d::Zero();
    const Vector2d out = k + 1 < points.size() ? Vector2d((points[k + 1] - points[k]).normalized()) : Vector2d::Zero();
    const Vector2d along = (in + out).normalized();
    const double stretch = 1 / std::max(0.5, along.dot(k > 0 ? in : out));
    offset.emplace_back(left_of(along) * (width_m / 2 * stretch));
  }
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const int n = std::max(1, static_cast<int>(std::ceil((points[k + 1] - points[k]).norm() / piece_m)));
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int step, double side) -> Vector2d {
        const double s = static_cast<double>(step) / n;
        return (1 - s) * (points[k] + side * offset[k]) + s * (points[k + 1] + side * offset[k + 1]);
      };
      polygon({at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1)});
    }
  }
}

void GroundPainter::dashes(const Vector2d& from, const Vector2d& to, double width_m, double mark_m, double gap_m) {
  const double length = (to - from).norm();
  const Vector2d along = (to - from) / length;
  for (double s = 0; s + mark_m <= length; s += mark_m + gap_m)
    line({from + s * along, from + (s + mark_m) * along}, width_m);
}

void GroundPainter::text(const std::string& text, const Vector2d& at, double yaw_rad, double height_m) {
  const double w = 0.55 * height_m, t = 0.16 * height_m, h = height_m, m = h / 2, pitch = 0.75 * height_m;
  const double begin = -0.5 * (pitch * static_cast<double>(text.size()) - (pitch - w));
  for (std::size_t k = 0; k < text.size(); ++k) {
    const double x0 = begin + pitch * static_cast<double>(k);
    // In the reader's frame: x to the right, y away; the rectangle's frame has x away and y to the left.
    const auto box = [&](double xa, double ya, double xb, double yb) {
      rectangle(at, yaw_rad, {ya, -(x0 + xb)}, {yb, -(x0 + xa)});
    };
    for (const char* bar = bars_of(text[k]); *bar != 0; ++bar) {
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
}

}  // namespace tarmac::scenes
