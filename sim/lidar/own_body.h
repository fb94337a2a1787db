/// The vehicle that the sensor stands on, as far as the sensor sees it: `rig.body:`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/lie.h"
#include "core/options.h"
#include "scenes/scene.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {

/// Body frame: x forward, y left, z up, origin on the ground under the rear axle.
struct BodyOptions {
  std::string kind = "none";  ///< or "box", or a name of scenes/equipment
  double length_m = 4.6, width_m = 1.9, height_m = 1.8, rear_overhang_m = 0.9;
  /// The scenario gives the sizes. Without: a box has the ones above, equipment has its own, and `none` has that of
  /// what the motion carries (truth::body_box).
  bool sized = false;
  void visit(core::OptionVisitor& v);
  bool any() const { return kind != "none"; }
};
/// What `kind` may be.
std::vector<std::string> body_kinds();
/// What BodyOptions::sized is for the block `node`; an InputError where a size stands beside equipment.
bool gives_size(const core::ConfigNode& node);
/// Throws InputError at `node` (the block) for a kind that is none, or where the sensor would stand inside the body.
void check_body(const core::ConfigNode& node, const BodyOptions& options, const core::SE3& T_body_lidar);
/// The body as triangles of the body frame: a box from the rear overhang forward, its underside 0.3 m above the ground;
/// equipment with its rear at the rear overhang. Materials are those of scenes/materials.
scenes::Mesh body_mesh(const BodyOptions& options);

/// Met by a beam's centre ray. What it meets ends the whole beam, also nearer than the sensor measures.
class OwnBody {
 public:
  explicit OwnBody(scenes::Mesh mesh);

  struct Hit {
    std::uint32_t ray;
    double t_m;
    float signal, cos_incidence;
    float nx, ny, nz;  ///< body frame
  };
  /// What of `rays` (body frame) meets the body.
  void meet(const raycast::Rays& rays, std::vector<Hit>& hits) const;

 private:
  bool passes_by(const raycast::Rays& rays, std::size_t i) const;
  std::shared_ptr<const scenes::Scene> scene_;
  std::unique_ptr<const raycast::Tracer> tracer_;
  Reflectance reflectance_;
  Eigen::Vector3d low_, high_;
};

}  // namespace tarmac::sim::lidar
