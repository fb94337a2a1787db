#include "scenes/hills/ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

constexpr double tau = 2 * std::numbers::pi;
constexpr int kWaves = 48;
constexpr double kInner_m = 64, kFine_m = 0.5, kCoarse_m = 2, kTrackHalf_m = 2;

}  // namespace

HillyGround::HillyGround(const HillsOptions& options, std::uint64_t seed) {
  const core::RandomStream random(seed, "scenes/hills/ground");
  // Waves in every octave; those of one octave share its amplitude as independent sines do.
  const double octaves = std::log2(options.longest_m / options.shortest_m);
  const double share = std::sqrt(octaves / kWaves);
  for (int k = 0; k < kWaves; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const double length_m = options.longest_m * std::pow(options.shortest_m / options.longest_m, (k + 0.5) / kWaves);
    const double amplitude = options.relief_m * std::pow(length_m / options.longest_m, 1.4 / options.roughness) * share;
    const double direction = tau * random.uniform(i, 0), wave_number = tau / length_m;
    waves_.push_back(
        {amplitude, wave_number * std::cos(direction), wave_number * std::sin(direction), tau * random.uniform(i, 1)});
  }
  zero_m_ = height_m(0, 0);
}

double HillyGround::height_m(double x_m, double y_m, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const {
  double height = -zero_m_;
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  for (const Wave& w : waves_) {
    const double phase = w.kx_per_m * x_m + w.ky_per_m * y_m + w.phase_rad;
    const double s = w.amplitude_m * std::sin(phase);
    height += s;
    if (gradient) g += w.amplitude_m * std::cos(phase) * Eigen::Vector2d(w.kx_per_m, w.ky_per_m);
    if (hessian) h -= s * Eigen::Vector3d(w.kx_per_m * w.kx_per_m, w.kx_per_m * w.ky_per_m, w.ky_per_m * w.ky_per_m);
  }
  if (gradient) *gradient = g;
  if (hessian) *hessian = h;
  return height;
}

std::vector<Vector2d> hills_track() {
  // Straights of 30 m along x, half circles of 20 m: what a drive's path of two straights and two half turns covers.
  constexpr double half_m = 15, radius_m = 20;
  std::vector<Vector2d> points;
  for (double x = -half_m; x < half_m; x += 1) points.emplace_back(x, -radius_m);
  for (int k = 0; k < 64; ++k) {
    const double a = -0.25 * tau + 0.5 * tau * k / 64;
    points.emplace_back(half_m + radius_m * std::cos(a), radius_m * std::sin(a));
  }
  for (double x = half_m; x > -half_m; x -= 1) points.emplace_back(x, radius_m);
  for (int k = 0; k < 64; ++k) {
    const double a = 0.25 * tau + 0.5 * tau * k / 64;
    points.emplace_back(-half_m + radius_m * std::cos(a), radius_m * std::sin(a));
  }
  return points;
}

double distance_m(const Vector2d& p, const std::vector<Vector2d>& track) {
  double nearest = 1e9;
  for (const Vector2d& q : track) nearest = std::min(nearest, (p - q).norm());
  return nearest;
}

namespace {

/// Vertices by their place on the fine grid, made when first asked for.
class GridVertices {
 public:
  GridVertices(MeshBuilder& b, const Ground& ground, int half_cells)
      : b_(&b),
        ground_(&ground),
        half_(half_cells),
        known_(static_cast<std::size_t>(2 * half_cells + 1) * (2 * half_cells + 1), kNone) {}
  std::uint32_t at(int i, int j) {
    std::uint32_t& v =
        known_[static_cast<std::size_t>(j + half_) * (2 * half_ + 1) + static_cast<std::size_t>(i + half_)];
    if (v == kNone) {
      const double x = i * kFine_m, y = j * kFine_m;
      v = b_->vertex({x, y, ground_->height_m(x, y)});
    }
    return v;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  MeshBuilder* b_;
  const Ground* ground_;
  int half_;
  std::vector<std::uint32_t> known_;
};

/// A coarse cell from (i, j); an edge on the fine part's border has the fine vertices too, and the cell is a fan.
void add_coarse_cell(MeshBuilder& b, GridVertices& grid, int i, int j, int n, int inner) {
  struct Corner {
    int i, j;
  };
  const Corner corner[4] = {{i, j}, {i + n, j}, {i + n, j + n}, {i, j + n}};
  const auto on_border = [&](const Corner& p, const Corner& q) {
    const bool upright = p.i == q.i && std::abs(p.i) == inner && std::max(std::abs(p.j), std::abs(q.j)) <= inner;
    const bool level = p.j == q.j && std::abs(p.j) == inner && std::max(std::abs(p.i), std::abs(q.i)) <= inner;
    return upright || level;
  };
  for (int k = 0; k < 4; ++k) {
    const Corner &p = corner[k], &q = corner[(k + 1) % 4], &far = corner[(k + 2) % 4], &last = corner[(k + 3) % 4];
    if (!on_border(p, q)) continue;
    const std::uint32_t apex = grid.at(far.i, far.j);
    for (int step = 0; step < n; ++step) {
      const auto along = [&](int a, int e, int s) { return a + (e - a) / n * s; };
      b.triangle(apex, grid.at(along(p.i, q.i, step), along(p.j, q.j, step)),
                 grid.at(along(p.i, q.i, step + 1), along(p.j, q.j, step + 1)));
    }
    b.triangle(apex, grid.at(last.i, last.j), grid.at(p.i, p.j));
    return;
  }
  const int first = ((i + j) / n) % 2 == 0 ? 0 : 1;
  const auto v = [&](int k) { return grid.at(corner[(first + k) % 4].i, corner[(first + k) % 4].j); };
  b.quad(v(0), v(1), v(2), v(3));
}

}  // namespace

Mesh make_hills_mesh(const Ground& ground, double half_size_m) {
  constexpr int n = static_cast<int>(kCoarse_m / kFine_m), inner = static_cast<int>(kInner_m / kFine_m);
  const int half = static_cast<int>(std::ceil(half_size_m / kCoarse_m)) * n;
  const std::vector<Vector2d> track = hills_track();
  const auto worn = [&](int i, int j) {
    return distance_m({(i + 0.5) * kFine_m, (j + 0.5) * kFine_m}, track) < kTrackHalf_m;
  };
  MeshBuilder b("hills");
  GridVertices grid(b, ground, half);
  for (int j = -inner; j < inner; ++j) {
    for (int i = -inner; i < inner; ++i) {
      b.use(worn(i, j) ? MaterialId::soil : MaterialId::meadow);
      if ((i + j) % 2 == 0) {
        b.quad(grid.at(i, j), grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1));
      } else {
        b.quad(grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1), grid.at(i, j));
      }
    }
  }
  b.use(MaterialId::meadow);
  for (int j = -half; j < half; j += n) {
    for (int i = -half; i < half; i += n) {
      const bool inside = i >= -inner && i < inner && j >= -inner && j < inner;
      if (!inside) add_coarse_cell(b, grid, i, j, n, inner);
    }
  }
  return std::move(b).build();
}

}  // namespace tarmac::scenes
