// Noise-free points, put into the world by the exact pose at their own firing times, lie on the surfaces that they hit.
#include <gtest/gtest.h>

#include "sim/lidar/sweep_simulator.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim::lidar {
namespace {

using core::SE3;
using Eigen::Vector3d;

NoiseOptions no_noise() {
  return {.range_scale = 0, .channel_bias_scale = 0, .quantisation = false, .dropout = false, .intensity = false};
}

const SE3 T_body_lidar = tests::pose({0.7, -0.2, 1.9}, {0.02, 0.03, -0.5});

struct WorldPoint {
  Vector3d p_world, origin_world;
  core::Time t;
  std::uint32_t instance;
  double range_m() const { return (p_world - origin_world).norm(); }
};

/// All points of sweeps 0 .. sweeps-1 of `sensor`, each placed by the pose at its own time.
std::vector<WorldPoint> placed(const std::string& sensor, scenes::Scene scene, const tests::SteadyMotion& motion,
                               int sweeps = 1) {
  const auto shared_scene = std::make_shared<const scenes::Scene>(std::move(scene));
  const auto tracer = std::make_shared<const raycast::Tracer>(shared_scene, raycast::TracerSettings{});
  const Profile& p = profile(sensor);
  const SweepSimulator simulator(p, mode_of(p, 0, 0), {.sensor = 0, .T_body_lidar = T_body_lidar}, no_noise(), 1,
                                 tracer, shared_scene, std::make_shared<tests::SteadyMotion>(motion));
  std::vector<WorldPoint> points;
  for (int k = 0; k < sweeps; ++k) {
    const SimulatedSweep simulated = simulator.sweep(k);
    for (std::size_t i = 0; i < simulated.sweep.size(); ++i) {
      const core::Time t = simulated.sweep.time(i);
      const SE3 T_world_lidar = motion.pose(t) * T_body_lidar;
      points.push_back(
          {T_world_lidar * simulated.sweep.point(i), T_world_lidar.translation(), t, simulated.instance[i]});
    }
  }
  return points;
}

class ExactSurfaces : public testing::TestWithParam<std::string> {};

TEST_P(ExactSurfaces, PlaneAHundredMetresOff) {
  scenes::Scene scene = tests::empty_scene();
  const SE3 T = tests::pose({700, -300, 20}, {0.2, -M_PI / 2 + 0.1, 0.1});
  tests::add_instance(scene, tests::square(150, 12), T);
  const Vector3d n = T.linear().col(2);
  const tests::SteadyMotion motion = tests::fast_turn(T.translation() + (n.x() < 0 ? 95 : -95) * n);
  const auto points = placed(GetParam(), scene, motion, 3);
  ASSERT_GT(points.size(), 2000u);
  double farthest_m = 0;
  for (const WorldPoint& point : points) {
    ASSERT_LT(std::abs(n.dot(point.p_world - T.translation())), 0.1e-3);  // 0.5 mm is what is promised
    farthest_m = std::max(farthest_m, point.range_m());
  }
  EXPECT_GT(farthest_m, 99);
}

TEST_P(ExactSurfaces, SphereAHundredMetresOff) {
  scenes::Scene scene = tests::empty_scene();
  constexpr double radius_m = 6;
  const Vector3d centre(-250, 480, 15);
  tests::add_instance(scene, tests::sphere(radius_m, 220, 440), tests::pose(centre, {0.4, 0.1, 0}));
  const auto points = placed(GetParam(), scene, tests::fast_turn(centre - Vector3d(85, 25, 3)), 4);
  // Facets lie inside the sphere by at most their sagitta: edges of 2 pi r / 440, corner to middle 1/sqrt(2) of it.
  const double corner_m = 2 * M_PI * radius_m / 440 / std::sqrt(2.0), sagitta_m = corner_m * corner_m / (2 * radius_m);
  ASSERT_LT(sagitta_m, 0.4e-3);
  ASSERT_GT(points.size(), 50u);
  for (const WorldPoint& point : points) {
    const double outside_m = (point.p_world - centre).norm() - radius_m;
    EXPECT_LT(outside_m, 0.05e-3);
    EXPECT_GT(outside_m, -sagitta_m - 0.05e-3);
  }
}

TEST_P(ExactSurfaces, CylinderFromInside) {
  scenes::Scene scene = tests::empty_scene();
  constexpr double radius_m = 30;
  const SE3 T = tests::pose({120, 60, -30}, {0.1, M_PI / 2 - 0.3, 0});
  tests::add_instance(scene, tests::cylinder(radius_m, 200, 4, 2400), T);
  const auto points = placed(GetParam(), scene, tests::fast_turn(T * Vector3d(3, -4, 10)), 1);
  const double sagitta_m = radius_m * (1 - std::cos(M_PI / 2400));
  ASSERT_LT(sagitta_m, 0.03e-3);
  ASSERT_GT(points.size(), 10000u);
  double farthest_m = 0;
  for (const WorldPoint& point : points) {
    const double error_m = (T.inverse() * point.p_world).head<2>().norm() - radius_m;
    ASSERT_LT(std::abs(error_m), sagitta_m + 0.05e-3);
    farthest_m = std::max(farthest_m, point.range_m());
  }
  EXPECT_GT(farthest_m, 90);
}

TEST_P(ExactSurfaces, PavementWithRelief) {
  scenes::Scene scene = tests::empty_scene();
  scene.materials[0].has_relief = true;
  const auto relief = std::make_shared<tests::SineRelief>();
  scene.relief = relief;
  tests::add_instance(scene, tests::square(200, 8), tests::pose({0, 0, 0}));
  tests::SteadyMotion motion = tests::fast_turn({3, -5, 0});
  motion.v_m_s.z() = 0;
  const auto points = placed(GetParam(), scene, motion, 1);
  ASSERT_GT(points.size(), 3000u);
  double macro_error_m = 0;
  for (const WorldPoint& point : points) {
    if (std::abs(point.p_world.z() - point.origin_world.z()) < 0.011 * point.range_m())
      continue;  // grazing: relief is left out
    EXPECT_NEAR(point.p_world.z(), relief->height_m(point.p_world.x(), point.p_world.y()), 0.1e-3);
    macro_error_m = std::max(macro_error_m, std::abs(point.p_world.z()));
  }
  EXPECT_GT(macro_error_m, 1e-3);
}

TEST_P(ExactSurfaces, TurningAndBrakingVehicle) {
  scenes::Scene scene = tests::empty_scene();
  const auto drive = std::make_shared<tests::SteadyActor>();
  drive->p0_m = {25, 8, 1.5};
  drive->v_m_s = {-9, 4, 0};
  drive->a_m_s2 = {5, 1, 0};
  drive->omega_world_rad_s = {0, 0, 0.8};
  const std::int32_t actor = tests::add_actor(scene, drive, 7);
  const Vector3d half(4, 2.5, 3);
  tests::add_instance(scene, tests::box(half), tests::pose({1, 0, 0}), actor);
  const auto points = placed(GetParam(), scene, tests::fast_turn({0, 0, 0}), 4);
  ASSERT_GT(points.size(), 200u);
  double frozen_m = 0;
  for (const WorldPoint& point : points) {
    const auto distance_to_box = [&](core::Time t) {
      const Vector3d q = (drive->T_world_actor(t) * tests::pose({1, 0, 0})).inverse() * point.p_world;
      return (q.cwiseAbs() - half).maxCoeff();
    };
    EXPECT_NEAR(distance_to_box(point.t), 0, 0.1e-3);
    frozen_m = std::max(frozen_m, std::abs(distance_to_box(core::Time{})));
  }
  EXPECT_GT(frozen_m, 0.5);  // where it was at the start, it is not
}

TEST(ExactSurfacesBehindPrisms, CylinderFromInside) {
  scenes::Scene scene = tests::empty_scene();
  constexpr double radius_m = 30;
  const SE3 T = tests::pose({120, 60, -30}, {0.1, M_PI / 2 - 0.3, 0});
  tests::add_instance(scene, tests::cylinder(radius_m, 600, 4, 2400), T);
  const auto points = placed("livox-mid-40", scene, tests::fast_turn(T * Vector3d(3, -4, 10)), 3);
  const double sagitta_m = radius_m * (1 - std::cos(M_PI / 2400));
  ASSERT_GT(points.size(), 10000u);
  for (const WorldPoint& point : points)
    ASSERT_LT(std::abs((T.inverse() * point.p_world).head<2>().norm() - radius_m), sagitta_m + 0.05e-3);
}

/// Sensors with a head that turns see all around; the other looks ahead only.
std::vector<std::string> spinning_sensors() {
  std::vector<std::string> names = profile_names();
  std::erase_if(names, [](const std::string& name) { return profile(name).by_prism(); });
  return names;
}

INSTANTIATE_TEST_SUITE_P(Sensors, ExactSurfaces, testing::ValuesIn(spinning_sensors()), [](const auto& instance) {
  std::string name = instance.param;
  std::erase(name, '-');
  return name;
});

TEST(SweepSimulator, PlacingAllPointsByOnePoseWouldMissTheSurfaceByDecimetres) {
  // The counter-check of the tests above: they could not pass with the pose frozen at the sweep's begin.
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::square(150, 12), tests::pose({50, 0, 0}, {0, -M_PI / 2, 0}));
  const tests::SteadyMotion motion = tests::fast_turn({0, 0, 0});
  double worst_m = 0;
  for (const WorldPoint& point : placed("ouster-os1-64-gen2", scene, motion)) {
    const Vector3d p_lidar = (motion.pose(point.t) * T_body_lidar).inverse() * point.p_world;
    worst_m = std::max(worst_m, std::abs((motion.pose(core::Time{}) * T_body_lidar * p_lidar).x() - 50));
  }
  EXPECT_GT(worst_m, 0.5);
}

TEST(SweepSimulator, SweepIsTheSameInWhateverOrderItIsMade) {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::square(150, 12), tests::pose({50, 0, 0}, {0, -M_PI / 2, 0}));
  const auto shared_scene = std::make_shared<const scenes::Scene>(scene);
  const auto tracer = std::make_shared<const raycast::Tracer>(shared_scene, raycast::TracerSettings{});
  const Profile& p = profile("vlp-16");
  const auto motion = std::make_shared<tests::SteadyMotion>(tests::fast_turn({0, 0, 0}));
  const SweepSimulator simulator(p, mode_of(p, 0, 0), {}, {}, 7, tracer, shared_scene, motion);
  const SimulatedSweep alone = simulator.sweep(3);
  simulator.sweep(5);
  const SimulatedSweep again = simulator.sweep(3);
  ASSERT_GT(alone.sweep.size(), 1000u);
  EXPECT_EQ(alone.sweep.x_m, again.sweep.x_m);
  EXPECT_EQ(alone.sweep.intensity, again.sweep.intensity);
  EXPECT_EQ(alone.instance, again.instance);
}

}  // namespace
}  // namespace tarmac::sim::lidar
