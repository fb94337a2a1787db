#include "sim/raycast/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "sim/raycast/scene_frames.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim::raycast {
namespace {

using core::time_from_s;
using Eigen::Vector3d;

constexpr double sweep_s = 0.1;

struct Shot {
  Vector3d origin_world, direction;
  double t_s = 0;
};

Hits shoot(const scenes::Scene& scene, const std::vector<Shot>& shots, TracerSettings settings = {},
           double reach_m = 150) {
  const Tracer tracer(std::make_shared<scenes::Scene>(scene), settings);
  const SweepTracer sweep = tracer.sweep(time_from_s(0), time_from_s(sweep_s), shots[0].origin_world, reach_m);
  Rays rays;
  rays.resize(shots.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Vector3d o = shots[i].origin_world - sweep.base();
    rays.ox[i] = o.x(), rays.oy[i] = o.y(), rays.oz[i] = o.z();
    rays.dx[i] = shots[i].direction.x(), rays.dy[i] = shots[i].direction.y(), rays.dz[i] = shots[i].direction.z();
    rays.t_ns[i] = static_cast<std::int32_t>(std::llround(shots[i].t_s * 1e9));
  }
  std::vector<std::uint32_t> order((shots.size() + 15) / 16 * 16, SweepTracer::no_ray);
  std::iota(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shots.size()), 0u);
  Hits hits;
  sweep.trace(rays, order, hits);
  return hits;
}

/// A fan of rays about `axis`, fired one after the other over the sweep.
std::vector<Shot> fan(const Vector3d& origin, const Vector3d& axis, int n = 500, double width_rad = 0.1) {
  std::vector<Shot> shots;
  const Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
  for (int k = 0; k < n; ++k) {
    const double a = width_rad * std::cos(2.4 * k), b = width_rad * std::sin(2.4 * k) * k / n;
    shots.push_back({origin, (axis + a * side + b * up).normalized(), sweep_s * k / n});
  }
  return shots;
}

TEST(Tracer, RangeToADistantPlaneIsExactToMicrometresFarFromTheWorldsOrigin) {
  scenes::Scene scene = tests::empty_scene();
  const core::SE3 T = tests::pose({-1820, 2390, 40}, {0.9, 0.5, 0});
  tests::add_instance(scene, tests::square(80, 31), T);
  const Vector3d n = T.linear().col(2), origin = T.translation() + 100 * n;
  const std::vector<Shot> shots = fan(origin, -n);
  const Hits hits = shoot(scene, shots);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const double expected_m = n.dot(T.translation() - origin) / n.dot(shots[i].direction);
    ASSERT_NEAR(hits.t_m[i], expected_m,
                2e-6);  // vertices are floats: 80 m have steps of 8 micrometres along the plane
    EXPECT_EQ(hits.instance[i], 0u);
    EXPECT_NEAR(hits.cos_incidence[i], -n.dot(shots[i].direction), 1e-6);
  }
}

TEST(Tracer, NormalIsOfTheWorldAndTurnedTowardsTheSensorFromBothSides) {
  scenes::Scene scene = tests::empty_scene();
  const core::SE3 T = tests::pose({5, 6, 7}, {1.2, -0.4, 0.8});
  tests::add_instance(scene, tests::square(10), T);
  for (const double side : {1.0, -1.0}) {
    const Vector3d n = side * T.linear().col(2);
    const Hits hits = shoot(scene, {{T.translation() + 3 * n + 0.1 * T.linear().col(0), -n}});
    EXPECT_LT((Vector3d(hits.nx[0], hits.ny[0], hits.nz[0]) - n).norm(), 1e-6);
  }
}

