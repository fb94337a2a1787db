// Nothing that was put down stands inside something else: no two things' triangles cross.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

#include "tests/scenes/laws.h"

namespace tarmac::scenes {
namespace {

using namespace tests;
using Triangles = fcl::BVHModel<fcl::AABBd>;

/// A thing with the box around it, world.
struct Solid {
  const Instance* instance;
  std::string name;
  std::shared_ptr<const Triangles> triangles;
  Eigen::AlignedBox3d box;
};

std::shared_ptr<const Triangles> triangles_of(const Mesh& mesh) {
  auto model = std::make_shared<Triangles>();
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3f& v : mesh.vertices) vertices.push_back(v.cast<double>());
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

/// What stands still and is no ground. A tree's leaves may touch anything.
std::vector<Solid> solids_of(const Scene& scene) {
  std::unordered_map<std::uint32_t, std::shared_ptr<const Triangles>> built;
  std::vector<Solid> solids;
  for (const Instance& i : scene.instances) {
    if (i.actor >= 0 || on_the_ground(i.label) || i.label == Label::vegetation || i.label == Label::tree) continue;
    const Mesh& mesh = scene.meshes[i.mesh];
    auto& triangles = built[i.mesh];
    if (!triangles) triangles = triangles_of(mesh);
    Solid solid{&i, mesh.name, triangles, {}};
    for (const Eigen::Vector3f& v : mesh.vertices) solid.box.extend(i.T_parent_mesh * v.cast<double>());
    solids.push_back(std::move(solid));
  }
  return solids;
}

/// Parts of one building, pane and frame, a lamp in its wall, a bridge in its portal.
bool is_built_in(const Solid& s) {
  return s.instance->label == Label::building || s.instance->label == Label::glass ||
         s.instance->label == Label::light || s.instance->label == Label::jet_bridge || s.name == "walkways" ||
         s.name == "trays_and_pipes" || s.name == "docks" || s.name == "wall_features";
}
bool is_coupled(const Solid& s) {
  return s.name == "baggage_cart" || s.name == "baggage_tractor" || s.name == "tug" || s.name.starts_with("dolly");
}
bool are(const Solid& a, const Solid& b, const char* x, const char* y) {
  return (a.name.starts_with(x) && b.name.starts_with(y)) || (a.name.starts_with(y) && b.name.starts_with(x));
}

/// What may touch, and up to which height above the ground below it [m].
double may_touch_up_to_m(const Solid& a, const Solid& b) {
  constexpr double anywhere = 1e9, coupling_m = 0.6;
  if (is_built_in(a) && is_built_in(b)) return anywhere;
  if (are(a, b, "goods", "racking") || are(a, b, "roller_bed", "container")) return anywhere;  // lies on it
  if (are(a, b, "towbar", "")) return anywhere;
  return is_coupled(a) && is_coupled(b) ? coupling_m : -anywhere;
}

std::vector<std::string> crossings(const Scene& scene) {
  std::vector<std::string> found;
  const std::vector<Solid> solids = solids_of(scene);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      const Solid &a = solids[i], &b = solids[j];
      const double touching_m = may_touch_up_to_m(a, b);
      if (!a.box.intersects(b.box) || touching_m > 1e6) continue;
      const auto transform = [](const Solid& s) { return fcl::Transform3d(s.instance->T_parent_mesh.matrix()); };
      fcl::CollisionResultd result;
      fcl::collide(a.triangles.get(), transform(a), b.triangles.get(), transform(b),
                   fcl::CollisionRequestd(200, /*enable_contact=*/true), result);
      for (std::size_t k = 0; k < result.numContacts(); ++k) {
        const Eigen::Vector3d at = result.getContact(k).pos;
        if (at.z() - scene.ground->height_m(at.x(), at.y()) < touching_m) continue;
        std::ostringstream text;
        text << a.name << " and " << b.name << " at " << at.transpose();
        found.push_back(text.str());
        break;
      }
    }
  }
  return found;
}

class Crossings : public testing::TestWithParam<const char*> {};

TEST_P(Crossings, NothingStandsInsideAnotherThing) {
  const auto node = core::ConfigNode::parse(GetParam(), "scenario.yaml");
  EXPECT_THAT(crossings(make_scene(node, 1)), testing::IsEmpty());
}

// One of every type on a stand of its own; each kind whose things are put down apart.
INSTANTIATE_TEST_SUITE_P(
    Scenes, Crossings,
    testing::Values("kind: stand\n", "kind: pier\nequipment_density: 2\n",
                    "kind: remote-stand\nequipment_density: 2\ntypes: [atr-72, e190, b737-800, a320, a350-900]\n",
                    "kind: remote-stand\nequipment_density: 2\ntypes: [a380, b777-300er]\n", "kind: hangar\n",
                    "kind: cargo-yard\n", "kind: open-apron\nclutter_per_ha: 20\n", "kind: taxiway\n",
                    "kind: runway-crossing\n", "kind: road-tunnel\nniches: true\n", "kind: baggage-tunnel\n",
                    "kind: corridor\n", "kind: warehouse\n", "kind: highway\n", "kind: urban-block\n"),
    [](const auto& value) {
      std::string name = value.param;
      name = std::to_string(value.index) + name.substr(6, name.find('\n') - 6);
      std::erase(name, '-');
      return name;
    });

TEST(Crossings, AreFound) {
  Scene scene = make_scene(laws::node_of("remote-stand", "types: [e190]\n"), 1);
  const auto aircraft = std::ranges::find(scene.instances, Label::aircraft, &Instance::label);
  ASSERT_NE(aircraft, scene.instances.end());
  aircraft->T_parent_mesh.translation() += Eigen::Vector3d(-0.5, 0, 0);  // into its stairs
  EXPECT_THAT(crossings(scene), testing::Contains(testing::HasSubstr("passenger_stairs")));
}

}  // namespace
}  // namespace tarmac::scenes
