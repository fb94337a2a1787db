#include "sim/collisions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <regex>

#include "core/error.h"
#include "scenes/actors/actors.h"
#include "scenes/materials/materials.h"
#include "sim/simulate.h"
#include "sim/truth/motion.h"
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

std::string error_with(const scenes::Scene& scene, const tests::SteadyMotion& ego, const truth::BodyBox& box) {
  try {
    check_collisions(scene, ego, box, core::Time(core::duration_from_s(ego.length_s)), "test");
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

std::string error_of(const scenes::Scene& scene, const Vector3d& ego_v_m_s = Vector3d::Zero(), double end_s = 20) {
  tests::SteadyMotion ego;
  ego.v_m_s = ego_v_m_s;
  ego.length_s = end_s;
  return error_with(scene, ego, {});
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

// No surfaces meet where one holds the other whole: 1.9 m inside 5 x 2 x 2.2 m, 2 m around all of that, 2 m around 1 m.
TEST(Collisions, WhatIsInsideAnotherFromTheBeginIsFound) {
  const auto still = [](const Vector3d& at_m, const std::string& size, const char* name) {
    std::string box = flying_box(at_m, Vector3d::Zero(), name);
    return box.replace(box.find("[2, 2, 2]"), 9, size);
  };
  const std::string in_ego = error_of(cast(still({1, 0, 1.1}, "[0.5, 0.5, 0.5]", "crate")));
  EXPECT_NE(in_ego.find("actor crate runs into the ego vehicle at 0.00 s"), std::string::npos) << in_ego;
  const std::string around_ego = error_of(cast(still({1, 0, 1.1}, "[40, 40, 40]", "hall")));
  EXPECT_NE(around_ego.find("actor hall runs into the ego vehicle at 0.00 s"), std::string::npos) << around_ego;
  const std::string each_other =
      error_of(cast(still({40, 9, 3}, "[4, 4, 4]", "outer") + still({40, 9, 3}, "[1, 1, 1]", "inner")));
  EXPECT_NE(each_other.find("actor inner runs into actor outer at 0.00 s"), std::string::npos) << each_other;
  scenes::Scene scene = cast(still({40, 9, 3}, "[1, 1, 1]", "inner"));
  tests::add_instance(scene, tests::box({5, 5, 5}), tests::pose({40, 9, 3}));
  const std::string stands = error_of(scene);
  EXPECT_NE(stands.find("actor inner runs into what stands there (box) at 0.00 s"), std::string::npos) << stands;
  // A room's walls face inward: what is in it is not in them.
  for (auto& triangle : scene.meshes[scene.instances.back().mesh].triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(error_of(scene), "");
}

truth::BodyBox box_of(const std::string& motion) {
  return truth::body_box(core::ConfigNode::parse(motion, "test.yaml"));
}

/// The ego vehicle stands at `height_m`, rolled by `roll_rad`; a box of 2 m comes along y with its near side at
/// `beside_m` from the origin.
bool meets_beside(const truth::BodyBox& box, double height_m, double beside_m, double roll_rad = 0) {
  tests::SteadyMotion ego;
  ego.R0 = core::so3::exp(Vector3d(roll_rad, 0, 0));
  ego.p0_m.z() = height_m;
  ego.length_s = 20;
  return !error_with(cast(flying_box({20, beside_m + 1, 1.05}, {-2, 0, 0})), ego, box).empty();
}

TEST(Collisions, APersonADroneATrailerAndADriveHaveTheirOwnSizes) {
  const truth::BodyBox person = box_of("{kind: handheld, path: [{straight_m: 5}]}");
  const double hand_m = person.below_m;  // the device's height over the ground
  EXPECT_TRUE(meets_beside(person, hand_m, 0.45));
  EXPECT_FALSE(meets_beside(person, hand_m, 0.55));
  EXPECT_TRUE(meets_beside({}, 0, 0.95)) << "a van's would be hit there";
  EXPECT_NEAR(person.below_m + person.height_m, 1.8, 1e-9);
  // However the device is held, its owner stands upright: rolled by 50 degrees the feet would be a metre beside.
  EXPECT_FALSE(meets_beside(person, hand_m, 0.55, 0.87));

  const truth::BodyBox drone = box_of("{kind: drone, path: [{straight_m: 5}]}");
  EXPECT_TRUE(meets_beside(drone, 1, 0.5));
  EXPECT_FALSE(meets_beside(drone, 1, 0.6));
  EXPECT_FALSE(meets_beside(drone, 3, 0)) << "it flies over a box of 2 m";

  const truth::BodyBox trailer =
      box_of("{kind: towed, tug: {path: [{straight_m: 5}]}, links: [{length_m: 1.4}, {length_m: 2.2}]}");
  EXPECT_TRUE(meets_beside(trailer, 0, 0.75));
  EXPECT_FALSE(meets_beside(trailer, 0, 0.85));
  EXPECT_NEAR(trailer.length_m - trailer.rear_overhang_m, 2.2, 1e-9);

  EXPECT_GT(box_of("{kind: drive, vehicle: bus, path: [{straight_m: 5}]}").length_m, 10);
  EXPECT_EQ(box_of("{kind: still}").length_m, truth::BodyBox{}.length_m);
}

/// The scenario's way in: the motion's box holds unless the rig gives a size.
TEST(Collisions, AreLookedForWithTheRigsBodyWhereItHasASizeAndWithTheMotionsWhereNot) {
  SimulationInput input;
  input.scenario_name = "test";
  input.duration = core::duration_from_s(20);
  input.scene = std::make_shared<scenes::Scene>(cast(flying_box({20, 1.7, 1.2}, {-2, 0, 0})));
  auto ego = std::make_shared<tests::SteadyMotion>();
  ego->length_s = 20;
  input.motion = ego;
  input.body = box_of("{kind: handheld, path: [{straight_m: 5}]}");
  const auto refused = [&](const std::string& rig) {
    input.rig = core::ConfigNode::parse(rig, "rig.yaml");
    try {
      check(input);
      return false;
    } catch (const core::InputError&) {
      return true;
    }
  };
  EXPECT_FALSE(refused("lidar: {}\n"));
  EXPECT_FALSE(refused("lidar: {}\nbody: {kind: none}\n"));
  EXPECT_TRUE(refused("lidar: {}\nbody: {width_m: 1.6}\n"));
  EXPECT_TRUE(refused("lidar: {}\nbody: {kind: box}\n"));
  EXPECT_TRUE(refused("lidar: {T_body_lidar: {xyz_m: [0, 0, 3]}}\nbody: {kind: baggage-tractor}\n"));
  // What is resolved says the same as what was written.
  for (const char* rig : {"lidar: {}\n", "lidar: {}\nbody: {width_m: 1.6}\n"})
    EXPECT_EQ(refused(resolve_rig(core::ConfigNode::parse(rig, "rig.yaml"))), refused(rig)) << rig;
}

/// Sizes say how large somebody is; how far below the device the feet are, the motion knows.
TEST(Collisions, ASizeOfTheRigsLeavesTheFeetOnTheGround) {
  SimulationInput input;
  input.scenario_name = "test";
  input.duration = core::duration_from_s(20);
  input.scene = std::make_shared<scenes::Scene>(cast(flying_box({20, 0, -0.2}, {-2, 0, 0})));  // knee-high
  input.body = box_of("{kind: handheld, path: [{straight_m: 5}]}");
  auto ego = std::make_shared<tests::SteadyMotion>();
  ego->length_s = 20;
  ego->p0_m.z() = input.body.below_m;
  input.motion = ego;
  input.rig = core::ConfigNode::parse("lidar: {}\nbody: {length_m: 0.8, width_m: 0.8, height_m: 1.8}\n", "rig.yaml");
  EXPECT_THROW(check(input), core::InputError);
}

}  // namespace
}  // namespace tarmac::sim