TEST(Tracer, ActorHidesWhatIsBehindItAndIsHiddenByWhatIsBefore) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  const std::int32_t actor = tests::add_actor(scene, motion, 2);
  const std::uint32_t wall = tests::add_instance(scene, tests::box({0.1, 3, 3}), tests::pose({20, 0, 0}));
  const std::uint32_t mover = tests::add_instance(scene, tests::box({1, 1, 1}), tests::pose({0, 0, 0}), actor);
  motion->p0_m = {10, 0, 0};
  EXPECT_EQ(shoot(scene, {{Vector3d::Zero(), Vector3d::UnitX()}}).instance[0], mover);
  motion->p0_m = {30, 0, 0};
  EXPECT_EQ(shoot(scene, {{Vector3d::Zero(), Vector3d::UnitX()}}).instance[0], wall);
  EXPECT_EQ(shoot(scene, {{Vector3d::Zero(), -Vector3d::UnitX()}}).instance[0], Hits::nothing);
}

TEST(Tracer, AcceleratingPlaneIsMetWhereItIsAtTheRaysTime) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  motion->p0_m = {60, 0, 0};
  motion->v_m_s = {-8, 0, 0};
  motion->a_m_s2 = {-6, 0, 0};
  const std::int32_t actor = tests::add_actor(scene, motion, 30);
  tests::add_instance(scene, tests::box({0.5, 20, 20}), tests::pose({0, 0, 0}), actor);
  const std::vector<Shot> shots = fan(Vector3d::Zero(), Vector3d::UnitX());
  const Hits hits = shoot(scene, shots);
  double moved_m = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const double t = shots[i].t_s, face_x = 60 - 8 * t - 3 * t * t - 0.5;
    EXPECT_NEAR(hits.t_m[i], face_x / shots[i].direction.x(), 1e-5);
    moved_m = std::max(moved_m, std::abs(face_x - 59.5));
  }
  EXPECT_GT(moved_m, 0.5);  // frozen at the sweep's begin, the same shots would be wrong by this
}

TEST(Tracer, TurningBoxIsMetAtItsOwnOrientation) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  motion->p0_m = {30, 2, 0};
  motion->v_m_s = {0, 5, 0};
  motion->omega_world_rad_s = {0, 0, 1.5};
  const std::int32_t actor = tests::add_actor(scene, motion, 6);
  // Mounted off the actor's origin and turned: a lever arm under rotation.
  const core::SE3 T_actor_mesh = tests::pose({1.5, 0, 0}, {0, 0, 0.2});
  tests::add_instance(scene, tests::box({2, 3, 3}), T_actor_mesh, actor);
  const std::vector<Shot> shots = fan({0, 2, 0}, Vector3d::UnitX(), 500, 0.04);
  const Hits hits = shoot(scene, shots);
  double frozen_error_m = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto range_to_front = [&](double t_s) {
      const core::SE3 T = motion->T_world_actor(time_from_s(t_s)) * T_actor_mesh;
      const Vector3d n = -T.linear().col(0), on_face = T * Vector3d(-2, 0, 0);
      return n.dot(on_face - shots[i].origin_world) / n.dot(shots[i].direction);
    };
    ASSERT_NE(hits.instance[i], Hits::nothing);
    EXPECT_NEAR(hits.t_m[i], range_to_front(shots[i].t_s), 1e-5) << i;
    frozen_error_m = std::max(frozen_error_m, std::abs(range_to_front(0) - range_to_front(shots[i].t_s)));
  }
  EXPECT_GT(frozen_error_m, 0.05);
}

TEST(Tracer, SilhouetteOfATurningActorIsWhereItIsAtTheRaysTime) {
  // A long bar turning about its middle: its tip sweeps 0.15 m. Rays aimed just inside and just outside of its edge.
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  motion->p0_m = {20, 0, 0};
  motion->omega_world_rad_s = {0.5, 0, 0};  // about the line of sight
  const std::int32_t actor = tests::add_actor(scene, motion, 3.2);
  tests::add_instance(scene, tests::box({0.1, 3, 0.2}), tests::pose({0, 0, 0}), actor);
  std::vector<Shot> shots;
  for (int k = 0; k < 200; ++k)
    for (const double inside_m : {0.5e-3, -0.5e-3}) {
      const double t_s = sweep_s * k / 200;
      const Vector3d edge = motion->T_world_actor(time_from_s(t_s)) * Vector3d(-0.1, 2.9, 0.2 - inside_m);
      shots.push_back({Vector3d::Zero(), edge.normalized(), t_s});
    }
  const Hits hits = shoot(scene, shots);
  for (std::size_t i = 0; i < shots.size(); i += 2) {
    EXPECT_NE(hits.instance[i], Hits::nothing) << i;
    EXPECT_EQ(hits.instance[i + 1], Hits::nothing) << i;
  }
}

