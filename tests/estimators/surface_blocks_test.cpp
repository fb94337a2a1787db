/// Neighbours, planes and losses.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/random.h"
#include "estimators/blocks/nearest_points.h"
#include "estimators/blocks/plane_fit.h"
#include "estimators/blocks/robust_loss.h"

namespace tarmac::estimators {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d random_point(const core::RandomStream& random, std::uint64_t i, double half_m) {
  return half_m * Vector3d(2 * random.uniform(i, 0) - 1, 2 * random.uniform(i, 1) - 1, 2 * random.uniform(i, 2) - 1);
}

VoxelMap filled_map(double voxel_m, const Vector3d& centre) {
  const core::RandomStream random(1, "test/map");
  VoxelMap map(voxel_m, 20, 0.1);
  for (std::uint64_t i = 0; i < 6000; ++i) map.add(centre + random_point(random, i, 4));
  return map;
}

/// By looking at every point of the map.
std::vector<double> by_brute_force(const VoxelMap& map, const NearestSearch& search, const Vector3d& query) {
  const Voxel own = voxel_of(query, map.voxel_size_m());
  std::vector<double> all;
  for (const auto& voxel : map.voxels()) {
    const Voxel there = voxel_of(voxel.front(), map.voxel_size_m());
    const int steps = std::max({std::abs(there.x - own.x), std::abs(there.y - own.y), std::abs(there.z - own.z)});
    for (const Vector3d& p : voxel) {
      const double distance = (p - query).norm();
      if (steps <= search.reach && distance <= search.radius_m) all.push_back(distance);
    }
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), static_cast<std::size_t>(search.max_points)));
  return all;
}

TEST(NearestPoints, AreThoseOfABruteForceSearchOverTheSameCells) {
  const core::RandomStream random(2, "test/queries");
  for (const Vector3d& centre : {Vector3d(0, 0, 0), Vector3d(-300, 170, 20)}) {
    const VoxelMap map = filled_map(0.8, centre);
    for (const NearestSearch& search :
         {NearestSearch{}, NearestSearch{.max_points = 7, .reach = 2}, NearestSearch{.radius_m = 0.75},
          NearestSearch{.max_points = 64, .reach = 3, .radius_m = 1.1}}) {
      const NearestPointsFinder finder(map, search);
      for (std::uint64_t i = 0; i < 200; ++i) {
        const Vector3d query = centre + random_point(random, i, 5);
        NearestPoints found;
        finder.find(query, found);
        const std::vector<double> expected = by_brute_force(map, search, query);
        ASSERT_EQ(static_cast<std::size_t>(found.count), expected.size());
        // An expectation changes nothing, right or wrong.
        for (const double factor : {1.1, 1.0000001, 0.5}) {
          NearestPoints again;
          finder.find(query, again, factor * (expected.empty() ? 1 : expected.back()));
          ASSERT_EQ(again.count, found.count);
          for (int k = 0; k < found.count; ++k) EXPECT_EQ(again.offset(k), found.offset(k));
        }
        for (int k = 0; k < found.count; ++k) {
          EXPECT_NEAR(found.offset(k).norm(), expected[static_cast<std::size_t>(k)], 1e-12);
          EXPECT_NEAR(std::sqrt(found.distance2_m2[static_cast<std::size_t>(k)]), expected[static_cast<std::size_t>(k)],
                      1e-12);
        }
      }
    }
  }
}

TEST(NearestPoints, AreNoneFarFromTheMapOrForQueriesBeyondTheGrid) {
  const VoxelMap map = filled_map(1, Vector3d::Zero());
  const NearestPointsFinder finder(map, {});
  NearestPoints found;
  for (const Vector3d& query : {Vector3d(50, 0, 0), Vector3d(1e12, 0, 0), Vector3d(NAN, 0, 0)}) {
    finder.find(query, found);
    EXPECT_EQ(found.count, 0);
  }
  EXPECT_THROW(NearestPointsFinder(map, {.max_points = 65}), std::invalid_argument);
  EXPECT_THROW(NearestPointsFinder(map, {.reach = 0}), std::invalid_argument);
}

