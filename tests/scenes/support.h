/// Scenes to test, and their triangles in world coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scenes/registry.h"
#include "scenes/scene.h"
#include "scenes/stand/options.h"

namespace tarmac::tests {

inline core::ConfigNode scene_node(const std::string& options = "") {
  return core::ConfigNode::parse("kind: stand\n" + options, "scenario.yaml");
}

/// The stand with its defaults and seed 1, built once.
inline const scenes::Scene& default_stand() {
  static const scenes::Scene scene = scenes::make_scene(scene_node(), 1);
  return scene;
}

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Calls f(instance, triangle in the world) for static instances that `accept`s.
template <class Accept, class F>
void for_each_static_triangle(const scenes::Scene& scene, const Accept& accept, const F& f) {
  for (const scenes::Instance& instance : scene.instances) {
    if (instance.actor >= 0 || !accept(instance)) continue;
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<Eigen::Vector3d> world;
    for (const Eigen::Vector3f& p : mesh.vertices) world.push_back(instance.T_parent_mesh * p.cast<double>());
    for (const auto& [a, b, c] : mesh.triangles) f(instance, Triangle{world[a], world[b], world[c]});
  }
}

inline bool follows_ground(scenes::Label label) {
  return label == scenes::Label::pavement || label == scenes::Label::marking || label == scenes::Label::terrain;
}
inline bool on_the_ground(scenes::Label label) {
  return label == scenes::Label::pavement || label == scenes::Label::marking || label == scenes::Label::vegetation ||
         label == scenes::Label::terrain;
}

/// The part of a triangle between two heights above the ground, as a polygon seen from above (empty: none). The ground
/// below it counts as a plane through its heights below the corners: see for_each_outline_between.
inline std::vector<Eigen::Vector2d> outline_between(const Triangle& triangle, const scenes::Ground& ground,
                                                    double low_m, double high_m) {
  std::vector<Eigen::Vector3d> polygon;
  for (const Eigen::Vector3d& p : triangle) polygon.emplace_back(p.x(), p.y(), p.z() - ground.height_m(p.x(), p.y()));
  for (const auto& [limit, sign] : {std::pair{low_m, -1.0}, {high_m, 1.0}}) {
    std::vector<Eigen::Vector3d> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Eigen::Vector3d &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double dp = sign * (p.z() - limit), dq = sign * (q.z() - limit);
      if (dp <= 0) kept.push_back(p);
      if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    polygon = std::move(kept);
  }
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector3d& p : polygon) outline.emplace_back(p.x(), p.y());
  return outline;
}

/// Calls f(outline) for the parts of a triangle between two heights above the ground, whatever the ground does below
/// it. A roof over a sunken road may have all its corners above the land beside the road: where the ground below
/// differs from a plane by more than 2 cm, the triangle is halved until it does not, or is shorter than 0.25 m; so no
/// part lies farther than that from where it belongs.
template <class F>
void for_each_outline_between(const Triangle& triangle, const scenes::Ground& ground, double low_m, double high_m,
                              const F& f) {
  constexpr double flat_m = 0.02, small_m = 0.25;
  std::size_t longest = 0;
  const auto length_m = [&](std::size_t k) { return (triangle[(k + 1) % 3] - triangle[k]).head<2>().norm(); };
  for (const std::size_t k : {1, 2}) longest = length_m(k) > length_m(longest) ? k : longest;
  const auto height_m = [&](const Eigen::Vector3d& p) { return ground.height_m(p.x(), p.y()); };
  bool is_flat = length_m(longest) < small_m;
  if (!is_flat) {
    const std::array<double, 3> h{height_m(triangle[0]), height_m(triangle[1]), height_m(triangle[2])};
    is_flat = std::abs(height_m((triangle[0] + triangle[1] + triangle[2]) / 3) - (h[0] + h[1] + h[2]) / 3) < flat_m;
    for (std::size_t k = 0; k < 3 && is_flat; ++k) {
      const std::size_t next = (k + 1) % 3;
      is_flat = std::abs(height_m((triangle[k] + triangle[next]) / 2) - (h[k] + h[next]) / 2) < flat_m;
    }
  }
  if (is_flat) {
    const std::vector<Eigen::Vector2d> outline = outline_between(triangle, ground, low_m, high_m);
    if (!outline.empty()) f(outline);
    return;
  }
  const Eigen::Vector3d &a = triangle[longest], &b = triangle[(longest + 1) % 3], &c = triangle[(longest + 2) % 3];
  const Eigen::Vector3d middle = (a + b) / 2;
  for_each_outline_between({a, middle, c}, ground, low_m, high_m, f);
  for_each_outline_between({middle, b, c}, ground, low_m, high_m, f);
}

inline double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double s = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
  return (p - a - s * d).norm();
}

/// Distance in the plane from p to a convex polygon; 0 inside.
inline double distance_to_outline(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& outline) {
  double nearest = 1e9;
  int left = 0, right = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d &a = outline[k], &b = outline[(k + 1) % outline.size()];
    nearest = std::min(nearest, distance_to_segment(p, a, b));
    const double cross = (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x();
    if (cross > 1e-12) ++left;
    if (cross < -1e-12) ++right;
  }
  return (left > 0) != (right > 0) ? 0 : nearest;
}

}  // namespace tarmac::tests
