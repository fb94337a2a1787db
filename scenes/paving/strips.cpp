#include "scenes/paving/strips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Second derivatives of the ground along two directions, and the mixed one: what decides a cell's size.
struct Curvatures {
  double along = 0, across = 0, mixed = 0;
};

Curvatures curvatures(const Ground& ground, const Vector2d& p, const Vector2d& along, const Vector2d& across) {
  Vector3d h;
  ground.height_m(p.x(), p.y(), nullptr, &h);
  const auto form = [&](const Vector2d& a, const Vector2d& b) {
    return std::abs(a.x() * b.x() * h[0] + (a.x() * b.y() + a.y() * b.x()) * h[1] + a.y() * b.y() * h[2]);
  };
  return {form(along, along), form(across, across), form(along, across)};
}

/// A facet of a cell hu x hv errs by at most (a hu^2 + 2 c hu hv + b hv^2) / 8 <= ((a + c) hu^2 + (b + c) hv^2) / 8,
/// with a, b, c the curvatures: each direction gets half of the sagitta. The rest is for curvature between samples.
constexpr double share_of_sagitta = 0.45;

std::vector<double> places(double from, double to, double step) {
  const int n = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
  std::vector<double> list;
  for (int k = 0; k <= n; ++k) list.push_back(from + (to - from) * k / n);
  return list;
}

/// Largest values seen, on places `step` apart; between places the larger neighbour counts.
class Sampled {
 public:
  Sampled(double from, double to, double step) : u_(places(from, to, step)), value_(u_.size(), 0.0) {}
  const std::vector<double>& places_m() const { return u_; }
  void add(std::size_t k, double value) { value_[k] = std::max(value_[k], value); }
  double operator()(double u) const {
    const double at = (u - u_.front()) / (u_.back() - u_.front()) * static_cast<double>(u_.size() - 1);
    const auto k = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(u_.size() - 1)));
    return std::max(value_[k], value_[std::min(k + 1, u_.size() - 1)]);
  }

 private:
  std::vector<double> u_, value_;
};

/// Triangles of a grid of vertices, rows of `columns`; the diagonals alternate, so that no direction is preferred.
void add_grid(MeshBuilder& b, const std::vector<std::uint32_t>& v, std::size_t columns, bool flip,
              const std::function<bool(std::size_t i, std::size_t j)>& keep = {}) {
  for (std::size_t j = 0; j + 1 < v.size() / columns; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      if (keep && !keep(i, j)) continue;
      const std::array<std::uint32_t, 4> c{v[j * columns + i], v[j * columns + i + 1], v[(j + 1) * columns + i + 1],
                                           v[(j + 1) * columns + i]};
      const std::size_t k = (i + j) % 2;
      flip ? b.quad(c[k], c[(k + 3) % 4], c[k + 2], c[k + 1]) : b.quad(c[k], c[k + 1], c[k + 2], c[(k + 3) % 4]);
    }
  }
}

}  // namespace

std::vector<double> chord_steps(double from, double to, const std::function<double(double)>& curvature_at,
                                double sagitta_m, double max_step_m) {
  std::vector<double> list{from};
  while (list.back() < to) {
    const double u = list.back();
    double h = std::min(max_step_m, to - u);
    for (int tries = 0; tries < 60; ++tries) {
      double most = 0;
      constexpr int samples = 8;
      for (int k = 0; k <= samples; ++k) most = std::max(most, curvature_at(u + h * k / samples));
      const double allowed = most > 0 ? std::sqrt(8 * sagitta_m / most) : max_step_m;
      if (allowed >= h) break;
      h = std::max(allowed, 0.7 * h);
    }
    const double rest = to - u - h;
    if (rest < 1e-9) {
      list.push_back(to);
    } else {
      list.push_back(u + (rest < 0.25 * h ? 0.5 * (to - u) : h));  // no sliver at the end
    }
  }
  return list;
}