TEST(VoxelMapSpacing, NoPointIsNearerThanTheMinimumDistanceToAnotherOfItsVoxel) {
  const VoxelMap map = filled_map(1, Vector3d::Zero());
  std::size_t full = 0;
  for (const auto& voxel : map.voxels()) {
    ASSERT_LE(voxel.size(), 20U);
    full += voxel.size() == 20 ? 1U : 0U;
    for (std::size_t a = 0; a < voxel.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) EXPECT_GE((voxel[a] - voxel[b]).norm(), 0.1);
    }
    const VoxelMap::Points points = map.points_in(voxel_of(voxel.front(), 1));
    ASSERT_EQ(points.count, static_cast<int>(voxel.size()));
    EXPECT_EQ(Vector3d(points.x_m[0], points.y_m[0], points.z_m[0]), voxel.front());
  }
  EXPECT_GT(full, 0U);
  EXPECT_EQ(map.points_in({100, 0, 0}).count, 0);
}

TEST(SmallestEigen, AgreesWithTheIterativeSolver) {
  const core::RandomStream random(3, "test/matrices");
  for (std::uint64_t i = 0; i < 3000; ++i) {
    // From balls over discs and rods to the flat and thin ones that matter here, tiny and huge.
    const double thin = std::pow(10.0, -6 * random.uniform(i, 0)), middle = std::pow(10.0, -4 * random.uniform(i, 1));
    const double size = std::pow(10.0, 6 * random.uniform(i, 2) - 3);
    const Vector3d axis = random_point(random, i + 10000, 3);
    const Matrix3d R = Eigen::AngleAxisd(axis.norm(), axis.normalized()).toRotationMatrix();
    const Matrix3d A = R * Vector3d(size, size * middle, size * middle * thin).asDiagonal() * R.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> expected(A);
    const SmallestEigen eigen = smallest_eigen(A);
    EXPECT_LT((eigen.values - expected.eigenvalues()).cwiseAbs().maxCoeff(), 1e-7 * size);
    EXPECT_NEAR(eigen.vector.norm(), 1, 1e-12);
    // As good as the eigenvalue is apart from the next: rounding of A itself allows no more.
    const double apart = (expected.eigenvalues()[1] - expected.eigenvalues()[0]) / size;
    const double sine = eigen.vector.cross(Vector3d(expected.eigenvectors().col(0))).norm();
    EXPECT_LT(sine, 1e-6 + 1e-14 / apart) << "i = " << i << " apart " << apart;
  }
}

TEST(SmallestEigen, GivesAUnitVectorWhereEigenvaluesAreEqual) {
  for (const Vector3d& values : {Vector3d(0, 0, 0), Vector3d(1, 1, 1), Vector3d(0, 0, 2), Vector3d(0, 3, 3)}) {
    const SmallestEigen eigen = smallest_eigen(Matrix3d(values.asDiagonal()));
    EXPECT_NEAR(eigen.vector.norm(), 1, 1e-12);
    EXPECT_LT((values.asDiagonal() * eigen.vector - values.minCoeff() * eigen.vector).norm(), 1e-7);
    EXPECT_LT((eigen.values - values).norm(), 1e-7);
  }
}

void add(NearestPoints& points, const Vector3d& p) {
  const auto k = static_cast<std::size_t>(points.count++);
  points.x_m[k] = p.x();
  points.y_m[k] = p.y();
  points.z_m[k] = p.z();
  points.distance2_m2[k] = p.squaredNorm();
}

/// Mean planarity of `patches` of 20 points; `place(i)` gives point i.
template <class Place>
double mean_planarity(const Place& place) {
  double sum = 0;
  constexpr int kPatches = 2000;
  for (int patch = 0; patch < kPatches; ++patch) {
    NearestPoints points;
    for (int k = 0; k < 20; ++k) add(points, place(static_cast<std::uint64_t>(20 * patch + k)));
    const PlaneFit fit = fit_plane(points);
    EXPECT_GE(fit.planarity, 0);
    EXPECT_LE(fit.planarity, 1);
    sum += fit.planarity;
  }
  return sum / kPatches;
}

