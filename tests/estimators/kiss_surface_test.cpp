/// Point-to-surface rows against a room whose walls are known.
#include <gtest/gtest.h>

#include <cmath>

#include "estimators/blocks/local_plane.h"
#include "estimators/kiss_icp/record.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::Vector6;
using Eigen::Vector3d;

/// Points on four walls and a floor of a room, seen from its inside, a grid of 0.4 m.
std::vector<Vector3d> room() {
  std::vector<Vector3d> points;
  for (double u = -7.8; u < 8; u += 0.4) {
    for (double h = -1.8; h < 3; h += 0.4) {
      points.emplace_back(8, u, h);
      points.emplace_back(-8, u, h);
      points.emplace_back(u, 8, h);
      points.emplace_back(u, -8, h);
    }
    for (double v = -7.8; v < 8; v += 0.4) points.emplace_back(u, v, -2);
  }
  return points;
}

class KissSurface : public testing::Test {
 protected:
  KissSurface() {
    Vector6 twist;
    twist << 0.4, 0.1, 0.02, 0.01, -0.02, 0.1;
    const tests::Motion motion = tests::constant_twist(twist);
    odometry_.look_for_surfaces();
    for (int k = 0; k < 13; ++k) {
      sweep_ = tests::sweep_at(k, room(), motion, {.noise_m = 0.003});
      step_ = odometry_.add(sweep_);
    }
    record_ = record_of(sweep_, odometry_, step_, T_body_lidar_.inverse(), core::DiagnosticsLevel::full);
  }

  SE3 T_body_lidar_ = tests::some_pose();
  KissOdometry odometry_{KissIcpOptions{}};
  core::LidarSweep sweep_;
  KissOdometry::Step step_;
  core::SweepDiagnostics record_;
};

TEST_F(KissSurface, MostOfARoomIsPlanesAndPointsLieOnThem) {
  ASSERT_EQ(record_.surface.size(), step_.surface.size());
  ASSERT_GT(record_.surface.size(), 500U);
  EXPECT_FALSE(record_.rows_are_surface);
  double sum2 = 0;
  for (const core::ResidualRow& row : record_.surface) sum2 += double{row.value} * row.value;
  // A plane through points with 3 mm of noise, a point with the same, and the registration's own error; the map's
  // oldest points were placed before the motion was known.
  EXPECT_LT(std::sqrt(sum2 / static_cast<double>(record_.surface.size())), 0.03);
}

TEST_F(KissSurface, RowsCarryTimePointAndTheJacobianByThePoseAtTheirOwnTime) {
  for (std::size_t k = 0; k < step_.surface.size(); ++k) {
    const auto& [i, plane] = step_.surface[k];
    const core::ResidualRow& row = record_.surface[k];
    EXPECT_EQ(row.point, i);
    EXPECT_EQ(row.t_ns, sweep_.t_ns[i]);
    const SE3 T = step_.icp.T_map_lidar_linearised * step_.motion.T_end_point(sweep_.t_ns[i]) * T_body_lidar_.inverse();
    const Vector3d p_body = T_body_lidar_ * sweep_.point(i), sensor = (T * T_body_lidar_).translation();
    const Vector3d n = plane.normal.dot(sensor - T * p_body) > 0 ? plane.normal : Vector3d(-plane.normal);
    const auto residual = [&](const Vector6& xi) {
      return Eigen::Matrix<double, 1, 1>(n.dot(T * core::se3::exp(xi) * p_body - plane.centre));
    };
    EXPECT_NEAR(row.value, residual(Vector6::Zero())[0], 1e-6);
    const auto J = tests::numeric_jacobian<1, 6>(residual, Vector6(Vector6::Zero()));
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(row.jacobian[c], J(0, c), 1e-4);
  }
}

/// A sweep is measured against the map of a second ago, and never against its own points.
TEST(KissSurfaces, OnlyPointsThatAreOldEnoughCount) {
  KissOdometry odometry{KissIcpOptions{}};
  odometry.look_for_surfaces();
  for (int k = 0; k < 12; ++k) {
    const auto step = odometry.add(tests::sweep_at(k, room(), tests::still()));
    EXPECT_EQ(step.surface.empty(), k < KissOdometry::kSurfaceAge) << k;
  }
}

TEST(LocalPlane, FindsThePlaneAndRefusesLinesEdgesAndThickClouds) {
  std::vector<Vector3d> plane, line, edge, cloud;
  const core::RandomStream random(1, "test/local_plane");
  const Vector3d n = Vector3d(1, 2, -2) / 3, a = n.unitOrthogonal(), b = n.cross(a);
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double u = random.uniform(k, 0) - 0.5, v = random.uniform(k, 1) - 0.5, w = 0.01 * random.normal(k, 2);
    plane.emplace_back(Vector3d(5, 6, 7) + u * a + v * b + w * n);
    line.emplace_back(u * a + w * n + 0.01 * random.normal(k, 3) * b);
    edge.emplace_back(u * a + (k % 2 == 0 ? v * b : v * n));
    cloud.emplace_back(u * a + v * b + (random.uniform(k, 4) - 0.5) * n);
  }
  const std::optional<LocalPlane> found = fit_plane(plane, 0.05);
  ASSERT_TRUE(found);
  // The normal's tilt: noise over the lever, 0.01 / (0.29 sqrt(60)) rad.
  EXPECT_GT(std::abs(found->normal.dot(n)), std::cos(4 * 0.01 / (0.29 * std::sqrt(60.0))));
  EXPECT_NEAR(found->thickness_m, 0.01, 4 * 0.01 / std::sqrt(120.0));
  EXPECT_NEAR((found->centre - Vector3d(5, 6, 7)).dot(n), 0, 4 * 0.01 / std::sqrt(60.0));
  EXPECT_FALSE(fit_plane(line, 0.05));
  EXPECT_FALSE(fit_plane(edge, 0.05));
  EXPECT_FALSE(fit_plane(cloud, 0.05));
  plane.resize(5);
  EXPECT_FALSE(fit_plane(plane, 0.05));
}

}  // namespace
}  // namespace tarmac::estimators
