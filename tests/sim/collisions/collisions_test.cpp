#include "sim/collisions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <regex>

#include "core/error.h"
#include "scenes/actors/actors.h"
#include "scenes/materials/materials.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim {
namespace {

using core::time_from_s;
using Eigen::Vector3d;

scenes::Scene cast(const std::string& actors) {
  scenes::Scene scene;
  scene.materials = scenes::materials();
  scenes::add_actors(core::ConfigNode::parse("kind: none\nactors:\n" + actors, "test.yaml"), scene);
  return scene;
}

std::string error_of(const scenes::Scene& scene, const Vector3d& ego_v_m_s = Vector3d::Zero(), double end_s = 20) {
  tests::SteadyMotion ego;
  ego.v_m_s = ego_v_m_s;
  ego.length_s = end_s;
  try {
    check_collisions(scene, ego, {}, time_from_s(end_s), "test");
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

double time_in(const std::string& error) {
  std::smatch match;
  return std::regex_search(error, match, std::regex(R"(at ([0-9.]+) s)")) ? std::stod(match[1]) : -1;
}

/// A box that flies straight on.
std::string flying_box(const Vector3d& from_m, const Vector3d& v_m_s, const char* name = "box") {
  const auto list = [](const Vector3d& v) {
    return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + "]";
  };
  return std::string("  - {kind: turning-box, name: ") + name + ", position_m: " + list(from_m) +
         ", velocity_m_s: " + list(v_m_s) + ", size_m: [2, 2, 2]}\n";
}

// The ego box ends 4 m ahead of its origin, the other one begins 1 m before its middle.
TEST(Collisions, AreFoundWhenTheBodiesComeWithinTwoCentimetres) {
  const std::string error = error_of(cast(flying_box({20, 0, 1.2}, {-2, 0, 0})));
  EXPECT_NE(error.find("test.yaml:3: actor box runs into the ego vehicle"), std::string::npos) << error;
  EXPECT_NEAR(time_in(error), (20 - 1 - 4 - 0.02) / 2, 0.011);
}

TEST(Collisions, BothMove) {
  const std::string error = error_of(cast(flying_box({40, 0, 1.2}, {-2, 0, 0})), {6, 0, 0});
  EXPECT_NEAR(time_in(error), (40 - 1 - 4 - 0.02) / 8, 0.011) << error;
}

TEST(Collisions, PassingBesideIsNone) {
  EXPECT_EQ(error_of(cast(flying_box({20, 2.05, 1.2}, {-2, 0, 0}))), "");
  EXPECT_NE(error_of(cast(flying_box({20, 1.95, 1.2}, {-2, 0, 0}))), "");
}

TEST(Collisions, NothingIsTooFastToBeSeen) {
  EXPECT_NEAR(time_in(error_of(cast(flying_box({1, -300, 1.2}, {0, 60, 0})))), (300 - 2) / 60.0, 0.011);
  EXPECT_NEAR(time_in(error_of(cast(flying_box({400, 0.9, 1.2}, {-90, 0, 0})))), 395 / 90.0, 0.011);
}

TEST(Collisions, ActorsAgainstEachOther) {
  const std::string boxes = flying_box({20, 10, 1.2}, {-2, 0, 0}, "a") + flying_box({-20, 10.5, 1.2}, {2, 0, 0}, "b");
  const std::string error = error_of(cast(boxes));
  EXPECT_NE(error.find("actor b runs into actor a"), std::string::npos) << error;
  EXPECT_NEAR(time_in(error), (40 - 2 - 0.02) / 4, 0.011);
}

TEST(Collisions, ATrainMayTouchItself) {
  scenes::Scene scene = cast(flying_box({20, 10, 1.2}, {-2, 0, 0}, "a") + flying_box({-20, 10.5, 1.2}, {2, 0, 0}, "b"));
  for (scenes::Actor& actor : scene.actors) actor.group = 7;
  EXPECT_EQ(error_of(scene), "");
}

TEST(Collisions, ActorsAgainstWhatStandsButNotAgainstTheGround) {
  scenes::Scene scene = cast(flying_box({20, 10, 1.2}, {-2, 0, 0}));
  tests::add_instance(scene, tests::square(100), tests::pose({0, 0, 0.21}), -1, scenes::Label::pavement);
  EXPECT_EQ(error_of(scene), "");
  tests::add_instance(scene, tests::box({0.1, 0.1, 3}), tests::pose({5, 10.5, 0}));
  const std::string error = error_of(scene);
  EXPECT_NE(error.find("runs into what stands there (box)"), std::string::npos) << error;
  EXPECT_NEAR(time_in(error), (20 - 1 - 5.1 - 0.02) / 2, 0.011);
}

TEST(Collisions, AnActorOfTheScenesOwnIsNamedWithTheScenario) {
  scenes::Scene scene = cast(flying_box({20, 0, 1.2}, {-2, 0, 0}));
  scene.actors[0].where.clear();
  EXPECT_TRUE(error_of(scene).starts_with("test: actor box")) << error_of(scene);
}

}  // namespace
}  // namespace tarmac::sim
