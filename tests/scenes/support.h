/// Scenes to test, and their triangles in world coordinates.
#pragma once

#include <algorithm>
#include <array>
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

inline bool on_the_ground(scenes::Label label) {
  return label == scenes::Label::pavement || label == scenes::Label::marking ||
         label == scenes::Label::vegetation || label == scenes::Label::terrain;
}

/// The part of a triangle between two heights above the ground, as a polygon seen from above (empty: none).
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
