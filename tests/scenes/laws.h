/// What holds of every scene, whatever it shows. Each law is a function that adds failures; a scene's tests call them.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/files.h"
#include "scenes/registry.h"
#include "tests/scenes/support.h"

namespace tarmac::tests::laws {

inline core::ConfigNode node_of(const std::string& kind, const std::string& options = "") {
  return core::ConfigNode::parse("kind: " + kind + "\n" + options, "scenario.yaml");
}

/// Every byte that a sensor could see, as text.
inline std::string fingerprint(const scenes::Scene& scene) {
  std::string bytes;
  const auto add = [&bytes](const auto* data, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(data), count * sizeof(*data));
  };
  for (const scenes::Mesh& mesh : scene.meshes) {
    add(mesh.vertices.data(), mesh.vertices.size());
    add(mesh.triangles.data(), mesh.triangles.size());
    add(mesh.materials.data(), mesh.materials.size());
  }
  for (const scenes::Instance& i : scene.instances) {
    add(&i.mesh, 1);
    add(&i.label, 1);
    add(i.T_parent_mesh.matrix().data(), 16);
  }
  for (int k = 0; k < 100; ++k) {
    const double x = 0.31 * k - 15, y = 7.5 * k - 105;
    const double h[2] = {scene.ground->height_m(x, y), scene.relief ? scene.relief->height_m(x, y) : 0};
    add(h, 2);
  }
  return core::hash_hex(bytes);
}

inline void every_triangle_is_sound(const scenes::Scene& scene, double smallest_m2 = 2e-7) {
  for (const scenes::Mesh& mesh : scene.meshes) {
    ASSERT_FALSE(mesh.triangles.empty()) << mesh.name;
    ASSERT_EQ(mesh.materials.size(), mesh.triangles.size()) << mesh.name;
    double smallest = 1e9;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      ASSERT_LT(mesh.materials[t], scene.materials.size()) << mesh.name;
      Eigen::Vector3d p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(mesh.triangles[t][k], mesh.vertices.size()) << mesh.name;
        p[k] = mesh.vertices[mesh.triangles[t][k]].cast<double>();
        ASSERT_TRUE(p[k].allFinite()) << mesh.name;
      }
      smallest = std::min(smallest, 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm());
    }
    EXPECT_GT(smallest, smallest_m2) << mesh.name << " [m^2]";
  }
}

inline void instances_are_sound(const scenes::Scene& scene) {
  std::set<std::uint32_t> used;
  for (const scenes::Instance& i : scene.instances) {
    ASSERT_LT(i.mesh, scene.meshes.size());
    ASSERT_LT(i.actor, static_cast<int>(scene.actors.size()));
    EXPECT_NE(i.label, scenes::Label::none) << scene.meshes[i.mesh].name;
    EXPECT_TRUE(core::se3::all_finite(i.T_parent_mesh)) << scene.meshes[i.mesh].name;
    used.insert(i.mesh);
  }
  EXPECT_EQ(used.size(), scene.meshes.size()) << "a mesh that nothing shows";
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

/// Ground and paint, panes and leaves are open; all the rest is closed and faces outward.
inline void solids_are_closed_and_face_outward(const scenes::Scene& scene) {
  std::set<std::uint32_t> ground_meshes;
  for (const scenes::Instance& i : scene.instances) {
    if (on_the_ground(i.label)) ground_meshes.insert(i.mesh);
  }
  std::size_t closed = 0;
  for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
    if (ground_meshes.contains(m)) continue;
    const scenes::Mesh& mesh = scene.meshes[m];
    for (const auto& part : parts_of(mesh)) {
      if (is_closed(mesh, part)) {
        ++closed;
        ASSERT_GT(volume_m3(mesh, part), 0) << mesh.name;
      } else {
        const scenes::Material& material = scene.materials[mesh.materials[part[0]]];
        ASSERT_TRUE(material.transmission > 0 || material.name == "foliage")
            << mesh.name << " has an open part of " << material.name;
      }
    }
  }
  EXPECT_GT(closed, 20u);
}

inline void ground_faces_up(const scenes::Scene& scene) {
  for_each_static_triangle(
      scene, [](const scenes::Instance& i) { return on_the_ground(i.label); },
      [&](const scenes::Instance& i, const Triangle& t) {
        // A kerb's face may stand nearly upright; nothing lies upside down.
        ASSERT_GT((t[1] - t[0]).cross(t[2] - t[0]).normalized().z(), 0.0) << scene.meshes[i.mesh].name;
      });
}

