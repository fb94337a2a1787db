// Nothing, or a square of flat pavement: a place for users' own meshes.
#include <algorithm>

#include "scenes/assembly.h"
#include "scenes/primitives/ground_patch.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

namespace {

struct BareOptions {
  double pavement_m = 0;
  double z_m = 0;

  void visit(core::OptionVisitor& v) {
    v("pavement_m", pavement_m, "edge of a square of flat concrete around the origin (0: none)",
      {.at_least = 0, .at_most = 4000});
    v("z_m", z_m, "height that wheels run at, and of the pavement", {.at_least = -1000, .at_most = 1000});
  }
};

class Level final : public Ground {
 public:
  explicit Level(double z_m) : z_m_(z_m) {}
  double height_m(double, double, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const override {
    if (gradient) gradient->setZero();
    if (hessian) hessian->setZero();
    return z_m_;
  }

 private:
  double z_m_;
};

BareOptions read(const core::ConfigNode& node) {
  return read_scene_options<BareOptions>(node);
}

Scene make_bare(const BareOptions& options) {
  Scene scene;
  scene.name = "bare";
  scene.materials = materials();
  scene.ground = std::make_shared<Level>(options.z_m);
  if (options.pavement_m <= 0) return scene;
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(options.pavement_m / 2);
  const double shown = std::min(options.pavement_m / 2, 80.0);
  scene.interest_min = Eigen::Vector2d::Constant(-shown);
  scene.interest_max = Eigen::Vector2d::Constant(shown);
  MeshBuilder pavement("pavement");
  pavement.use(MaterialId::concrete_dry);
  add_ground_patch(pavement, *scene.ground, -half, half, 25);
  Assembly a(scene, *scene.ground);
  a.put(a.mesh(std::move(pavement).build()), Label::pavement);
  return scene;
}

}  // namespace

extern const SceneEntry bare;
const SceneEntry bare{
    .name = "bare",
    .summary = "nothing, or flat pavement: a place for meshes of your own",
    .make = [](const core::ConfigNode& node, std::uint64_t) { return make_bare(read(node)); },
    .ground = [](const core::ConfigNode& node, std::uint64_t) -> std::shared_ptr<const Ground> {
      return std::make_shared<Level>(read(node).z_m);
    },
    .describe = [] { return core::describe_options<BareOptions>(); },
    .resolve = [](const core::ConfigNode& node) { return "  kind: bare\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
