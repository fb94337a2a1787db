/// Scenes by the text of their block, and every byte that a sensor could see of one.
#pragma once

#include <string>

#include "core/config.h"
#include "core/files.h"
#include "scenes/registry.h"

namespace tarmac::tests {

inline core::ConfigNode node(const std::string& yaml) {
  return core::ConfigNode::parse(yaml, "scenario.yaml");
}

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
    add(i.T_parent_mesh.matrix().data(), 16);
  }
  for (int k = 0; k < 100; ++k) {
    const double h = scene.relief->height_m(0.31 * k - 15, 0.27 * k);
    add(&h, 1);
  }
  return core::hash_hex(bytes);
}

}  // namespace tarmac::tests
