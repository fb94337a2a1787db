#include "scenes/stand/tug.h"

#include <gtest/gtest.h>

#include <iostream>

#include "core/random.h"
#include "scenes/stand/layout.h"
#include "tests/scenes/support.h"

namespace tarmac::scenes {
namespace {

using core::time_from_s;
using Eigen::Vector2d;
using Eigen::Vector3d;

const Actor& tug() {
  return tests::default_stand().actors.at(0);
}
core::SE3 pose(double t_s) {
  return tug().motion->T_world_actor(time_from_s(t_s));
}

/// Corners and edge points of the tug's outline in its own frame.
std::vector<Vector3d> outline_of_tug() {
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  const Scene& scene = tests::default_stand();
  for (const Instance& i : scene.instances) {
    if (i.actor != 0) continue;
    for (const Eigen::Vector3f& p : scene.meshes[i.mesh].vertices) {
      low = low.cwiseMin(p.cast<double>());
      high = high.cwiseMax(p.cast<double>());
    }
  }
  std::vector<Vector3d> points;
  for (int k = 0; k <= 8; ++k) {
    const double s = k / 8.0;
    const Vector3d d = high - low;
    for (const double side : {0.0, 1.0}) {
      points.push_back(low + Vector3d(s * d.x(), side * d.y(), 0));
      points.push_back(low + Vector3d(side * d.x(), s * d.y(), 0));
    }
  }
  return points;
}

TEST(Tug, DrivesThroughTheStandWithinTheFirstSeventySeconds) {
  EXPECT_GT(pose(0).translation().x(), 90);
  EXPECT_LT(pose(70).translation().x(), -90);
  int inside = 0;
  for (double t = 0; t < 70; t += 0.5) inside += std::abs(pose(t).translation().x()) < 30;
  EXPECT_GT(inside, 20) << "half seconds behind the aircraft";
}

TEST(Tug, PointsAlongItsPathAndStandsOnTheGround) {
  const Ground& ground = *tests::default_stand().ground;
  for (double t = 4; t < 58; t += 1.37) {
    const Vector3d v = (pose(t + 1e-3).translation() - pose(t - 1e-3).translation()) / 2e-3;
    const core::SE3 T = pose(t);
    EXPECT_NEAR(T.linear().col(0).dot(v.normalized()), 1, 1e-6) << t;
    EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
    EXPECT_LT((T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    for (const double x : {0.80, -0.69}) {
      for (const double y : {-0.68, 0.68}) {
        const Vector3d wheel = T * Vector3d(x, y, 0);
        EXPECT_LT(std::abs(wheel.z() - ground.height_m(wheel.x(), wheel.y())), 0.005);
      }
    }
  }
}

TEST(Tug, CruisesAtItsSpeedAndStartsAndStopsSmoothly) {
  const auto speed = [](double t) {
    return (pose(t + 0.01).translation() - pose(t - 0.01).translation()).norm() / 0.02;
  };
  EXPECT_LT(speed(0.1), 0.01);
  EXPECT_NEAR(speed(6), 2, 0.02) << "half speed at its start time";
  EXPECT_NEAR(speed(30), 4, 0.02);
  EXPECT_LT(speed(70), 0.01);
}

TEST(Tug, AccelerationBoundHoldsAndIsNotIdle) {
  const core::RandomStream random(3, "test/tug");
  const double h = 0.02, span = 0.1;
  double worst_share = 0;
  for (std::uint64_t k = 0; k < 700; ++k) {
    const double t0 = 0.1 * static_cast<double>(k);
    const double radius = 3;
    const Vector3d p = radius * Vector3d(random.normal(k, 0), random.normal(k, 1), random.normal(k, 2)).normalized();
    const double bound = tug().motion->acceleration_bound_m_s2(time_from_s(t0), time_from_s(t0 + span), radius);
    for (double t = t0 + h; t <= t0 + span - h; t += 0.02) {
      const Vector3d a = (pose(t + h) * p - 2 * (pose(t) * p) + pose(t - h) * p) / (h * h);
      EXPECT_LE(a.norm(), bound + 1e-9) << t;
      worst_share = std::max(worst_share, a.norm() / bound);
    }
  }
  EXPECT_GT(worst_share, 0.6) << "a bound that is never nearly reached tells nothing";
  EXPECT_EQ(tug().motion->acceleration_bound_m_s2(time_from_s(600), time_from_s(600.1), 3), 0);
}

TEST(Tug, RadiusHoldsItsMeshes) {
  const Scene& scene = tests::default_stand();
  double farthest = 0;
  for (const Instance& i : scene.instances) {
    if (i.actor != 0) continue;
    for (const Eigen::Vector3f& p : scene.meshes[i.mesh].vertices)
      farthest = std::max(farthest, (i.T_parent_mesh * p.cast<double>()).norm());
  }
  EXPECT_GE(tug().radius_m, farthest);
  EXPECT_LT(tug().radius_m, farthest + 0.01);
}

TEST(Tug, KeepsThreeMetresFromEverythingStaticAndClearOfTheCorridor) {
  const Scene& scene = tests::default_stand();
  std::vector<std::vector<Vector2d>> obstacles;
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return !tests::on_the_ground(i.label); },
      [&](const Instance&, const tests::Triangle& t) {
        const auto outline = tests::outline_between(t, *scene.ground, 0.05, 4);
        if (!outline.empty() && tests::distance_to_outline({outline[0].x(), layout::tug_y_m}, outline) < 40)
          obstacles.push_back(outline);
      });
  ASSERT_GT(obstacles.size(), 100u);
  const std::vector<Vector3d> tug_outline = outline_of_tug();
  const auto corridor = layout::corridor_centre_line(1.0);
  double nearest = 1e9, to_corridor = 1e9;
  for (double t = 0; t <= 70; t += 2.5) {
    const core::SE3 T = pose(t);
    for (const Vector3d& p : tug_outline) {
      const Vector2d q = (T * p).head<2>();
      for (const auto& outline : obstacles) {
        if (std::abs(outline[0].x() - q.x()) - 45 < nearest)
          nearest = std::min(nearest, tests::distance_to_outline(q, outline));
      }
      for (const Vector2d& c : corridor) to_corridor = std::min(to_corridor, (c - q).norm());
    }
  }
  std::cout << "tug: " << nearest << " m to static geometry, " << to_corridor << " m to the corridor's centre line\n";
  EXPECT_GE(nearest, 3);
  EXPECT_GE(to_corridor, layout::corridor_width_m / 2 + 1);
}

}  // namespace
}  // namespace tarmac::scenes