inline void seed_decides_the_bytes(const std::string& kind) {
  const std::string first = fingerprint(scenes::make_scene(node_of(kind), 1));
  EXPECT_EQ(first, fingerprint(scenes::make_scene(node_of(kind), 1)));
  EXPECT_NE(first, fingerprint(scenes::make_scene(node_of(kind), 2)));
}

/// `other` holds a value for every option of the kind that is unlike its default and that in `small`, the options that
/// keep the scene small here.
inline void every_option_changes_the_scene(const std::string& kind, const std::map<std::string, std::string>& other,
                                           const std::map<std::string, std::string>& small = {}) {
  const auto made = [&](const std::map<std::string, std::string>& options) {
    std::string yaml;
    for (const auto& [name, value] : options) yaml += name + ": " + value + "\n";
    return fingerprint(scenes::make_scene(node_of(kind, yaml), 1));
  };
  const std::string plain = made(small);
  for (const core::OptionDescription& option : scenes::scene_of(node_of(kind)).describe()) {
    ASSERT_TRUE(other.contains(option.name)) << option.name << " is not tested";
    std::map<std::string, std::string> options = small;
    options[option.name] = other.at(option.name);
    EXPECT_NE(plain, made(options)) << option.name;
  }
}

inline void resolved_options_make_the_same_scene(const std::string& kind, const std::string& options) {
  const core::ConfigNode node = node_of(kind, options);
  const auto again = core::ConfigNode::parse("scene:\n" + scenes::resolve_scene(node), "resolved.yaml");
  EXPECT_EQ(fingerprint(scenes::make_scene(node, 4)), fingerprint(scenes::make_scene(again.child("scene"), 4)));
}

inline void ground_alone_is_the_scenes_ground(const std::string& kind, const scenes::Scene& scene) {
  const auto ground = scenes::make_ground(node_of(kind), 1);
  for (const double x : {-50.0, 0.0, 31.7}) {
    EXPECT_EQ(ground->height_m(x, -12), scene.ground->height_m(x, -12));
  }
}

/// Lowest point of each instance that `accept`s, above the ground right under it: within [low, high].
template <class Accept>
std::size_t stands_on_the_ground(const scenes::Scene& scene, const Accept& accept, double low_m, double high_m,
                                 double lift_m = 0) {
  std::size_t tested = 0;
  for (const scenes::Instance& instance : scene.instances) {
    if (instance.actor >= 0 || !accept(instance)) continue;
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    double gap = 1e9;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      const Eigen::Vector3d p = instance.T_parent_mesh * v.cast<double>();
      gap = std::min(gap, p.z() - scene.ground->height_m(p.x(), p.y()) - lift_m);
    }
    ++tested;
    EXPECT_GE(gap, low_m) << mesh.name << " sinks at " << instance.T_parent_mesh.translation().transpose();
    EXPECT_LE(gap, high_m) << mesh.name << " floats at " << instance.T_parent_mesh.translation().transpose();
  }
  return tested;
}

/// The static thing nearest to a line between 0.15 and 2.6 m above the ground (at most `reach_m` away).
inline double clearance_m(const scenes::Scene& scene, const std::vector<Eigen::Vector2d>& line, double reach_m,
                          std::string* what = nullptr) {
  double nearest = reach_m;
  for_each_static_triangle(
      scene, [](const scenes::Instance& i) { return !on_the_ground(i.label); },
      [&](const scenes::Instance& instance, const Triangle& t) {
        const std::vector<Eigen::Vector2d> outline = outline_between(t, *scene.ground, 0.15, 2.6);
        if (outline.empty()) return;
        double size = 0;
        for (const Eigen::Vector2d& p : outline) size = std::max(size, (p - outline[0]).norm());
        for (const Eigen::Vector2d& p : line) {
          if ((p - outline[0]).norm() - size > nearest) continue;
          const double distance = distance_to_outline(p, outline);
          if (distance < nearest && what) *what = scene.meshes[instance.mesh].name;
          nearest = std::min(nearest, distance);
        }
      });
  return nearest;
}

}  // namespace tarmac::tests::laws
