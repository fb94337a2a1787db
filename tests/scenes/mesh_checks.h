/// Facts about meshes: extent, connected parts, closedness, first triangle along a ray.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include "scenes/scene.h"

namespace tarmac::tests {

using Eigen::Vector3d;

struct Extent {
  Vector3d low = Vector3d::Constant(1e9), high = Vector3d::Constant(-1e9);
  void add(const Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Vector3d middle() const { return (low + high) / 2; }
  Vector3d size() const { return high - low; }
};

/// Of the vertices that triangles use.
inline Extent extent_of(const scenes::Mesh& mesh) {
  Extent extent;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) extent.add(mesh.vertices[v].cast<double>());
  }
  return extent;
}

/// Triangles grouped by the vertices that they share: the primitives a mesh was built from.
inline std::vector<std::vector<std::size_t>> parts_of(const scenes::Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  std::map<std::uint32_t, std::vector<std::size_t>> parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) parts[root(mesh.triangles[t][0])].push_back(t);
  std::vector<std::vector<std::size_t>> list;
  for (auto& [vertex, triangles] : parts) list.push_back(std::move(triangles));
  return list;
}

struct PartFacts {
  bool closed = true;  ///< every edge is used once in each direction
  double volume_m3 = 0, smallest_triangle_m2 = 1e9;
  Vector3d middle = Vector3d::Zero();
};

inline PartFacts facts_of(const scenes::Mesh& mesh, const std::vector<std::size_t>& part) {
  PartFacts facts;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  Extent extent;
  const auto corner = [&](std::size_t t, std::size_t k) -> Vector3d {
    return mesh.vertices[mesh.triangles[t][k]].cast<double>();
  };
  const Vector3d origin = corner(part.front(), 0);
  for (const std::size_t t : part) {
    const Vector3d a = corner(t, 0) - origin, b = corner(t, 1) - origin, c = corner(t, 2) - origin;
    facts.volume_m3 += a.dot(b.cross(c)) / 6;
    facts.smallest_triangle_m2 = std::min(facts.smallest_triangle_m2, 0.5 * (b - a).cross(c - a).norm());
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}];
      extent.add(corner(t, k));
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end()) facts.closed = false;
  }
  facts.middle = extent.middle();
  return facts;
}

struct Hit {
  double distance_m = std::numeric_limits<double>::infinity();
  std::uint16_t material = 0;
};

/// Möller and Trumbore 1997, over all triangles, from either side.
inline Hit first_hit(const scenes::Mesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  Hit hit;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vector3d a = mesh.vertices[i].cast<double>();
    const Vector3d e1 = mesh.vertices[j].cast<double>() - a, e2 = mesh.vertices[k].cast<double>() - a;
    const Vector3d p = direction.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-14) continue;
    const Vector3d s = origin - a, q = s.cross(e1);
    const double u = s.dot(p) / det, v = direction.dot(q) / det, range = e2.dot(q) / det;
    if (u < 0 || v < 0 || u + v > 1 || range <= 1e-9 || range >= hit.distance_m) continue;
    hit = {range, mesh.materials[t]};
  }
  return hit;
}

}  // namespace tarmac::tests