StripMesher::StripMesher(const Ground& ground, const CentreLine& line, double s0_m, double s1_m, double low_d_m,
                         double high_d_m, const MeshTolerance& tolerance)
    : ground_(&ground), line_(&line), tolerance_(tolerance) {
  constexpr double sample_m = 1;
  Sampled most(s0_m, s1_m, sample_m);
  const std::vector<double> across = places(low_d_m, high_d_m, 3 * sample_m);
  for (std::size_t k = 0; k < most.places_m().size(); ++k) {
    const CentreLine::Point at = line.at(most.places_m()[k]);
    for (const double d : across) {
      const Curvatures c = curvatures(ground, at.p_m + d * at.left, at.tangent, at.left);
      // A station's step is longer at the outside of a bend than on the line.
      const double stretch = 1 - at.curvature_per_m * d;
      most.add(k, (c.along + c.mixed) * stretch * stretch);
    }
    // The line's own bend: the edges of bands keep within 2 cm of their arcs in plan.
    most.add(k, std::abs(at.curvature_per_m) * share_of_sagitta * tolerance.sagitta_m / 0.02);
  }
  stations_m_ = chord_steps(s0_m, s1_m, most, share_of_sagitta * tolerance.sagitta_m, tolerance.max_cell_m);
}

std::vector<double> StripMesher::lines_across(double right_d_m, double left_d_m) const {
  Sampled most(right_d_m, left_d_m, 0.2);
  const double length_m = stations_m_.back() - stations_m_.front();
  for (const double s : places(stations_m_.front(), stations_m_.back(), std::clamp(length_m / 60, 1.0, 10.0))) {
    const CentreLine::Point at = line_->at(s);
    for (std::size_t k = 0; k < most.places_m().size(); ++k) {
      const Curvatures c = curvatures(*ground_, at.p_m + most.places_m()[k] * at.left, at.tangent, at.left);
      most.add(k, c.across + c.mixed);
    }
  }
  return chord_steps(right_d_m, left_d_m, most, share_of_sagitta * tolerance_.sagitta_m, tolerance_.max_cell_m);
}

void StripMesher::surface(MeshBuilder& b, double right_d_m, double left_d_m, double height_m, bool faces_up) const {
  const std::vector<double> across = lines_across(right_d_m, left_d_m);
  std::vector<std::uint32_t> v;
  for (const double s : stations_m_) {
    const CentreLine::Point at = line_->at(s);
    for (const double d : across) {
      const Vector2d p = at.p_m + d * at.left;
      v.push_back(b.vertex({p.x(), p.y(), ground_->height_m(p.x(), p.y()) + height_m}));
    }
  }
  add_grid(b, v, across.size(), /*flip=*/faces_up);  // columns run to the left, rows forward: left x forward is down
}

void StripMesher::band(MeshBuilder& b, double right_d_m, double left_d_m) const {
  surface(b, right_d_m, left_d_m, 0, true);
}

void StripMesher::ceiling(MeshBuilder& b, double right_d_m, double left_d_m, double height_m) const {
  surface(b, right_d_m, left_d_m, height_m, false);
}

void StripMesher::wall(MeshBuilder& b, double d_m, double low_m, double high_m, bool faces_left) const {
  std::vector<std::uint32_t> v;
  for (const double s : stations_m_) {
    const Vector2d p = line_->place(s, d_m);
    const double z = ground_->height_m(p.x(), p.y());
    v.push_back(b.vertex({p.x(), p.y(), z + low_m}));
    v.push_back(b.vertex({p.x(), p.y(), z + high_m}));
  }
  add_grid(b, v, 2, /*flip=*/!faces_left);  // columns run up, rows forward: up x forward is left
}