TEST(Tracer, ActorBeyondReachIsLeftOut) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  tests::add_instance(scene, tests::box({1, 1, 1}), tests::pose({0, 0, 0}), tests::add_actor(scene, motion, 2));
  const auto shared = std::make_shared<scenes::Scene>(scene);
  const Tracer tracer(shared, {});
  const auto in_range = [&](double x) {
    motion->p0_m = {x, 0, 0};
    return tracer.sweep(time_from_s(0), time_from_s(sweep_s), Vector3d::Zero(), 100).actors_in_range();
  };
  EXPECT_EQ(in_range(101), 1u);
  EXPECT_EQ(in_range(103), 0u);
}

TEST(Tracer, MotionStepsFollowTheInterpolationError) {
  for (const double a : {0.5, 3.0, 40.0, 900.0}) {
    const int n = motion_steps(a, core::duration_from_s(sweep_s));
    const auto error_m = [&](int steps) { return a * sweep_s * sweep_s / (8.0 * (steps - 1) * (steps - 1)); };
    EXPECT_LE(error_m(n), 0.2e-3);
    EXPECT_TRUE(n == 2 || error_m(n - 1) > 0.2e-3) << "one step less would do";
  }
  EXPECT_EQ(motion_steps(0, core::duration_from_s(sweep_s)), 2);
}

TEST(Tracer, ActorTooJerkyForTheMotionStepsIsRefusedByName) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  motion->a_m_s2 = {1e4, 0, 0};
  tests::add_instance(scene, tests::box({1, 1, 1}), tests::pose({0, 0, 0}), tests::add_actor(scene, motion, 2));
  try {
    shoot(scene, {{Vector3d(5, 0, 0), Vector3d::UnitX()}});
    FAIL() << "not refused";
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("actor needs"), std::string::npos) << error.what();
  }
}

TEST(Tracer, SceneThatRefersToNothingIsRefused) {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::square(1), tests::pose({0, 0, 0}));
  scenes::Scene no_material = scene, no_actor = scene;
  no_material.meshes[0].materials[3] = 7;
  no_actor.instances[0].actor = 2;
  EXPECT_THROW(Tracer(std::make_shared<scenes::Scene>(no_material), {}), core::InputError);
  EXPECT_THROW(Tracer(std::make_shared<scenes::Scene>(no_actor), {}), core::InputError);
}

TEST(Tracer, RangesDoNotDependOnTheInstructionSet) {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::sphere(30, 90, 180), tests::pose({40, 0, 0}, {0.3, 0.2, 0.1}));
  const std::vector<Shot> shots = fan(Vector3d::Zero(), Vector3d::UnitX(), 4000, 0.6);
  const Hits pinned = shoot(scene, shots), fast = shoot(scene, shots, {.threads = 2, .fast = true});
  std::size_t met = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    ASSERT_EQ(pinned.instance[i], fast.instance[i]);
    if (pinned.instance[i] == Hits::nothing) continue;
    ++met;
    EXPECT_NEAR(pinned.t_m[i], fast.t_m[i], 1e-9) << i;
  }
  EXPECT_GT(met, 1000u);
}

