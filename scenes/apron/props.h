/// Things that are shown many times: each mesh is built and added to the scene when it is first put somewhere.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenes/apron/stand_frame.h"
#include "scenes/assembly.h"

namespace tarmac::scenes {

class Props {
 public:
  using Build = std::function<void(MeshBuilder&)>;
  explicit Props(Assembly& assembly) : assembly_(&assembly) {}

  /// On the ground, upright along its normal. `name` is the mesh's; the same name is the same mesh.
  void stand(const std::string& name, Label label, const Build& build, double x_m, double y_m, double yaw_rad) {
    assembly_->stand(mesh(name, build), label, x_m, y_m, yaw_rad);
  }
  /// The same in a stand's frame.
  void stand(const std::string& name, Label label, const Build& build, const StandFrame& frame, double x_m, double y_m,
             double yaw_rad) {
    const Eigen::Vector2d p = frame.world(x_m, y_m);
    stand(name, label, build, p.x(), p.y(), frame.world_yaw_rad(yaw_rad));
  }
  /// Vertical: what has a foundation.
  void found(const std::string& name, Label label, const Build& build, double x_m, double y_m, double yaw_rad) {
    assembly_->found(mesh(name, build), label, x_m, y_m, yaw_rad);
  }
  /// A mesh that is made elsewhere, on the ground in a stand's frame.
  void stand_mesh(const std::string& name, Label label, const std::function<Mesh()>& make, const StandFrame& frame,
                  double x_m, double y_m, double yaw_rad) {
    const Eigen::Vector2d p = frame.world(x_m, y_m);
    assembly_->stand(id(name, make), label, p.x(), p.y(), frame.world_yaw_rad(yaw_rad));
  }
  void put(const std::string& name, Label label, const std::function<Mesh()>& make, const core::SE3& T_world_mesh) {
    assembly_->put(id(name, make), label, T_world_mesh);
  }

 private:
  std::uint32_t id(const std::string& name, const std::function<Mesh()>& make) {
    const auto found = meshes_.find(name);
    return found != meshes_.end() ? found->second : meshes_[name] = assembly_->mesh(make());
  }
  std::uint32_t mesh(const std::string& name, const Build& build) {
    return id(name, [&] {
      MeshBuilder b(name);
      build(b);
      return std::move(b).build();
    });
  }
  Assembly* assembly_;
  std::map<std::string, std::uint32_t> meshes_;
};

}  // namespace tarmac::scenes
