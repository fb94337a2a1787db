#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.h"
#include "scenes/outdoors/outdoors.h"

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Draws of one shape, one after the other.
class Draws {
 public:
  Draws(std::uint64_t seed, const char* name, int number)
      : random_(seed, name), base_(static_cast<std::uint64_t>(number) << 20) {}
  double uniform() { return random_.uniform(base_ + next_++); }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  Vector3d direction() {
    const double z = between(-1, 1), a = tau * uniform(), r = std::sqrt(1 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
  }

 private:
  core::RandomStream random_;
  std::uint64_t base_, next_ = 0;
};

/// A cluster of leaves: a quad with its middle at p, facing anywhere.
void add_leaf(MeshBuilder& b, const Vector3d& p, const Vector3d& normal, double turn_rad, double size_m) {
  const Vector3d u0 = normal.unitOrthogonal(), v0 = normal.cross(u0);
  const Vector3d u = 0.5 * size_m * (std::cos(turn_rad) * u0 + std::sin(turn_rad) * v0);
  const Vector3d v = 0.35 * size_m * (std::cos(turn_rad) * v0 - std::sin(turn_rad) * u0);
  b.quad(b.vertex(p - u - v), b.vertex(p + u - v), b.vertex(p + u + v), b.vertex(p - u + v));
}

/// A place in the crown; denser towards its skin, where the light is.
Vector3d crown_place(const TreeShape& s, Draws& draws) {
  if (s.conifer) {
    const double t = 1 - std::sqrt(draws.uniform()), a = tau * draws.uniform();  // more of them where the cone is wide
    const double r = s.crown_radius_m * (1 - t) * draws.between(0.35, 1);
    return {r * std::cos(a), r * std::sin(a), s.crown_from_m + t * (s.height_m - s.crown_from_m)};
  }
  const double half = (s.height_m - s.crown_from_m) / 2;
  const Vector3d towards = draws.direction();
  const Vector3d d = towards * std::cbrt(draws.between(0.25, 1));
  return {s.crown_radius_m * d.x(), s.crown_radius_m * d.y(), s.crown_from_m + half * (1 + d.z())};
}

}  // namespace

void add_tree(MeshBuilder& b, const TreeShape& s, std::uint64_t seed, int number) {
  Draws draws(seed, "scenes/outdoors/tree", number);
  const double fork = s.conifer ? 0.92 * s.height_m : s.crown_from_m + 0.25 * (s.height_m - s.crown_from_m);
  b.use(bark);
  add_frustum(b, {0, 0, -0.3}, {0, 0, fork}, 1.15 * s.trunk_radius_m, (s.conifer ? 0.15 : 0.6) * s.trunk_radius_m, 12);
  const int branches = s.conifer ? 0 : 5;
  for (int k = 0; k < branches; ++k) {
    const double a = tau * (k + draws.between(-0.2, 0.2)) / branches;
    const Vector3d tip(0.7 * s.crown_radius_m * std::cos(a), 0.7 * s.crown_radius_m * std::sin(a),
                       draws.between(0.6, 0.9) * s.height_m);
    const Vector3d foot(0, 0, fork - draws.between(0.1, 0.5));
    add_bar(b, {foot, 0.5 * (foot + tip) + Vector3d(0, 0, 0.15), tip}, 0.28 * s.trunk_radius_m, 6);
  }
  b.use(foliage);
  for (int k = 0; k < s.leaves; ++k) {
    const Vector3d p = crown_place(s, draws);
    const Vector3d facing = draws.direction();  // one after the other: arguments have no order
    const double turn = draws.uniform(), size = draws.between(0.7, 1.3);
    add_leaf(b, p, facing, tau * turn, s.leaf_m * size);
  }
}

namespace {

/// Middles of edges, each once.
class Middles {
 public:
  explicit Middles(std::vector<Vector3d>& points) : points_(&points) {}
  std::size_t of(std::size_t i, std::size_t j) {
    const auto key = std::minmax(i, j);
    const auto [found, added] = known_.try_emplace({key.first, key.second}, points_->size());
    if (added) points_->push_back(((*points_)[i] + (*points_)[j]).normalized());
    return found->second;
  }

 private:
  std::vector<Vector3d>* points_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> known_;
};

}  // namespace

void add_rock(MeshBuilder& b, double radius_m, std::uint64_t seed, int number) {
  Draws draws(seed, "scenes/outdoors/rock", number);
  std::vector<Vector3d> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<std::size_t, 3>> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < 3; ++level) {
    Middles middles(points);
    std::vector<std::array<std::size_t, 3>> finer;
    for (const auto& [i, j, k] : faces) {
      const std::size_t ij = middles.of(i, j), jk = middles.of(j, k), ki = middles.of(k, i);
      finer.insert(finer.end(), {{i, ij, ki}, {ij, j, jk}, {ki, jk, k}, {ij, jk, ki}});
    }
    faces = std::move(finer);
  }
  struct Wave {
    Vector3d k;
    double phase_rad, amplitude;
  };
  std::vector<Wave> waves;
  for (int n = 0; n < 6; ++n) {
    const double number_of = 1.5 + 1.2 * n;
    waves.push_back({number_of * draws.direction(), tau * draws.uniform(), 0.22 / (1 + n)});
  }
  const Vector3d stretch{draws.between(0.8, 1.3), draws.between(0.7, 1.1), draws.between(0.55, 0.95)};
  b.use(rock);
  const std::size_t first = b.triangle_count();
  std::vector<std::uint32_t> v;
  for (const Vector3d& p : points) {
    double r = 1;
    for (const Wave& w : waves) r += w.amplitude * std::sin(w.k.dot(p) + w.phase_rad);
    v.push_back(b.vertex(radius_m * (r * p.cwiseProduct(stretch) + Vector3d(0, 0, 0.3))));
  }
  for (const auto& [i, j, k] : faces) b.triangle(v[i], v[j], v[k]);
  b.orient_outward(first);
}

}  // namespace tarmac::scenes
