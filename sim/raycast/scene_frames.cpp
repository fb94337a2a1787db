#include "sim/raycast/scene_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tarmac::sim::raycast {
namespace {

using core::InputError;

constexpr double interpolation_error_m = 0.2e-3;

void check_mesh(const scenes::Scene& scene, const scenes::Mesh& mesh) {
  if (mesh.materials.size() != mesh.triangles.size())
    throw InputError(fmt::format("scene {}: mesh {} has {} triangles and {} material indices; it needs one a triangle",
                                 scene.name, mesh.name, mesh.triangles.size(), mesh.materials.size()));
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size())
        throw InputError(fmt::format("scene {}: a triangle of mesh {} names vertex {} of {}", scene.name, mesh.name,
                                     vertex, mesh.vertices.size()));
  for (const std::uint16_t material : mesh.materials)
    if (material >= scene.materials.size())
      throw InputError(fmt::format("scene {}: mesh {} names material {} of {}", scene.name, mesh.name, material,
                                   scene.materials.size()));
}

}  // namespace

void check_references(const scenes::Scene& scene) {
  for (const scenes::Mesh& mesh : scene.meshes) check_mesh(scene, mesh);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scenes::Instance& instance = scene.instances[i];
    if (instance.mesh >= scene.meshes.size())
      throw InputError(
          fmt::format("scene {}: instance {} names mesh {} of {}", scene.name, i, instance.mesh, scene.meshes.size()));
    if (instance.actor >= static_cast<std::int32_t>(scene.actors.size()))
      throw InputError(fmt::format("scene {}: instance {} names actor {} of {}", scene.name, i, instance.actor,
                                   scene.actors.size()));
  }
  for (const scenes::Actor& actor : scene.actors)
    if (!actor.motion) throw InputError(fmt::format("scene {}: actor {} has no motion", scene.name, actor.name));
}

std::vector<TrianglePlane> planes_of(const scenes::Mesh& mesh) {
  std::vector<TrianglePlane> planes;
  planes.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d q = mesh.vertices[b].cast<double>(), r = mesh.vertices[c].cast<double>();
    const Eigen::Vector3d area = (q - p).cross(r - p);
    const double norm = area.norm();
    const Eigen::Vector3d normal = norm > 0 ? Eigen::Vector3d(area / norm) : Eigen::Vector3d::Zero();
    planes.push_back({normal, normal.dot((p + q + r) / 3)});
  }
  return planes;
}

int motion_steps(double acceleration_m_s2, core::Duration span) {
  const double T = core::to_s(span);
  const double intervals = std::ceil(T * std::sqrt(std::max(0.0, acceleration_m_s2) / (8 * interpolation_error_m)));
  return 1 + std::max(1, static_cast<int>(std::min(intervals, 1e6)));
}

}  // namespace tarmac::sim::raycast
