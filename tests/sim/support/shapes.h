/// Meshes with a closed form, and scenes made of them.
#pragma once

#include <cmath>
#include <string>

#include "scenes/scene.h"

namespace tarmac::tests {

using scenes::Mesh;

inline void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
  mesh.materials.resize(mesh.triangles.size(), 0);
}

/// n x n quads over [-half, half]^2 in the plane z = 0, seen from above.
inline Mesh square(double half_m, int n = 8, std::uint16_t material = 0) {
  Mesh mesh{.name = "square", .vertices = {}, .triangles = {}, .materials = {}};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.vertices.push_back(Eigen::Vector3d(half_m * (2.0 * i / n - 1), half_m * (2.0 * j / n - 1), 0).cast<float>());
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  mesh.materials.assign(mesh.triangles.size(), material);
  return mesh;
}

/// Rows of quads round the z axis; vertex (i, j) is p(i / rows, angle j).
template <class Point>
Mesh revolved(const std::string& name, int rows, int columns, const Point& point) {
  Mesh mesh{.name = name, .vertices = {}, .triangles = {}, .materials = {}};
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j)
      mesh.vertices.push_back(
          Eigen::Vector3d(point(static_cast<double>(i) / rows, 2 * M_PI * j / columns)).template cast<float>());
  const auto at = [columns](int i, int j) { return static_cast<std::uint32_t>(i * columns + j % columns); };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  return mesh;
}

inline Mesh sphere(double radius_m, int rows, int columns) {
  return revolved("sphere", rows, columns, [&](double u, double angle) -> Eigen::Vector3d {
    const double polar = M_PI * (u - 0.5);
    return radius_m *
           Eigen::Vector3d(std::cos(polar) * std::cos(angle), std::cos(polar) * std::sin(angle), std::sin(polar));
  });
}

/// About z, from -half_height to half_height, open at both ends.
inline Mesh cylinder(double radius_m, double half_height_m, int rows, int columns) {
  return revolved("cylinder", rows, columns, [&](double u, double angle) -> Eigen::Vector3d {
    return Eigen::Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), half_height_m * (2 * u - 1));
  });
}

/// An axis-aligned box about the origin, seen from outside.
inline Mesh box(const Eigen::Vector3d& half_m) {
  Mesh mesh{.name = "box", .vertices = {}, .triangles = {}, .materials = {}};
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(Eigen::Vector3d(k & 1 ? half_m.x() : -half_m.x(), k & 2 ? half_m.y() : -half_m.y(),
                                            k & 4 ? half_m.z() : -half_m.z())
                                .cast<float>());
  add_quad(mesh, 0, 2, 3, 1);
  add_quad(mesh, 4, 5, 7, 6);
  add_quad(mesh, 0, 1, 5, 4);
  add_quad(mesh, 2, 6, 7, 3);
  add_quad(mesh, 0, 4, 6, 2);
  add_quad(mesh, 1, 3, 7, 5);
  return mesh;
}

inline scenes::Material grey(double diffuse = 0.5) {
  scenes::Material material;
  material.name = "grey";
  material.diffuse = diffuse;
  return material;
}

/// A scene with one grey material; add_* give it content.
inline scenes::Scene empty_scene() {
  scenes::Scene scene;
  scene.name = "test";
  scene.materials.push_back(grey());
  return scene;
}

inline std::uint32_t add_instance(scenes::Scene& scene, Mesh mesh, const core::SE3& T_parent_mesh,
                                  std::int32_t actor = -1, scenes::Label label = scenes::Label::other) {
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size() - 1), label, actor, T_parent_mesh});
  return static_cast<std::uint32_t>(scene.instances.size() - 1);
}

inline std::int32_t add_actor(scenes::Scene& scene, std::shared_ptr<const scenes::ActorMotion> motion,
                              double radius_m) {
  scene.actors.push_back({"actor", std::move(motion), radius_m});
  return static_cast<std::int32_t>(scene.actors.size() - 1);
}

inline core::SE3 pose(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rotation_rad = Eigen::Vector3d::Zero()) {
  core::SE3 T = core::SE3::Identity();
  T.linear() = core::so3::exp(rotation_rad);
  T.translation() = xyz_m;
  return T;
}

/// Crossed sine waves, as steep as given: 3 mm and 5 cm are rough concrete.
class SineRelief final : public scenes::Relief {
 public:
  double amplitude_m = 1.5e-3, wavelength_m = 0.25;
  double height_m(double x, double y, Eigen::Vector2d* gradient = nullptr) const override {
    const double k = 2 * M_PI / wavelength_m;
    if (gradient) *gradient = amplitude_m * k * Eigen::Vector2d(std::cos(k * x), -std::sin(0.7 * k * y) * 0.7);
    return amplitude_m * (std::sin(k * x) + std::cos(0.7 * k * y));
  }
};

}  // namespace tarmac::tests
