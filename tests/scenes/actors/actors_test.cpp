#include "scenes/actors/actors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/random.h"
#include "scenes/actors/footing.h"
#include "scenes/actors/options.h"
#include "scenes/materials/materials.h"
#include "scenes/paving/paving.h"

namespace tarmac::scenes {
namespace {

using core::time_from_s;
using Eigen::Vector3d;

core::ConfigNode scene_node(const std::string& actors) {
  return core::ConfigNode::parse("kind: stand\nactors:\n" + actors, "scenario.yaml");
}

Scene cast(const std::string& actors) {
  Scene scene;
  scene.materials = materials();
  scene.ground = std::make_shared<const WavyGround>(PavingSpec{}, 1);
  add_actors(scene_node(actors), scene);
  return scene;
}

/// One of each kind, all of them moving between 1 s and 40 s.
const char* const one_of_each = R"(
  - {kind: aircraft, type: a320, start: {x_m: -60, y_m: -66}, path: [{straight_m: 30}, {turn_deg: 80, radius_m: 28, blend_m: 14}, {straight_m: 20}], rest_s: 1, speed: [{to_m_s: 5, peak_m_s2: 0.8}]}
  - {kind: pushback, start: {x_m: 0, y_m: 12, heading_deg: 90}, path: [{straight_m: 12}, {turn_deg: 70, radius_m: 22, blend_m: 12}, {straight_m: 6}], rest_s: 2, speed: [{to_m_s: 1.4, peak_m_s2: 0.3}]}
  - {kind: pushback, towbar: none, tractor: towbarless-tractor, start: {x_m: 60, y_m: 12, heading_deg: 90}, path: [{straight_m: 30}], rest_s: 1, speed: [{to_m_s: 1.4, peak_m_s2: 0.3}]}
  - {kind: baggage-train, carts: 5, start: {x_m: -40, y_m: -30}, path: [{straight_m: 12}, {turn_deg: 90, radius_m: 9, blend_m: 4}, {turn_deg: -120, radius_m: 10, blend_m: 5}, {straight_m: 9}], rest_s: 1, speed: [{to_m_s: 4, peak_m_s2: 1.2}]}
  - {kind: bus, way_points: [{x_m: 0, y_m: -40}, {x_m: 60, y_m: -40}, {x_m: 60, y_m: 10}], corner_radius_m: 14, rest_s: 1, speed: [{to_m_s: 6}]}
  - {kind: fuel-truck, start: {x_m: 0, y_m: -50, heading_deg: 30}, path: [{straight_m: 110}], rest_s: 1, speed: [{to_m_s: 6, peak_m_s2: 1.5}]}
  - {kind: belt-loader, start: {x_m: 0, y_m: -60, heading_deg: 30}, path: [{straight_m: 20}, {turn_deg: 45, radius_m: 8, blend_m: 3}], rest_s: 1, speed: [{to_m_s: 2}]}
  - {kind: follow-me, start: {x_m: -100, y_m: -66}, path: [{straight_m: 90}, {turn_deg: 40, radius_m: 30, blend_m: 10}], rest_s: 1, speed: [{to_m_s: 8, peak_m_s2: 2}], stop_peak_m_s2: 2}
  - {kind: vehicle, type: baggage-tractor, way_points: [{x_m: -50, y_m: 38, at_s: 7}, {x_m: 0, y_m: 38, at_s: 17}, {x_m: 0, y_m: 38, at_s: 22}, {x_m: 30, y_m: 20, at_s: 32}], stop_peak_m_s2: 2}
  - {kind: marshaller, start: {x_m: 3, y_m: 33, heading_deg: 180}, path: [{straight_m: 8}, {turn_deg: 90, radius_m: 0.8, blend_m: 0.6}, {straight_m: 4}], rest_s: 3, speed: [{to_m_s: 1.3, peak_m_s2: 0.8}], arms_raised_from_s: 16, arms_raised_until_s: 30}
  - {kind: accelerating-plane, position_m: [10, 20, 3], velocity_m_s: [1, 0, 0], acceleration_m_s2: [-0.6, 0.4, 0], size_m: [0.2, 6, 6], heading_deg: 20}
  - {kind: turning-box, position_m: [-10, 20, 3], velocity_m_s: [0, 2, 0], size_m: [4, 2, 3], turn_deg_s: 40, turn_deg_s2: 10}
)";

const Scene& all_kinds() {
  static const Scene scene = cast(one_of_each);
  return scene;
}

TEST(Actors, EveryKindIsThere) {
  for (const ActorKind& kind : actor_kinds()) {
    EXPECT_NE(std::string(one_of_each).find(std::string("kind: ") + kind.name), std::string::npos) << kind.name;
  }
  EXPECT_GT(all_kinds().actors.size(), 12u + 4 + 2 + 8);
  std::map<std::string, int> names;
  for (const Actor& actor : all_kinds().actors) {
    EXPECT_EQ(++names[actor.name], 1) << actor.name;
    EXPECT_TRUE(actor.where.starts_with("scenario.yaml:")) << actor.where;
  }
}

TEST(Actors, RadiusHoldsEveryVertex) {
  const Scene& scene = all_kinds();
  for (const Instance& instance : scene.instances) {
    const Actor& actor = scene.actors[static_cast<std::size_t>(instance.actor)];
    double farthest = 0;
    for (const Eigen::Vector3f& p : scene.meshes[instance.mesh].vertices)
      farthest = std::max(farthest, (instance.T_parent_mesh * p.cast<double>()).norm());
    EXPECT_LE(farthest, actor.radius_m) << actor.name;
    EXPECT_GT(farthest, 0.8 * actor.radius_m) << actor.name;
  }
}

// Sampled: points on the sphere of the actor's radius, at steps that are none of the table's.
TEST(Actors, AccelerationBoundHoldsForEveryPointAndIsNotIdle) {
  const core::RandomStream random(3, "test/actors");
  const double h = 0.004;
  for (const Actor& actor : all_kinds().actors) {
    const auto pose = [&](double t) { return actor.motion->T_world_actor(time_from_s(t)); };
    double worst_share = 0;
    for (std::uint64_t k = 0; k < 400; ++k) {
      const double t0 = 0.1 * static_cast<double>(k) + 0.0137;
      const double bound =
          actor.motion->acceleration_bound_m_s2(time_from_s(t0), time_from_s(t0 + 0.1), actor.radius_m);
      const Vector3d p =
          actor.radius_m * Vector3d(random.normal(k, 0), random.normal(k, 1), random.normal(k, 2)).normalized();
      for (double t = t0 + h; t <= t0 + 0.1 - h; t += 0.0119) {
        const core::SE3 now = pose(t), before = pose(t - h), after = pose(t + h);
        for (const Vector3d& x : {Vector3d(Vector3d::Zero()), p}) {
          const Vector3d a = (after * x - 2 * (now * x) + before * x) / (h * h);
          EXPECT_LE(a.norm(), bound * (1 + 1e-6) + 1e-6) << actor.name << " at " << t;
          if (bound > 0.05) worst_share = std::max(worst_share, a.norm() / bound);
        }
      }
    }
    EXPECT_GT(worst_share, 0.4) << actor.name << ": a bound that is never nearly reached tells nothing";
  }
}

TEST(Actors, StandStillExactlyBeforeAndAfterTheirTimetable) {
  for (const Actor& actor : all_kinds().actors) {
    if (actor.name.starts_with("accelerating-plane") || actor.name.starts_with("turning-box")) continue;
    for (const auto& [t0, t1] : {std::pair{0.0, 0.9}, std::pair{300.0, 400.0}}) {
      const core::SE3 a = actor.motion->T_world_actor(time_from_s(t0)),
                      b = actor.motion->T_world_actor(time_from_s(t1));
      EXPECT_EQ(a.matrix(), b.matrix()) << actor.name;
      EXPECT_EQ(actor.motion->acceleration_bound_m_s2(time_from_s(t0 + 0.05), time_from_s(t1), actor.radius_m), 0)
          << actor.name;
    }
  }
}

TEST(Actors, WheelsTouchTheGroundWhileTheyMove) {
  const Scene& scene = all_kinds();
  for (const Instance& instance : scene.instances) {
    const Actor& actor = scene.actors[static_cast<std::size_t>(instance.actor)];
    if (instance.label == Label::other || instance.label == Label::person) continue;
    if (actor.name.ends_with("/towbar")) continue;  // hangs between the hitches
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (double t = 0; t < 40; t += 3.1) {
      const core::SE3 T = actor.motion->T_world_actor(time_from_s(t)) * instance.T_parent_mesh;
      double lowest = 1e9;
      for (const Eigen::Vector3f& v : mesh.vertices) {
        if (v.z() > 0.005f) continue;
        const Vector3d p = T * v.cast<double>();
        const double over = p.z() - scene.ground->height_m(p.x(), p.y());
        lowest = std::min(lowest, over);
        EXPECT_LT(std::abs(over), 0.02) << actor.name << " at " << t;
      }
      EXPECT_LT(std::abs(lowest), 0.012) << actor.name << " at " << t;
    }
  }
}

TEST(Actors, WayPointsArePassedAtTheirTimes) {
  const Scene scene = cast(
      "  - {kind: bus, way_points: [{x_m: 0, y_m: 0, at_s: 4}, {x_m: 40, y_m: 0, at_s: 12}, {x_m: 40, y_m: 0, at_s: "
      "20}, "
      "{x_m: 100, y_m: 0, at_s: 30}]}\n");
  const auto x = [&](double t) { return scene.actors[0].motion->T_world_actor(time_from_s(t)).translation().x(); };
  EXPECT_NEAR(x(0), 0, 1e-9);
  EXPECT_NEAR(x(8), 20, 1e-6) << "half way: outside of the changes it is where the timetable says";
  EXPECT_NEAR(x(16), 40, 1e-6);
  EXPECT_NEAR(x(25), 70, 1e-6);
  EXPECT_NEAR(x(60), 100, 1e-6);
}

TEST(Actors, UnderWayAtTheBeginningAreNotTakenForAJolt) {
  const Scene scene =
      cast("  - {kind: follow-me, start: {speed_m_s: 12}, path: [{straight_m: 400}], stop_peak_m_s2: 2}\n");
  const Actor& actor = scene.actors[0];
  EXPECT_GT((actor.motion->T_world_actor(time_from_s(1)).translation() -
             actor.motion->T_world_actor(time_from_s(0)).translation())
                .norm(),
            10);
  EXPECT_LT(actor.motion->acceleration_bound_m_s2(time_from_s(0), time_from_s(0.1), actor.radius_m), 20);
}

TEST(Actors, PathRoundsItsWayPointsAndEndsAtTheLast) {
  const Scene scene = cast(
      "  - {kind: bus, way_points: [{x_m: 0, y_m: 0}, {x_m: 50, y_m: 0}, {x_m: 50, y_m: 60}, {x_m: 0, y_m: 90}], "
      "corner_radius_m: 9, speed: [{to_m_s: 5, peak_m_s2: 1}]}\n");
  const auto at = [&](double t) -> Vector3d {
    return scene.actors[0].motion->T_world_actor(time_from_s(t)).translation();
  };
  double nearest = 1e9;
  for (double t = 0; t < 60; t += 0.05) nearest = std::min(nearest, (at(t).head<2>() - Eigen::Vector2d(50, 0)).norm());
  EXPECT_LT(nearest, 9 * (std::sqrt(2) - 1) * 1.6) << "the corner is cut by the turn";
  EXPECT_GT(nearest, 0.5);
  EXPECT_LT((at(100).head<2>() - Eigen::Vector2d(0, 90)).norm(), 1e-6);
}

TEST(Actors, ResolvedListMakesTheSameActors) {
  const std::string resolved = resolve_actors(scene_node(one_of_each));
  Scene again;
  again.materials = materials();
  again.ground = all_kinds().ground;
  add_actors(core::ConfigNode::parse("scene:\n  kind: stand\n" + resolved, "resolved.yaml").child("scene"), again);
  ASSERT_EQ(again.actors.size(), all_kinds().actors.size());
  for (std::size_t i = 0; i < again.actors.size(); ++i) {
    EXPECT_EQ(again.actors[i].name, all_kinds().actors[i].name);
    for (const double t : {0.0, 7.3, 21.0})
      EXPECT_EQ(again.actors[i].motion->T_world_actor(time_from_s(t)).matrix(),
                all_kinds().actors[i].motion->T_world_actor(time_from_s(t)).matrix())
          << again.actors[i].name;
  }
}

std::string error_of(const std::string& actors) {
  try {
    cast(actors);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

struct Bad {
  const char* actors;
  const char* line;
  const char* says;
};

class BadActor : public testing::TestWithParam<Bad> {};

TEST_P(BadActor, IsRefusedWithItsLine) {
  const std::string error = error_of(GetParam().actors);
  EXPECT_TRUE(error.starts_with(std::string("scenario.yaml:") + GetParam().line)) << error;
  EXPECT_NE(error.find(GetParam().says), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Actors, BadActor,
    testing::Values(
        Bad{"  - {kind: buss}\n", "3", "did you mean 'bus'"}, Bad{"  - {kind: bus, colour: red}\n", "3", "colour"},
        Bad{"  - {kind: vehicle, type: tank}\n", "3", "tank"},
        Bad{"  - kind: bus\n    way_points:\n      - {x_m: 0, y_m: 0, at_s: 5}\n      - {x_m: 90, y_m: 0, at_s: 6}\n",
            "6", "teleports: 90.00 m in 1.000 s"},
        Bad{"  - kind: bus\n    way_points:\n      - {x_m: 0, y_m: 0, at_s: 5}\n      - {x_m: 9, y_m: 0, at_s: 5}\n",
            "6", "teleports"},
        Bad{"  - kind: bus\n    way_points:\n      - {x_m: 0, y_m: 0, at_s: 5}\n      - {x_m: 9, y_m: 0}\n", "6",
            "gap in time"},
        Bad{"  - kind: bus\n    way_points:\n      - {x_m: 0, y_m: 0, at_s: 5}\n      - {x_m: 10, y_m: 0, at_s: 6}\n"
            "      - {x_m: 10.2, y_m: 0, at_s: 20}\n",
            "5", "m/s^2"},
        Bad{"  - kind: bus\n    path: [{straight_m: 50}]\n    speed:\n      - {to_m_s: 30}\n", "6", "at most 13"},
        Bad{"  - kind: bus\n    path: [{straight_m: 50}]\n    speed:\n      - {to_m_s: 9, peak_m_s2: 11}\n", "6",
            "at most"},
        Bad{"  - kind: bus\n    path: [{straight_m: 5}]\n    speed:\n      - {to_m_s: 9}\n", "", "the stop at the end"},
        Bad{"  - kind: bus\n    path: [{straight_m: 5}, {turn_deg: 90, radius_m: 3, blend_m: 1}]\n    speed:\n"
            "      - {to_m_s: 1}\n",
            "3", "turn more widely"},
        Bad{"  - kind: follow-me\n    path: [{straight_m: 150}, {turn_deg: 90, radius_m: 9, blend_m: 3}, {straight_m: "
            "350}]\n"
            "    speed:\n      - {to_m_s: 15, peak_m_s2: 3}\n",
            "3", "sideways"},
        Bad{"  - kind: baggage-train\n    carts: 6\n    path: [{straight_m: 9}, {turn_deg: 270, radius_m: 3.2, "
            "blend_m: "
            "2}]\n    speed: [{to_m_s: 2}]\n",
            "3", "cart"},
        Bad{"  - kind: pushback\n    path: [{straight_m: 9}, {turn_deg: 90, radius_m: 5, blend_m: 3}]\n    speed: "
            "[{to_m_s: "
            "1, peak_m_s2: 0.3}]\n    stop_peak_m_s2: 0.3\n",
            "3", "nose gear"},
        Bad{"  - kind: bus\n    start:\n      heading_deg: 90\n    way_points: [{x_m: 0, y_m: 0}, {x_m: 90, y_m: 0}]\n",
            "5", "heading_deg: has no effect here"},
        Bad{"  - kind: bus\n    start:\n      speed_m_s: 2\n    way_points: [{x_m: 0, y_m: 0, at_s: 0}, {x_m: 90, "
            "y_m: 0, at_s: 30}]\n",
            "5", "speed_m_s: has no effect here"},
        Bad{"  - kind: bus\n    rest_s: 3\n    way_points: [{x_m: 0, y_m: 0, at_s: 0}, {x_m: 90, y_m: 0, at_s: 30}]\n",
            "4", "rest_s: has no effect here"},
        Bad{"  - kind: bus\n    rest_s: 3\n    start: {speed_m_s: 5}\n    path: [{straight_m: 90}]\n", "4",
            "rest_s: has no effect here"},
        Bad{"  - kind: bus\n    rest_s: 3\n    path: [{straight_m: 90}]\n", "4", "rest_s: has no effect here"},
        Bad{"  - kind: bus\n    stop_peak_m_s2: 2\n    path: [{straight_m: 90}]\n", "4",
            "stop_peak_m_s2: has no effect here"},
        Bad{"  - kind: bus\n    corner_radius_m: 12\n    path: [{straight_m: 90}]\n", "4",
            "corner_radius_m: has no effect here"},
        Bad{"  - kind: bus\n    path:\n      - {straight_m: 90, blend_m: 5}\n    speed: [{to_m_s: 2}]\n", "5",
            "are of turns"},
        Bad{"  - kind: bus\n    path: [{straight_m: 90}]\n    speed:\n      - {to_m_s: 2, at_s: 4, wait_s: 2}\n", "6",
            "wait_s has no effect"},
        Bad{"  - kind: bus\n    path: [{straight_m: 90}]\n    speed:\n      - {to_m_s: 2, abs_hz: 4}\n", "6",
            "abs_hz has no effect"},
        Bad{"  - kind: marshaller\n    beckon_hz: 2\n", "4", "beckon_hz: has no effect here"},
        Bad{"  - {kind: bus, name: a}\n  - {kind: bus, name: a}\n", "4", "two actors called 'a'"}));

}  // namespace
}  // namespace tarmac::scenes
