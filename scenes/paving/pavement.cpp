#include "scenes/paving/pavement.h"

#include <algorithm>
#include <cmath>

namespace tarmac::scenes {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Vertices of one slab, (cells + 1)^2, row by row.
struct SlabPatch {
  std::vector<std::uint32_t> vertices;
  int side = 0;
  std::uint32_t at(int a, int b) const { return vertices[static_cast<std::size_t>(b * side + a)]; }
};

SlabPatch add_slab(MeshBuilder& builder, const SlabSurface& slabs, int i, int j, int cells) {
  const SlabGrid& grid = slabs.grid();
  const double half_joint = grid.joint_width_m / 2, inner = grid.size_m - grid.joint_width_m;
  SlabPatch patch{{}, cells + 1};
  for (int b = 0; b <= cells; ++b) {
    for (int a = 0; a <= cells; ++a) {
      const double x = grid.origin_m.x() + i * grid.size_m + half_joint + inner * a / cells;
      const double y = grid.origin_m.y() + j * grid.size_m + half_joint + inner * b / cells;
      patch.vertices.push_back(builder.vertex({x, y, slabs.height_m(i, j, x, y)}));
    }
  }
  for (int b = 0; b < cells; ++b) {
    for (int a = 0; a < cells; ++a) {
      // The diagonal alternates: no direction of the mesh is preferred.
      if ((a + b) % 2 == 0) {
        builder.quad(patch.at(a, b), patch.at(a + 1, b), patch.at(a + 1, b + 1), patch.at(a, b + 1));
      } else {
        builder.quad(patch.at(a + 1, b), patch.at(a + 1, b + 1), patch.at(a, b + 1), patch.at(a, b));
      }
    }
  }
  return patch;
}

/// Strips of sealant from each slab to its eastern and northern neighbour, and the square where four slabs meet.
void add_joints(MeshBuilder& builder, const std::vector<SlabPatch>& patches, const SlabGrid& grid, int cells) {
  const auto patch = [&](int i, int j) -> const SlabPatch& {
    return patches[static_cast<std::size_t>(j * grid.nx + i)];
  };
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      for (int k = 0; k < cells; ++k) {
        if (i + 1 < grid.nx) {
          const SlabPatch &w = patch(i, j), &e = patch(i + 1, j);
          builder.quad(w.at(cells, k), e.at(0, k), e.at(0, k + 1), w.at(cells, k + 1));
        }
        if (j + 1 < grid.ny) {
          const SlabPatch &s = patch(i, j), &n = patch(i, j + 1);
          builder.quad(s.at(k, cells), s.at(k + 1, cells), n.at(k + 1, 0), n.at(k, 0));
        }
      }
      if (i + 1 < grid.nx && j + 1 < grid.ny) {
        builder.quad(patch(i, j).at(cells, cells), patch(i + 1, j).at(0, cells), patch(i + 1, j + 1).at(0, 0),
                     patch(i, j + 1).at(cells, 0));
      }
    }
  }
}

/// The part of a convex polygon where sign * (coordinate - limit) <= 0.
std::vector<Vector2d> cut(const std::vector<Vector2d>& polygon, int axis, double limit, double sign) {
  std::vector<Vector2d> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double dp = sign * (p[axis] - limit), dq = sign * (q[axis] - limit);
    if (dp <= 0) kept.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  return kept;
}

double area_m2(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

}  // namespace

Mesh make_pavement(const SlabSurface& slabs) {
  const SlabGrid& grid = slabs.grid();
  const int cells = static_cast<int>(std::ceil(grid.size_m / grid.cell_m));
  MeshBuilder builder("pavement");
  builder.use(MaterialId::concrete_dry);
  std::vector<SlabPatch> patches;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) patches.push_back(add_slab(builder, slabs, i, j, cells));
  }
  builder.use(MaterialId::joint_sealant);
  add_joints(builder, patches, grid, cells);
  return std::move(builder).build();
}