void add_ground_region(MeshBuilder& b, const Ground& ground, const Vector2d& low_m, const Vector2d& high_m,
                       const MeshTolerance& tolerance, const CellFilter& keep, double lift_m,
                       const std::vector<double>& cuts_x_m, const std::vector<double>& cuts_y_m) {
  const auto lines = [&](int axis, const std::vector<double>& cuts) {
    const Vector2d size = high_m - low_m;
    const double fine = std::max(0.5, size[axis] / 800), coarse = std::max(0.7, size[1 - axis] / 250);
    const Vector2d reach = 0.5 * (axis == 0 ? Vector2d(fine, coarse) : Vector2d(coarse, fine));
    Sampled most(low_m[axis], high_m[axis], fine);
    for (std::size_t k = 0; k < most.places_m().size(); ++k) {
      for (const double other : places(low_m[1 - axis], high_m[1 - axis], coarse)) {
        Vector2d p;
        p[axis] = most.places_m()[k];
        p[1 - axis] = other;
        if (keep && !keep(p - reach, p + reach)) continue;  // nothing to follow here
        const Curvatures c = curvatures(ground, p, Vector2d::UnitX(), Vector2d::UnitY());
        most.add(k, (axis == 0 ? c.along : c.across) + c.mixed);
      }
    }
    std::vector<double> ends{low_m[axis], high_m[axis]};
    for (const double cut : cuts) {
      if (cut > low_m[axis] + 1e-6 && cut < high_m[axis] - 1e-6) ends.push_back(cut);
    }
    std::sort(ends.begin(), ends.end());
    std::vector<double> list{ends.front()};
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      if (ends[k + 1] - ends[k] < 1e-6) continue;
      const std::vector<double> part =
          chord_steps(ends[k], ends[k + 1], most, share_of_sagitta * tolerance.sagitta_m, tolerance.max_cell_m);
      list.insert(list.end(), part.begin() + 1, part.end());
    }
    return list;
  };
  const std::vector<double> xs = lines(0, cuts_x_m), ys = lines(1, cuts_y_m);
  std::vector<std::uint32_t> v;
  for (const double y : ys) {
    for (const double x : xs) v.push_back(b.vertex({x, y, ground.height_m(x, y) + lift_m}));
  }
  add_grid(b, v, xs.size(), /*flip=*/false, [&](std::size_t i, std::size_t j) {
    return !keep || keep({xs[i], ys[j]}, {xs[i + 1], ys[j + 1]});
  });
}

namespace {

/// Point of the arc that touches both lines, u = 0 at the first line and 1 at the second.
struct Fillet {
  Vector2d centre;
  double radius_m, from_rad, turn_rad, leg_m;
  Vector2d arc(double u) const {
    const double a = from_rad + u * turn_rad;
    return centre + radius_m * Vector2d(std::cos(a), std::sin(a));
  }
};

Fillet fillet(const Vector2d& corner, const Vector2d& start, const Vector2d& end, double radius_m) {
  const double angle = std::acos(std::clamp(start.dot(end), -1.0, 1.0));  // between the lines
  const double leg = radius_m / std::tan(angle / 2);
  const Vector2d centre = corner + (start + end).normalized() * (radius_m / std::sin(angle / 2));
  const Vector2d a = corner + leg * start - centre, c = corner + leg * end - centre;
  const double turn = std::atan2(a.x() * c.y() - a.y() * c.x(), a.dot(c));
  return {centre, radius_m, std::atan2(a.y(), a.x()), turn, leg};
}

/// Between two legs that meet at `knee` and the arc: rays from points of the legs to points of the arc, cut into cells.
void fill_to_arc(MeshBuilder& b, const Ground& ground, const Fillet& f, const Vector2d& touch0, const Vector2d& knee,
                 const Vector2d& touch1, double most_curved, bool facing_left, const MeshTolerance& tolerance) {
  const double cell =
      std::clamp(most_curved > 0 ? std::sqrt(2 * tolerance.sagitta_m / most_curved) : tolerance.max_cell_m, 0.1,
                 tolerance.max_cell_m);
  const int half = std::max(2, static_cast<int>(std::ceil((knee - touch0).norm() / cell)));
  const int rows = std::max(1, static_cast<int>(std::ceil((f.arc(0.5) - knee).norm() / cell)));
  const auto leg = [&](int k) -> Vector2d {
    return k <= half ? touch0 + (knee - touch0) * k / half : knee + (touch1 - knee) * (k - half) / half;
  };
  std::vector<std::uint32_t> v;
  for (int k = 0; k <= 2 * half; ++k) {
    const Vector2d from = leg(k), to = f.arc(k / (2.0 * half));
    for (int j = 0; j <= rows; ++j) {
      const Vector2d p = from + (to - from) * j / rows;
      v.push_back(b.vertex({p.x(), p.y(), ground.height_m(p.x(), p.y())}));
    }
  }
  const auto at = [&](int k, int j) { return v[static_cast<std::size_t>(k * (rows + 1) + j)]; };
  const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    facing_left ? b.triangle(p, q, r) : b.triangle(p, r, q);
  };
  for (int k = 0; k < 2 * half; ++k) {
    for (int j = 0; j < rows; ++j) {
      if (k > 0) add(at(k, j), at(k, j + 1), at(k + 1, j));  // the rays at both ends have no length
      if (k + 1 < 2 * half) add(at(k, j + 1), at(k + 1, j + 1), at(k + 1, j));
    }
  }
}