// The second moments' expectation on a square patch of edge a with noise s: l1, l2 ~ a^2/12, l3 ~ s^2; the two larger
// eigenvalues of a sample of 20 differ by chance, which costs about 0.2. Measured beforehand on such patches: 0.77,
// 0.75, 0.72, 0.60 for 5, 10, 20, 50 mm; 0.18 in a ball; 0.03 on a line.
TEST(PlaneFit, PlanarityOfPatchesBallsAndLinesIsThatOfTheFactSheet) {
  const core::RandomStream random(4, "test/patches");
  const double expected[] = {0.77, 0.75, 0.72, 0.60}, noise_m[] = {0.005, 0.010, 0.020, 0.050};
  for (std::size_t c = 0; c < 4; ++c) {
    const double planarity = mean_planarity([&](std::uint64_t i) {
      Vector3d p = random_point(random, i, 0.4);
      p.z() = noise_m[c] * random.normal(i, 3);
      return p;
    });
    EXPECT_NEAR(planarity, expected[c], 0.04) << "noise " << noise_m[c];
  }
  EXPECT_LT(mean_planarity([&](std::uint64_t i) { return random_point(random, i, 0.4); }), 0.25);
  EXPECT_LT(mean_planarity([&](std::uint64_t i) {
              return Vector3d(random_point(random, i, 0.4).x(), 0.01 * random.normal(i, 1), 0.01 * random.normal(i, 2));
            }),
            0.1);
}

TEST(PlaneFit, FindsTheNormalOfATiltedPatchAndItsMean) {
  const core::RandomStream random(5, "test/patches");
  const Vector3d normal = Vector3d(0.6, -0.48, 0.64), u = normal.unitOrthogonal(), v = normal.cross(u);
  NearestPoints points;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Vector3d p = random_point(random, i, 0.5);
    add(points, Vector3d(3, 4, 5) + p.x() * u + p.y() * v);
  }
  const PlaneFit fit = fit_plane(points);
  EXPECT_LT(fit.normal.cross(normal).norm(), 1e-6);
  EXPECT_NEAR(normal.dot(fit.mean_m - Vector3d(3, 4, 5)), 0, 1e-12);
}

TEST(PlaneFit, CoincidingOrTooFewPointsHaveNoPlanarity) {
  NearestPoints points;
  EXPECT_EQ(fit_plane(points).planarity, 0);
  add(points, {1, 2, 3});
  add(points, {2, 2, 3});
  EXPECT_EQ(fit_plane(points).planarity, 0);
  points.count = 0;
  for (int k = 0; k < 20; ++k) add(points, {1, 2, 3});
  EXPECT_EQ(fit_plane(points).planarity, 0);
  EXPECT_TRUE(fit_plane(points).normal.allFinite());
}

class EveryLoss : public testing::TestWithParam<const char*> {};

TEST_P(EveryLoss, DerivativesMatchCentralDifferencesAndSmallResidualsCountInFull) {
  const RobustLoss loss{loss_named(GetParam()), 0.3, 0.05};
  EXPECT_EQ(loss(0).rho, 0);
  for (const double s : {1e-4, 0.01, 0.05, 0.0899, 0.0901, 0.4, 5.0, 400.0}) {
    const double h = 1e-5 * s;
    const auto [rho, first, second] = loss(s);
    EXPECT_NEAR(first, (loss(s + h).rho - loss(s - h).rho) / (2 * h), 1e-6) << s;
    EXPECT_NEAR(second, (loss(s + h).first - loss(s - h).first) / (2 * h), 1e-5) << s;
    EXPECT_GE(first, 0);
    EXPECT_LE(first, 1);
    EXPECT_LE(rho, s);
  }
}

INSTANTIATE_TEST_SUITE_P(Losses, EveryLoss,
                         testing::Values("standard", "cauchy", "huber", "tolerant", "truncated", "geman-mcclure",
                                         "dcs"));

TEST(RobustLoss, WeightsOfLargeResiduals) {
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::cauchy, 0.1, 0}(0.01).first), 0.5);  // at r = c
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::huber, 0.1, 0}(0.04).first), 0.5);   // at r = 2c
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::truncated, 0.1, 0}(0.04).first), 0);
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::tolerant, 0.1, 0.05}(0.05).first), 0.5);  // at s = t
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::geman_mcclure, 0.1, 0}(0.01).first), 0.25);  // at r = c
  EXPECT_DOUBLE_EQ((RobustLoss{Loss::dcs, 0.1, 0}(0.03).first), 0.25);            // at r^2 = 3 c^2
  EXPECT_THROW(loss_named("welsch"), std::invalid_argument);
}

}  // namespace
}  // namespace tarmac::estimators
