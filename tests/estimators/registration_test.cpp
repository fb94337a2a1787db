#include "estimators/kiss_icp/registration.h"

#include <gtest/gtest.h>

#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using Eigen::Vector3d;

VoxelMap map_of(const std::vector<Vector3d>& points) {
  VoxelMap map(1.0, 20);
  for (const Vector3d& p : points) map.add(p);
  return map;
}

std::vector<Vector3d> seen_from(const SE3& T_map_lidar, const std::vector<Vector3d>& points) {
  std::vector<Vector3d> seen;
  for (const Vector3d& p : points) seen.push_back(T_map_lidar.inverse() * p);
  return seen;
}

TEST(Registration, FindsThePoseThatPutsThePointsOntoTheMap) {
  const std::vector<Vector3d> world = tests::landmarks(20, 3, 0.5);
  const SE3 truth = tests::some_pose(0.01, 0.3);
  Registration registration({});
  const IcpResult result = registration.align(seen_from(truth, world), map_of(world), SE3::Identity(), 1.0);
  EXPECT_TRUE(result.solved);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(tests::pose_difference(result.T_map_lidar, truth), 1e-6);
}

TEST(Registration, IsAsGoodFarFromTheMapsOrigin) {
  SE3 far = SE3::Identity();
  far.translation() << 20000, -7000, 300;
  std::vector<Vector3d> world = tests::landmarks(20, 3, 0.5);
  for (Vector3d& p : world) p = far * p;
  const SE3 truth = far * tests::some_pose(0.01, 0.3);
  Registration registration({});
  const IcpResult result = registration.align(seen_from(truth, world), map_of(world), far, 1.0);
  EXPECT_TRUE(result.solved);
  EXPECT_LT(tests::pose_difference(result.T_map_lidar, truth), 1e-5);
}

TEST(Registration, AnEmptyMapGivesThePredictionBack) {
  Registration registration({});
  const SE3 predicted = tests::some_pose();
  const IcpResult result = registration.align(tests::landmarks(10, 3, 0.5), VoxelMap(1, 20), predicted, 1.0);
  EXPECT_TRUE(result.solved);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.T_map_lidar.matrix(), predicted.matrix());
}

/// r = 3 sigma exactly is out, a hair less is in; and the weights are upstream's, sigma not squared.
TEST(Registration, MatchesStrictlyWithinThreeSigmaAndWeighsByTheUnsquaredScale) {
  const double sigma_m = 0.2;
  std::vector<Vector3d> world, source;
  for (int k = 0; k < 8; ++k) world.emplace_back(4 * k + 0.5, (k % 3) * 4 + 0.5, (k % 2) * 4 + 0.5);
  for (const Vector3d& p : world) source.push_back(p + Vector3d(0, 0, 0.1));
  source[0] = world[0] + Vector3d(0, 3 * sigma_m * (1 + 1e-9), 0);
  source[1] = world[1] + Vector3d(0, 3 * sigma_m * (1 - 1e-9), 0);
  Registration registration({.max_iterations = 1});
  const IcpResult result = registration.align(source, map_of(world), SE3::Identity(), sigma_m);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_FALSE(result.converged);
  const std::vector<Match>& matches = registration.matches();
  const auto weight = [&](double r_m) { return std::pow(sigma_m / (sigma_m + r_m * r_m), 2); };
  EXPECT_EQ(matches[0].weight, 0);
  EXPECT_NEAR(matches[1].weight, weight(3 * sigma_m), 1e-6);
  EXPECT_NEAR(matches[2].weight, weight(0.1), 1e-12);
  EXPECT_LT((matches[2].residual_m - Vector3d(0, 0, 0.1)).norm(), 1e-12);
}

TEST(Registration, TooFewOrCollinearPartnersKeepThePrediction) {
  const SE3 predicted = tests::some_pose(1e-3, 0.05);
  std::vector<Vector3d> line, triangle;
  for (int k = 0; k < 12; ++k) line.push_back(Vector3d(0.5, 0.5, 0.5) + 2.1 * k * Vector3d(0.6, 0.8, 0));
  triangle = {{0.5, 0.5, 0.5}, {8.5, 0.5, 0.5}, {0.5, 8.5, 0.5}};
  Registration registration({});
  const auto solved = [&](const std::vector<Vector3d>& world, std::size_t count) {
    const std::vector<Vector3d> seen(world.begin(), world.begin() + static_cast<std::ptrdiff_t>(count));
    const IcpResult result = registration.align(seen, map_of(world), predicted, 1.0);
    if (!result.solved) {
      EXPECT_EQ(result.T_map_lidar.matrix(), predicted.matrix());
      EXPECT_FALSE(result.converged);
    }
    return result.solved;
  };
  EXPECT_FALSE(solved(line, 12));
  EXPECT_FALSE(solved(triangle, 2));
  EXPECT_FALSE(solved(triangle, 0));
  EXPECT_TRUE(solved(triangle, 3));
}

TEST(Registration, StopsAtTheIterationLimit) {
  const std::vector<Vector3d> world = tests::landmarks(20, 3, 0.5);
  Registration registration({.max_iterations = 2, .convergence = 1e-12});
  const IcpResult result =
      registration.align(seen_from(tests::some_pose(0.01, 0.3), world), map_of(world), SE3::Identity(), 1.0);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.solved);
}

}  // namespace
}  // namespace tarmac::estimators
