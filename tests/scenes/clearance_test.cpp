#include <gtest/gtest.h>

#include <iostream>

#include "scenes/stand/layout.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;

struct Nearest {
  double distance_m = 1e9;
  std::string mesh;
  Vector2d at{0, 0};
};

/// The static triangle nearest to the corridor's centre line among those between two heights above the ground.
Nearest nearest_to_corridor(const Scene& scene, double low_m, double high_m) {
  const std::vector<Vector2d> line = layout::corridor_centre_line(0.25);
  Nearest nearest;
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return !tests::on_the_ground(i.label); },
      [&](const Instance& instance, const tests::Triangle& t) {
        const std::vector<Vector2d> outline = tests::outline_between(t, *scene.ground, low_m, high_m);
        if (outline.empty()) return;
        double size = 0;
        for (const Vector2d& p : outline) size = std::max(size, (p - outline[0]).norm());
        for (const Vector2d& p : line) {
          if ((p - outline[0]).norm() - size > std::min(nearest.distance_m, 12.0)) continue;
          const double distance = tests::distance_to_outline(p, outline);
          if (distance < nearest.distance_m) nearest = {distance, scene.meshes[instance.mesh].name, p};
        }
      });
  return nearest;
}

TEST(Corridor, KeepsOneAndAHalfMetresFromEverythingStatic) {
  const std::string options = "carts: 16\ncones: 12\n";
  for (const std::uint64_t seed : {1, 2}) {
    const Nearest nearest = nearest_to_corridor(make_scene(tests::scene_node(options), seed), 0.15, 2.6);
    std::cout << "seed " << seed << ": " << nearest.distance_m << " m to " << nearest.mesh << " at "
              << nearest.at.transpose() << "\n";
    EXPECT_GE(nearest.distance_m, 1.5) << nearest.mesh;
    EXPECT_LT(nearest.distance_m, 12) << "nothing found at all: the search is broken";
  }
}

TEST(Corridor, IsFreeOverItsWholeWidthUpToItsClearHeight) {
  const Nearest nearest = nearest_to_corridor(tests::default_stand(), 0.05, layout::corridor_clear_height_m);
  EXPECT_GE(nearest.distance_m, layout::corridor_width_m / 2) << nearest.mesh;
}

TEST(Corridor, SearchFindsAPostThatStandsInTheWay) {
  Scene scene = tests::default_stand();
  Instance post;  // a lighting mast on the centre line
  for (const Instance& i : scene.instances) {
    if (i.label == Label::mast) post = i;
  }
  post.T_parent_mesh.translation() = Eigen::Vector3d(0, layout::corridor_north_y_m, 0);
  scene.instances.push_back(post);
  EXPECT_LT(nearest_to_corridor(scene, 0.15, 2.6).distance_m, 0.2);
}

}  // namespace
}  // namespace tarmac::scenes