double most_curved(const Ground& ground, const Vector2d& corner, const Vector2d& leg0, const Vector2d& leg1) {
  double most = 0;
  const int n = static_cast<int>(std::ceil(std::max(leg0.norm(), leg1.norm()) / 0.5));
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const Curvatures c = curvatures(ground, corner + (i * leg0 + j * leg1) / n, leg0.normalized(), leg1.normalized());
      most = std::max(most, c.along + c.across + 2 * c.mixed);
    }
  }
  return most;
}

void add_fillet_part(MeshBuilder& b, const Ground& ground, const Vector2d& corner_m, const Vector2d& start,
                     const Vector2d& end, double radius_m, const MeshTolerance& tolerance, bool rest) {
  const Fillet f = fillet(corner_m, start, end, radius_m);
  const Vector2d leg0 = f.leg_m * start, leg1 = f.leg_m * end;
  const bool left = start.x() * end.y() - start.y() * end.x() > 0;
  fill_to_arc(b, ground, f, corner_m + leg0, rest ? corner_m + leg0 + leg1 : corner_m, corner_m + leg1,
              most_curved(ground, corner_m, leg0, leg1), left != rest, tolerance);
}

}  // namespace

void add_fillet(MeshBuilder& b, const Ground& ground, const Vector2d& corner_m, const Vector2d& start,
                const Vector2d& end, double radius_m, const MeshTolerance& tolerance) {
  add_fillet_part(b, ground, corner_m, start, end, radius_m, tolerance, false);
}

void add_fillet_rest(MeshBuilder& b, const Ground& ground, const Vector2d& corner_m, const Vector2d& start,
                     const Vector2d& end, double radius_m, const MeshTolerance& tolerance) {
  add_fillet_part(b, ground, corner_m, start, end, radius_m, tolerance, true);
}

void add_swept(MeshBuilder& b, const Ground& ground, const CentreLine& line, double s0_m, double s1_m,
               const std::vector<Vector2d>& outline, double step_m) {
  const int n = std::max(1, static_cast<int>(std::ceil((s1_m - s0_m) / step_m - 1e-9)));
  std::vector<Ring> rings;
  for (int k = 0; k <= n; ++k) {
    const CentreLine::Point at = line.at(s0_m + (s1_m - s0_m) * k / n);
    Ring ring;
    for (const Vector2d& q : outline) {
      const Vector2d p = at.p_m + q.x() * at.left;
      ring.emplace_back(p.x(), p.y(), ground.height_m(p.x(), p.y()) + q.y());
    }
    rings.push_back(std::move(ring));
  }
  add_loft(b, rings);
}

std::vector<Vector2d> rectangle_outline(double d0_m, double h0_m, double d1_m, double h1_m) {
  return {{d0_m, h0_m}, {d0_m, h1_m}, {d1_m, h1_m}, {d1_m, h0_m}};
}

std::vector<Vector2d> circle_outline(double d_m, double h_m, double radius_m, int segments) {
  std::vector<Vector2d> outline;
  for (int k = 0; k < segments; ++k) {
    const double a = 2 * std::numbers::pi * k / segments;
    outline.emplace_back(d_m + radius_m * std::sin(a), h_m + radius_m * std::cos(a));
  }
  return outline;
}

}  // namespace tarmac::scenes
