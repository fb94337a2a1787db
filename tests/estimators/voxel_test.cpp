#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "core/random.h"
#include "estimators/blocks/voxel_map.h"
#include "estimators/blocks/voxel_sampler.h"

namespace tarmac::estimators {
namespace {

using Eigen::Vector3d;
using Key = std::tuple<int, int, int>;

std::vector<Vector3d> cloud(std::size_t n, double half_width_m, const char* name) {
  const core::RandomStream random(3, name);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < n; ++i) {
    Vector3d p;
    for (unsigned k = 0; k < 3; ++k) p[k] = half_width_m * (2 * random.uniform(i, k) - 1);
    points.push_back(p);
  }
  return points;
}

Key key(const Vector3d& p, double cell) {
  return {static_cast<int>(std::floor(p.x() / cell)), static_cast<int>(std::floor(p.y() / cell)),
          static_cast<int>(std::floor(p.z() / cell))};
}

std::vector<std::uint32_t> all_of(const std::vector<Vector3d>& points) {
  std::vector<std::uint32_t> indices(points.size());
  for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  return indices;
}

TEST(Voxel, FloorsTowardsMinusInfinityAlsoOnTheFaces) {
  for (double v : {-3.0, -2.5, -1.0, -1e-12, 0.0, 0.5, 1.0, 7.999999}) {
    EXPECT_EQ(floor_to_int(v), static_cast<int>(std::floor(v))) << v;
  }
}

TEST(Voxel, RefusesWhatCannotBeCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has_voxel({1, 2, 3}, 0.5));
  for (const double bad : {nan, inf, -inf, 1e12}) {
    EXPECT_FALSE(has_voxel({bad, 0, 0}, 0.5));
    EXPECT_FALSE(has_voxel({0, bad, 0}, 0.5));
    EXPECT_FALSE(has_voxel({0, 0, bad}, 0.5));
  }
}

TEST(VoxelSampler, KeepsTheFirstPointOfEveryVoxelAndNothingElse) {
  const std::vector<Vector3d> points = cloud(20000, 8, "test/sampler");
  std::map<Key, std::uint32_t> first;
  for (std::uint32_t i = 0; i < points.size(); ++i) first.try_emplace(key(points[i], 0.5), i);
  VoxelSampler sampler;
  std::vector<std::uint32_t> kept;
  sampler.sample(points, all_of(points), 0.5, kept);
  std::set<std::uint32_t> expected;
  for (const auto& [voxel, i] : first) expected.insert(i);
  EXPECT_EQ(kept.size(), expected.size());
  EXPECT_EQ(std::set<std::uint32_t>(kept.begin(), kept.end()), expected);
}

TEST(VoxelSampler, TheSecondSampleIsASubsetOfTheFirstAndIsFirstComeInItsOrder) {
  const std::vector<Vector3d> points = cloud(20000, 8, "test/sampler");
  VoxelSampler sampler;
  std::vector<std::uint32_t> fine, coarse;
  sampler.sample(points, all_of(points), 0.5, fine);
  sampler.sample(points, fine, 1.5, coarse);
  std::map<Key, std::uint32_t> first;
  for (const std::uint32_t i : fine) first.try_emplace(key(points[i], 1.5), i);
  EXPECT_EQ(coarse.size(), first.size());
  for (const std::uint32_t i : coarse) EXPECT_EQ(first.at(key(points[i], 1.5)), i);
}

TEST(VoxelSampler, IsTheSameAfterALargerCloudWentThrough) {
  const std::vector<Vector3d> small = cloud(500, 4, "test/small"), large = cloud(30000, 20, "test/large");
  VoxelSampler fresh, used;
  std::vector<std::uint32_t> expected, kept;
  fresh.sample(small, all_of(small), 0.5, expected);
  used.sample(large, all_of(large), 0.5, kept);
  used.sample(small, all_of(small), 0.5, kept);
  EXPECT_EQ(kept, expected);
}

TEST(VoxelSampler, NothingInNothingOut) {
  VoxelSampler sampler;
  std::vector<std::uint32_t> kept{1, 2, 3};
  sampler.sample({}, {}, 0.5, kept);
  EXPECT_TRUE(kept.empty());
}

class FilledMap : public testing::Test {
 protected:
  FilledMap() {
    for (const Vector3d& p : cloud(40000, 9, "test/map")) map_.add(p);
  }
  VoxelMap map_{1.0, 20};
};

TEST_F(FilledMap, NoVoxelHoldsMoreThanItsShareNorTwoPointsTooNear) {
  ASSERT_GT(map_.voxel_count(), 1000U);
  for (const std::vector<Vector3d>& points : map_.voxels()) {
    ASSERT_LE(points.size(), 20U);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(key(points[i], 1), key(points[0], 1));
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((points[i] - points[j]).norm(), 1 / std::sqrt(20.0));
    }
  }
}