Mesh make_grass(const Ground& ground, const SlabGrid& grid) {
  constexpr double cell_m = 5, reach_m = 100, step_m = 0.05, overlap_m = 0.5;
  const Vector2d low = grid.origin_m, high = low + grid.size_m * Vector2d(grid.nx, grid.ny);
  MeshBuilder builder("grass");
  builder.use(MaterialId::grass_green);
  const auto field = [&](const Vector2d& from, const Vector2d& to) {
    const int nx = static_cast<int>(std::ceil((to - from).x() / cell_m));
    const int ny = static_cast<int>(std::ceil((to - from).y() / cell_m));
    std::vector<std::uint32_t> v;
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Vector2d p = from + (to - from).cwiseProduct(Vector2d(double(i) / nx, double(j) / ny));
        v.push_back(builder.vertex({p.x(), p.y(), ground.height_m(p.x(), p.y()) - step_m}));
      }
    }
    const auto at = [&](int i, int j) { return v[static_cast<std::size_t>(j * (nx + 1) + i)]; };
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) builder.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  };
  const double o = overlap_m;
  field({low.x() - reach_m, low.y() - reach_m}, {high.x() + reach_m, low.y() + o});
  field({low.x() - reach_m, low.y() + o}, {low.x() + o, high.y() + reach_m});
  field({high.x() - o, low.y() + o}, {high.x() + reach_m, high.y() + reach_m});
  field({low.x() + o, high.y() - o}, {high.x() - o, high.y() + reach_m});
  return std::move(builder).build();
}

void Painter::polygon(const std::vector<Vector2d>& convex_counter_clockwise) {
  const SlabGrid& grid = slabs_->grid();
  Vector2d low = convex_counter_clockwise.front(), high = low;
  for (const Vector2d& p : convex_counter_clockwise) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto cell = [&](double value, int axis, int count) {
    return std::clamp(static_cast<int>(std::floor((value - grid.origin_m[axis]) / grid.size_m)), 0, count - 1);
  };
  for (int j = cell(low.y(), 1, grid.ny); j <= cell(high.y(), 1, grid.ny); ++j) {
    for (int i = cell(low.x(), 0, grid.nx); i <= cell(high.x(), 0, grid.nx); ++i) {
      const Vector2d slab_low =
          grid.origin_m + grid.size_m * Vector2d(i, j) + Vector2d::Constant(grid.joint_width_m / 2);
      const Vector2d slab_high = slab_low + Vector2d::Constant(grid.size_m - grid.joint_width_m);
      std::vector<Vector2d> part = convex_counter_clockwise;
      for (int axis = 0; axis < 2 && !part.empty(); ++axis) {
        part = cut(part, axis, slab_low[axis], -1);
        part = cut(part, axis, slab_high[axis], 1);
      }
      std::vector<std::uint32_t> v;
      for (const Vector2d& p : part) {
        v.push_back(builder_.vertex({p.x(), p.y(), slabs_->height_m(i, j, p.x(), p.y()) + thickness_m_}));
      }
      for (std::size_t k = 2; k < part.size(); ++k) {
        if (area_m2(part[0], part[k - 1], part[k]) > 1e-6) builder_.triangle(v[0], v[k - 1], v[k]);
      }
    }
  }
}

void Painter::rectangle(const Vector2d& low, const Vector2d& high) {
  constexpr double piece_m = 1.25;
  const int nx = std::max(1, static_cast<int>(std::ceil((high - low).x() / piece_m)));
  const int ny = std::max(1, static_cast<int>(std::ceil((high - low).y() / piece_m)));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Vector2d size = (high - low).cwiseQuotient(Vector2d(nx, ny));
      const Vector2d a = low + size.cwiseProduct(Vector2d(i, j)), b = a + size;
      polygon({a, {b.x(), a.y()}, b, {a.x(), b.y()}});
    }
  }
}

void Painter::line(const std::vector<Vector2d>& points, double width_m) {
  constexpr double piece_m = 1.25;
  const auto left_of = [](const Vector2d& d) { return Vector2d(-d.y(), d.x()); };
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

void Painter::dashes(const Vector2d& from, const Vector2d& to, double width_m, double mark_m, double gap_m) {
  const double length = (to - from).norm();
  const Vector2d along = (to - from) / length;
  for (double s = 0; s + mark_m <= length; s += mark_m + gap_m)
    line({from + s * along, from + (s + mark_m) * along}, width_m);
}

}  // namespace tarmac::scenes
