/// Puts a scene together.
#pragma once

#include <utility>

#include "core/shortest_turn.h"
#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// Adds meshes once and instances of them, static ones or an actor's.
class Assembly {
 public:
  Assembly(Scene& scene, const Ground& ground) : scene_(&scene), ground_(&ground) {}

  std::uint32_t mesh(Mesh mesh) {
    scene_->meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(scene_->meshes.size() - 1);
  }
  template <class Build>
  std::uint32_t mesh(const char* name, const Build& build) {
    MeshBuilder b(name);
    build(b);
    return mesh(std::move(b).build());
  }
  void put(std::uint32_t mesh, Label label, const core::SE3& T_parent_mesh = core::SE3::Identity(), int actor = -1) {
    scene_->instances.push_back({mesh, label, actor, T_parent_mesh});
  }
  /// On the ground at x, y, upright along the ground's normal.
  void stand(std::uint32_t mesh, Label label, double x_m, double y_m, double yaw_rad) {
    Eigen::Vector2d gradient;
    const double z = ground_->height_m(x_m, y_m, &gradient);
    const Eigen::Vector3d up = Eigen::Vector3d(-gradient.x(), -gradient.y(), 1).normalized();
    core::SE3 T = place(x_m, y_m, z);
    T.linear() = core::shortest_turn(Eigen::Vector3d::UnitZ(), up).toRotationMatrix() *
                 Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    put(mesh, label, T);
  }
  /// On the ground at x, y, vertical.
  void found(std::uint32_t mesh, Label label, double x_m, double y_m, double yaw_rad) {
    put(mesh, label, place(x_m, y_m, ground_->height_m(x_m, y_m), yaw_rad));
  }

 private:
  Scene* scene_;
  const Ground* ground_;
};

}  // namespace tarmac::scenes