TEST(Tracer, MicroReliefMovesOnlyWhatIsPavementAndKeepsTheMacroNormal) {
  scenes::Scene scene = tests::empty_scene();
  scene.materials.push_back(tests::grey());
  scene.materials[1].has_relief = true;
  auto relief = std::make_shared<tests::SineRelief>();
  scene.relief = relief;
  const core::SE3 T = tests::pose({0, 0, 0}, {0.01, 0.015, 0});
  tests::add_instance(scene, tests::square(50, 8, 1), T);
  const Vector3d n = T.linear().col(2);
  const std::vector<Shot> shots = fan(Vector3d(-10, 3, 2), Vector3d(1, 0, -0.3).normalized());
  const Hits hits = shoot(scene, shots);
  double largest_m = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Vector3d p = shots[i].origin_world + hits.t_m[i] * shots[i].direction;
    EXPECT_NEAR(n.dot(p), relief->height_m(p.x(), p.y()), 60e-6);
    EXPECT_LT((Vector3d(hits.nx[i], hits.ny[i], hits.nz[i]) - n).norm(), 1e-6);
    largest_m = std::max(largest_m, std::abs(n.dot(p)));
  }
  EXPECT_GT(largest_m, 2e-3);
}

TEST(PackedTiles, MeetWhatTheTracerMeetsAgainAndAgain) {
  scenes::Scene scene = tests::empty_scene();
  const auto motion = std::make_shared<tests::SteadyActor>();
  motion->p0_m = {10, 0, 0};
  const std::int32_t actor = tests::add_actor(scene, motion, 2);
  tests::add_instance(scene, tests::box({0.1, 3, 3}), tests::pose({20, 1, 0}));
  tests::add_instance(scene, tests::box({1, 1, 1}), tests::pose({0, 0, 0}), actor);
  const Tracer tracer(std::make_shared<scenes::Scene>(scene), {});
  const SweepTracer sweep = tracer.sweep(time_from_s(0), time_from_s(sweep_s), Vector3d::Zero(), 150);
  const std::vector<Shot> shots = fan(Vector3d::Zero(), Vector3d::UnitX(), 101, 0.3);
  Rays rays;
  rays.resize(shots.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    rays.dx[i] = shots[i].direction.x(), rays.dy[i] = shots[i].direction.y(), rays.dz[i] = shots[i].direction.z();
    rays.t_ns[i] = static_cast<std::int32_t>(i);
  }
  std::vector<std::uint32_t> order(112, SweepTracer::no_ray);
  std::iota(order.begin(), order.begin() + 101, 0u);
  Hits hits;
  sweep.trace(rays, order, hits);
  const auto met = static_cast<std::size_t>(
      std::count_if(hits.instance.begin(), hits.instance.end(), [](std::uint32_t id) { return id != Hits::nothing; }));
  PackedTiles packed = sweep.pack(rays, order);
  EXPECT_EQ(packed.rays(), 101u);
  for (int round = 0; round < 2; ++round) {
    packed.reset();
    EXPECT_EQ(packed.hits(), 0u);
    packed.intersect();
    EXPECT_EQ(packed.hits(), met);
  }
  EXPECT_GT(met, 10u);  // some of the fan, not all of it
  EXPECT_LT(met, 101u);
}

TEST(Tracer, RaysThatNoTileHoldsMeetNothing) {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::box({1, 50, 50}), tests::pose({20, 0, 0}));
  const Tracer tracer(std::make_shared<scenes::Scene>(scene), {});
  const SweepTracer sweep = tracer.sweep(time_from_s(0), time_from_s(sweep_s), Vector3d::Zero(), 150);
  Rays rays;
  rays.resize(2);
  rays.dx = {1, 1};
  std::vector<std::uint32_t> order(16, SweepTracer::no_ray);
  order[0] = 1;
  Hits hits;
  sweep.trace(rays, order, hits);
  EXPECT_EQ(hits.instance[0], Hits::nothing);
  EXPECT_EQ(hits.t_m[0], std::numeric_limits<double>::infinity());
  EXPECT_NEAR(hits.t_m[1], 19, 1e-9);
}

}  // namespace
}  // namespace tarmac::sim::raycast
