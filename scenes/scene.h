/// The world that rays meet: meshes, instances, materials, labels, pavement relief and actors that move.
/// World frame: x east, y north, z up [m]; the stand's own layout is documented in scenes/README.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/lie.h"
#include "core/time.h"

namespace tarmac::scenes {

/// Reflectance at 865-905 nm: rho_eq(theta) = diffuse * OrenNayar + glossy lobe + retro lobe (docs/sources in README).
struct Material {
  std::string name;
  double diffuse = 0.3;                     ///< hemispherical reflectance
  double oren_nayar_sigma_rad = 0;          ///< 0 = Lambert
  double specular_f0 = 0;                   ///< Fresnel reflectance at normal incidence of the glossy lobe
  double ggx_alpha = 0;                     ///< 0 = no glossy lobe
  double retro = 0;                         ///< rho_eq of the retro-reflecting lobe at normal incidence
  double transmission = 0;                  ///< share of energy passing (glass)
  bool has_relief = false;                  ///< pavement: Scene::relief applies
  Eigen::Vector3f color{0.6f, 0.6f, 0.6f};  ///< for pictures only, sRGB 0..1
};

/// What a surface belongs to. Values are written to files: never renumber.
enum class Label : std::uint8_t {
  none = 0,
  pavement = 1,
  marking = 2,
  building = 3,
  glass = 4,
  jet_bridge = 5,
  aircraft = 6,
  mast = 7,
  ground_equipment = 8,
  cone = 9,
  vehicle = 10,
  vegetation = 11,
  person = 12,
  other = 13,
  own_body = 14,
  sign = 15,
  light = 16,
  tree = 17,
  terrain = 18,
};
const char* name_of(Label label);

/// Triangles in the mesh's own frame, in metres. Winding: counter-clockwise seen from outside.
struct Mesh {
  std::string name;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> materials;  ///< one a triangle: index into Scene::materials
};

struct Instance {
  std::uint32_t mesh = 0;
  Label label = Label::other;
  std::int32_t actor = -1;                          ///< index into Scene::actors; -1 = static
  core::SE3 T_parent_mesh = core::SE3::Identity();  ///< parent = world, or the actor's frame
};

/// The motion of an actor, in closed form or as a certified solution: its pose at any time.
class ActorMotion {
 public:
  virtual ~ActorMotion() = default;
  virtual core::SE3 T_world_actor(core::Time t) const = 0;
  /// Upper bound of the acceleration of any point within `radius_m` of the actor's origin over [t0, t1] [m/s^2],
  /// v*omega included; tells how many motion steps a sweep needs. 0 = it stands still.
  virtual double acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const = 0;
};

struct Actor {
  std::string name;
  std::shared_ptr<const ActorMotion> motion;
  double radius_m = 0;      ///< of a sphere around the actor's origin that holds all its meshes
  std::string where = {};   ///< "scenario.yaml:14" where a scenario asks for it; empty when the scene's kind does
  std::int32_t group = -1;  ///< actors of one group belong together (a train) and may touch; -1 = belongs to none
};

/// Height over the macro surface [m], with its gradient: texture and joints of the pavement, applied after tracing.
class Relief {
 public:
  virtual ~Relief() = default;
  virtual double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr) const = 0;
  /// The same at `count` points, in single precision (within a micrometre): what is asked for every ray on pavement.
  virtual void heights_m(std::size_t count, const double* x_m, const double* y_m, float* heights, float* slope_x,
                         float* slope_y) const {
    for (std::size_t k = 0; k < count; ++k) {
      Eigen::Vector2d gradient;
      heights[k] = static_cast<float>(height_m(x_m[k], y_m[k], &gradient));
      slope_x[k] = static_cast<float>(gradient.x());
      slope_y[k] = static_cast<float>(gradient.y());
    }
  }
};

/// The smooth base of the pavement (slopes; C-infinity), which wheels follow; slab tilts and relief come on top of it.
class Ground {
 public:
  virtual ~Ground() = default;
  /// Height with gradient and Hessian (xx, xy, yy).
  virtual double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                          Eigen::Vector3d* hessian = nullptr) const = 0;
};

struct Scene {
  std::string name;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Actor> actors;
  std::shared_ptr<const Ground> ground;
  std::shared_ptr<const Relief> relief;                          ///< nullptr = none
  Eigen::Vector2d interest_min{-60, -40}, interest_max{60, 60};  ///< what a top view should show

  std::size_t triangle_count() const;  ///< after instancing
};

}  // namespace tarmac::scenes
