/// Connected parts of a mesh: are they closed, and which way do they face?
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace tarmac::tests {

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

/// Each edge run once in each direction.
inline bool is_closed(const scenes::Mesh& mesh, const std::vector<std::size_t>& part) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::size_t t : part) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.emplace(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& e) { return edges.contains({e.second, e.first}); });
}

inline double volume_m3(const scenes::Mesh& mesh, const std::vector<std::size_t>& part) {
  const Eigen::Vector3d origin = mesh.vertices[mesh.triangles[part[0]][0]].cast<double>();
  double sum = 0;
  for (const std::size_t t : part) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.vertices[mesh.triangles[t][k]].cast<double>() - origin;
    };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return sum;
}

}  // namespace tarmac::tests