TEST(VoxelMap, StopsAtTheLimitEvenWherePointsAreFarApart) {
  VoxelMap map(1.0, 3);  // spacing 0.577 m: the corners of a voxel are farther apart
  const Vector3d corners[] = {{0.05, 0.05, 0.05}, {0.95, 0.05, 0.05}, {0.05, 0.95, 0.05}, {0.05, 0.05, 0.95}};
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(map.add(corners[k]));
  EXPECT_FALSE(map.add(corners[3]));
  EXPECT_EQ(map.voxels().at(0).size(), 3U);
}

TEST(VoxelMap, LooksOnlyIntoThePointsOwnVoxelForOnesTooNear) {
  VoxelMap map(1.0, 20);
  EXPECT_TRUE(map.add({0.999, 0.5, 0.5}));
  EXPECT_FALSE(map.add({0.998, 0.5, 0.5}));
  EXPECT_TRUE(map.add({1.001, 0.5, 0.5}));
}

TEST(VoxelMap, LeavesOutPointsThatHaveNoVoxel) {
  VoxelMap map(1.0, 20);
  EXPECT_FALSE(map.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  EXPECT_FALSE(map.add({1e10, 0, 0}));
  EXPECT_TRUE(map.empty());
  EXPECT_FALSE(map.nearest({1e10, 0, 0}, 100).found);
}

/// All points of the 27 voxels around q, the slow way.
VoxelMap::Neighbour brute_force(const VoxelMap& map, const Vector3d& q, double below_m2) {
  VoxelMap::Neighbour best;
  best.distance2_m2 = below_m2;
  const auto [x, y, z] = key(q, 1);
  for (const std::vector<Vector3d>& points : map.voxels()) {
    const auto [vx, vy, vz] = key(points[0], 1);
    if (std::abs(vx - x) > 1 || std::abs(vy - y) > 1 || std::abs(vz - z) > 1) continue;
    for (const Vector3d& p : points) {
      if ((p - q).squaredNorm() < best.distance2_m2) best = {true, (p - q).squaredNorm(), p};
    }
  }
  return best;
}

void expect_exact_search(const VoxelMap& map, double half_width_m) {
  const std::vector<Vector3d> queries = cloud(120, half_width_m, "test/queries");
  Vector3d last_found = Vector3d::Zero();
  for (const Vector3d& q : queries) {
    for (const double below_m2 : {36.0, 0.04}) {
      const VoxelMap::Neighbour expected = brute_force(map, q, below_m2);
      // No hint, a useless one and the best one: the answer is the same.
      for (const Vector3d* hint : std::initializer_list<const Vector3d*>{nullptr, &last_found, &expected.point}) {
        if (hint == &expected.point && !expected.found) continue;
        const VoxelMap::Neighbour found = map.nearest(q, below_m2, hint);
        ASSERT_EQ(found.found, expected.found);
        if (!found.found) continue;
        EXPECT_EQ(found.point, expected.point);
        EXPECT_NEAR(found.distance2_m2, expected.distance2_m2, 1e-15);
      }
      if (expected.found) last_found = expected.point;
    }
  }
}

TEST_F(FilledMap, FindsTheNearestPointOfThe27Voxels) {
  expect_exact_search(map_, 10);
}

TEST(VoxelMap, FindsTheNearestPointOfASparseMap) {
  VoxelMap map(1.0, 20);
  for (const Vector3d& p : cloud(800, 9, "test/sparse")) map.add(p);
  expect_exact_search(map, 10);
}

TEST(VoxelMap, DoesNotSeeBeyondThe27Voxels) {
  VoxelMap map(1.0, 20);
  map.add({2.01, 0.5, 0.5});
  EXPECT_FALSE(map.nearest({0.99, 0.5, 0.5}, 100).found);
  EXPECT_TRUE(map.nearest({1.01, 0.5, 0.5}, 100).found);
}

TEST_F(FilledMap, DropsVoxelsWhoseFirstPointIsFarAndKeepsTheOthersWhole) {
  std::map<Key, std::vector<Vector3d>> before;
  for (const auto& points : map_.voxels()) before[key(points[0], 1)] = points;
  const Vector3d centre(3, -2, 1);
  map_.remove_far(centre, 6);
  std::map<Key, std::vector<Vector3d>> after;
  for (const auto& points : map_.voxels()) after[key(points[0], 1)] = points;
  EXPECT_EQ(after.size(), map_.voxel_count());
  EXPECT_LT(after.size(), before.size());
  for (const auto& [voxel, points] : before) {
    if ((points[0] - centre).norm() < 6) {
      EXPECT_EQ(after.at(voxel), points);
    } else {
      EXPECT_EQ(after.count(voxel), 0U);
    }
  }
  expect_exact_search(map_, 10);
}

TEST_F(FilledMap, FillsAgainAfterEverythingWasDropped) {
  const std::size_t voxels = map_.voxel_count();
  map_.remove_far({1000, 0, 0}, 10);
  EXPECT_TRUE(map_.empty());
  for (const Vector3d& p : cloud(40000, 9, "test/map")) map_.add(p);
  EXPECT_EQ(map_.voxel_count(), voxels);
  expect_exact_search(map_, 10);
}

}  // namespace
}  // namespace tarmac::estimators
