// Open country: rough ground that is nowhere level, rocks and trees. No plane, no straight edge, no right angle.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/assembly.h"
#include "scenes/hills/ground.h"
#include "scenes/outdoors/outdoors.h"
#include "scenes/paving/paving.h"
#include "scenes/registry.h"

namespace tarmac::scenes {

namespace {

using Eigen::Vector2d;

constexpr double pi = std::numbers::pi;
constexpr int kRockShapes = 8, kTreeShapes = 6;

/// Places drawn one after the other, none nearer to the track than the lane and what stands there need. Half of them
/// lie near the track, where they are seen best.
class Scatter {
 public:
  Scatter(const HillsOptions& options, const char* name, std::uint64_t seed)
      : options_(&options), random_(seed, name), track_(hills_track()) {}
  double draw() { return random_.uniform(drawn_++); }
  Vector2d place(double radius_m) {
    for (;;) {
      const bool near = draw() < 0.5;
      const double reach = near ? 60 : options_->half_size_m - 5;
      const double x = draw(), y = draw();
      const Vector2d p(reach * (2 * x - 1), reach * (2 * y - 1));
      if (distance_m(p, track_) > options_->lane_m + radius_m) return p;
    }
  }

 private:
  const HillsOptions* options_;
  core::RandomStream random_;
  std::uint64_t drawn_ = 0;
  std::vector<Vector2d> track_;
};

void add_rocks(Assembly& a, const HillsOptions& o, std::uint64_t seed) {
  Scatter scatter(o, "scenes/hills/rocks", seed);
  std::vector<std::uint32_t> shapes;
  // Sizes belong to the shapes: an instance cannot scale.
  constexpr double radius_m[kRockShapes] = {0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.5, 2.2};
  for (int k = 0; k < kRockShapes; ++k) {
    shapes.push_back(a.mesh("rock", [&](MeshBuilder& b) { add_rock(b, radius_m[k], seed, k); }));
  }
  for (int k = 0; k < o.rocks; ++k) {
    const auto shape = static_cast<std::size_t>(std::pow(scatter.draw(), 1.5) * kRockShapes);
    const Vector2d p = scatter.place(1.8 * radius_m[shape]);
    a.stand(shapes[shape], Label::other, p.x(), p.y(), 2 * pi * scatter.draw());
  }
}

void add_trees(Assembly& a, const HillsOptions& o, std::uint64_t seed) {
  Scatter scatter(o, "scenes/hills/trees", seed);
  std::vector<std::uint32_t> shapes;
  for (int k = 0; k < kTreeShapes; ++k) {
    TreeShape shape{
        .height_m = 5.5 + 1.1 * k, .crown_radius_m = 1.5 + 0.22 * k, .crown_from_m = 1.6, .leaves = 480, .leaf_m = 0.3};
    shape.conifer = k % 2 == 1;
    if (shape.conifer) shape.crown_from_m = 0.8;
    shapes.push_back(a.mesh("tree", [&](MeshBuilder& b) { add_tree(b, shape, seed, 100 + k); }));
  }
  for (int k = 0; k < o.trees; ++k) {
    const auto shape = static_cast<std::size_t>(scatter.draw() * kTreeShapes);
    const Vector2d p = scatter.place(1.5);
    a.found(shapes[shape], Label::tree, p.x(), p.y(), 2 * pi * scatter.draw());
  }
}

/// Tufts and clods: the pavement's texture without joints, coarser.
std::shared_ptr<const Relief> make_texture(const HillsOptions& o, std::uint64_t seed) {
  PavingSpec spec;
  spec.relief_rms_mm = o.texture_rms_mm;
  spec.joint_depth_mm = 0;
  spec.stream = "scenes/hills";
  return std::make_shared<SlabRelief>(spec, seed);
}

Scene make_hills(const HillsOptions& o, std::uint64_t seed) {
  Scene scene;
  scene.name = "rough-hills";
  scene.materials = materials();
  scene.interest_min = {-70, -60};
  scene.interest_max = {70, 60};
  const auto ground = std::make_shared<HillyGround>(o, seed);
  scene.ground = ground;
  if (o.texture_rms_mm > 0) scene.relief = make_texture(o, seed);
  Assembly a(scene, *ground);
  a.put(a.mesh(make_hills_mesh(*ground, o.half_size_m)), Label::terrain);
  if (o.rocks > 0) add_rocks(a, o, seed);
  if (o.trees > 0) add_trees(a, o, seed);
  return scene;
}

HillsOptions read(const core::ConfigNode& node) {
  HillsOptions options = read_scene_options<HillsOptions>(node);
  if (options.shortest_m >= options.longest_m) node.fail_at("shortest_m", "must be below longest_m");
  return options;
}

}  // namespace

extern const SceneEntry rough_hills;
const SceneEntry rough_hills{
    .name = "rough-hills",
    .summary = "open country: rough hills without a plane, rocks, trees",
    .make = [](const core::ConfigNode& node, std::uint64_t seed) { return make_hills(read(node), seed); },
    .ground = [](const core::ConfigNode& node, std::uint64_t seed) -> std::shared_ptr<const Ground> {
      return std::make_shared<HillyGround>(read(node), seed);
    },
    .describe = [] { return core::describe_options<HillsOptions>(); },
    .resolve =
        [](const core::ConfigNode& node) { return "  kind: rough-hills\n" + core::write_options(read(node), 2); },
};

}  // namespace tarmac::scenes
