#include <gtest/gtest.h>

#include "core/random.h"
#include "scenes/paving/paving.h"
#include "scenes/stand/layout.h"
#include "scenes/stand/options.h"
#include "tests/scenes/support.h"
#include "tests/support/numeric.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::numeric_jacobian;

Vector2d somewhere(const core::RandomStream& random, std::uint64_t k) {
  return {300 * random.uniform(k, 0) - 150, 160 * random.uniform(k, 1) - 105};
}

TEST(WavyGround, GradientAndHessianMatchCentralDifferences) {
  const WavyGround ground(StandOptions{}.paving(), 5);
  const core::RandomStream random(7, "test/ground");
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Vector2d p = somewhere(random, k);
    Vector2d gradient;
    Vector3d hessian;
    ground.height_m(p.x(), p.y(), &gradient, &hessian);
    const auto height = [&](const Vector2d& q) { return Eigen::Matrix<double, 1, 1>(ground.height_m(q.x(), q.y())); };
    EXPECT_LT((numeric_jacobian<1, 2>(height, p, 1e-3).transpose() - gradient).norm(), 1e-9);
    const auto slope = [&](const Vector2d& q) {
      Vector2d g;
      ground.height_m(q.x(), q.y(), &g);
      return g;
    };
    Eigen::Matrix2d expected;
    expected << hessian[0], hessian[1], hessian[1], hessian[2];
    EXPECT_LT((numeric_jacobian<2, 2>(slope, p, 1e-3) - expected).norm(), 1e-9);
  }
}

TEST(WavyGround, FallsAwayFromTheTerminalByTheCrossfall) {
  StandOptions options;
  options.crossfall_percent = 0.9;
  options.undulation_mm = 0;
  const WavyGround ground(options.paving(), 1);
  EXPECT_NEAR(ground.height_m(3, 10) - ground.height_m(3, -90), 0.9, 1e-12);
  EXPECT_EQ(ground.height_m(3, 10), ground.height_m(-70, 10));
}

TEST(WavyGround, BoundsHoldItsDerivatives) {
  const WavyGround ground(StandOptions{}.paving(), 3);
  const GroundBounds bounds = ground.bounds();
  const core::RandomStream random(8, "test/ground");
  double steepest = 0, sharpest = 0;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const Vector2d p = somewhere(random, k);
    Vector2d g;
    Vector3d h;
    ground.height_m(p.x(), p.y(), &g, &h);
    steepest = std::max(steepest, g.norm());
    sharpest = std::max(sharpest, std::sqrt(h[0] * h[0] + 2 * h[1] * h[1] + h[2] * h[2]));
  }
  EXPECT_LE(steepest, bounds.slope);
  EXPECT_LE(sharpest, bounds.curvature_per_m);
  EXPECT_LT(steepest, 0.015) << "an apron this steep would not be built";
}

TEST(SlabRelief, GradientMatchesCentralDifferencesInTheFieldAndInJoints) {
  const SlabRelief relief(StandOptions{}.paving(), 5);
  const SlabGrid grid(StandOptions{}.paving());
  const core::RandomStream random(7, "test/relief");
  for (std::uint64_t k = 0; k < 600; ++k) {
    Vector2d p = somewhere(random, k);
    const auto joint = [&](int axis) {  // somewhere in the flank of a groove
      const double cell = std::round((p[axis] - grid.origin_m[axis]) / grid.size_m);
      p[axis] = grid.origin_m[axis] + cell * grid.size_m + grid.joint_width_m * (random.uniform(k, 3) - 0.5);
    };
    if (k % 4 == 1 || k % 4 == 3) joint(0);
    if (k % 4 >= 2) joint(1);
    Vector2d gradient;
    relief.height_m(p.x(), p.y(), &gradient);
    const auto height = [&](const Vector2d& q) { return Eigen::Matrix<double, 1, 1>(relief.height_m(q.x(), q.y())); };
    EXPECT_LT((numeric_jacobian<1, 2>(height, p, 1e-7).transpose() - gradient).norm(),
              1e-5 * std::max(1.0, gradient.norm()))
        << p.transpose();
  }
}

TEST(SlabRelief, TextureHasTheRootMeanSquareThatWasAskedFor) {
  StandOptions options;
  options.relief_rms_mm = 3;
  options.joint_depth_mm = 0;
  const SlabRelief relief(options.paving(), 11);
  const core::RandomStream random(9, "test/relief");
  double sum = 0, sum2 = 0;
  constexpr int n = 40000;
  for (std::uint64_t k = 0; k < n; ++k) {
    const Vector2d p = somewhere(random, k);
    const double h = relief.height_m(p.x(), p.y());
    sum += h;
    sum2 += h * h;
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 3e-3, 0.15e-3);
  EXPECT_NEAR(sum / n, 0, 0.2e-3);
}

TEST(SlabRelief, GroovesLieOnTheJointsAndNowhereElse) {
  StandOptions with, without;
  without.joint_depth_mm = 0;
  with.joint_depth_mm = 3;
  const SlabRelief grooved(with.paving(), 5), plain(without.paving(), 5);
  const SlabGrid grid(with.paving());
  double deepest = 0;
  for (int k = 0; k < 400; ++k) {
    const double y = grid.origin_m.y() + (7 + 0.37) * grid.size_m + 0.1 * (k % 30);
    const double x = grid.origin_m.x() + (3 + k % 20) * grid.size_m;
    const double depth = plain.height_m(x, y) - grooved.height_m(x, y);
    EXPECT_GT(depth, 0.19 * 3e-3);
    EXPECT_LT(depth, 1.81 * 3e-3);
    deepest = std::max(deepest, depth);
    EXPECT_EQ(plain.height_m(x + 0.03, y), grooved.height_m(x + 0.03, y));
    EXPECT_EQ(plain.height_m(x - 0.03, y), grooved.height_m(x - 0.03, y));
  }
  EXPECT_GT(deepest, 1.5 * 3e-3);
  // Where two joints cross, no deeper than the deepest groove.
  const double corner = plain.height_m(grid.origin_m.x() + 15, grid.origin_m.y() + 15) -
                        grooved.height_m(grid.origin_m.x() + 15, grid.origin_m.y() + 15);
  EXPECT_LT(corner, 1.81 * 3e-3);
}

TEST(SlabRelief, ManyPointsAtOnceAreTheSinglePointsToAMicrometreInTheFieldAndInJoints) {
  const StandOptions options;
  const SlabRelief relief(options.paving(), 3);
  const SlabGrid grid(options.paving());
  std::vector<double> x, y;
  for (int k = 0; k < 5000; ++k) {
    x.push_back(-60 + 0.0237 * k);
    y.push_back(k % 3 == 0 ? grid.origin_m.y() + 4 * grid.size_m + 0.001 * (k % 40 - 20) : -40 + 0.0173 * k);
  }
  std::vector<float> height(x.size()), slope_x(x.size()), slope_y(x.size());
  relief.heights_m(x.size(), x.data(), y.data(), height.data(), slope_x.data(), slope_y.data());
  double deepest_m = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    Eigen::Vector2d gradient;
    const double expected_m = relief.height_m(x[k], y[k], &gradient);
    ASSERT_NEAR(height[k], expected_m, 1e-7) << k;
    ASSERT_NEAR(slope_x[k], gradient.x(), 1e-5) << k;
    ASSERT_NEAR(slope_y[k], gradient.y(), 1e-5) << k;
    deepest_m = std::min(deepest_m, expected_m);
  }
  EXPECT_LT(deepest_m, -0.5e-3 * options.joint_depth_mm);  // joints were among them
}

TEST(Slabs, StepByMillimetresAtTheirJointsAndFollowTheBase) {
  const StandOptions options;
  const WavyGround ground(options.paving(), 1);
  const SlabSurface slabs(options.paving(), 1, ground);
  const SlabGrid& grid = slabs.grid();
  double sum2 = 0, largest = 0;
  int n = 0;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i + 1 < grid.nx; ++i, ++n) {
      const double x = grid.origin_m.x() + (i + 1) * grid.size_m, y = grid.origin_m.y() + (j + 0.5) * grid.size_m;
      const double fault = slabs.height_m(i, j, x, y) - slabs.height_m(i + 1, j, x, y);
      sum2 += fault * fault;
      largest = std::max(largest, std::abs(slabs.height_m(i, j, x, y) - ground.height_m(x, y)));
    }
  }
  // Offset and one slope of either side: 4 of the 3 + 3 thirds of a corner's variance.
  EXPECT_NEAR(std::sqrt(sum2 / n), 2e-3 * std::sqrt(4.0 / 3), 0.3e-3);
  EXPECT_LT(largest, 6e-3);
}

TEST(Slabs, MeshLiesOnTheirSurfaceToATenthOfAMillimetre) {
  const Scene& scene = tests::default_stand();
  const SlabSurface slabs(StandOptions{}.paving(), 1, *scene.ground);
  const SlabGrid& grid = slabs.grid();
  int tested = 0;
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return i.label == Label::pavement; },
      [&](const Instance&, const tests::Triangle& t) {
        const Vector3d c = (t[0] + t[1] + t[2]) / 3;
        const double size = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
        const Vector2d cell = (c.head<2>() - grid.origin_m) / grid.size_m;
        const Vector2d in = (cell - Vector2d(std::floor(cell.x()), std::floor(cell.y()))) * grid.size_m;
        if (size < 0.3 || in.minCoeff() < 0.02 || in.maxCoeff() > grid.size_m - 0.02) return;  // joints
        ++tested;
        const double z = slabs.height_m(static_cast<int>(cell.x()), static_cast<int>(cell.y()), c.x(), c.y());
        ASSERT_NEAR(c.z(), z, 1e-4);
      });
  EXPECT_GT(tested, 200000);
}

TEST(Paint, LiesOneToThreeMillimetresAboveItsSlabAndLeavesTheJointsFree) {
  const Scene& scene = tests::default_stand();
  const SlabSurface slabs(StandOptions{}.paving(), 1, *scene.ground);
  const SlabGrid& grid = slabs.grid();
  int tested = 0;
  tests::for_each_static_triangle(
      scene, [](const Instance& i) { return i.label == Label::marking; },
      [&](const Instance&, const tests::Triangle& t) {
        const Vector3d c = (t[0] + t[1] + t[2]) / 3;
        const int i = static_cast<int>((c.x() - grid.origin_m.x()) / grid.size_m);
        const int j = static_cast<int>((c.y() - grid.origin_m.y()) / grid.size_m);
        for (const Vector3d& p : {t[0], t[1], t[2], c}) {
          const double gap = p.z() - slabs.height_m(i, j, p.x(), p.y());
          ASSERT_GT(gap, 0.9e-3);
          ASSERT_LT(gap, 3e-3);
          const Vector2d in = p.head<2>() - grid.origin_m - grid.size_m * Vector2d(i, j);
          ASSERT_GT(in.minCoeff(), grid.joint_width_m / 2 - 1e-4);
          ASSERT_LT(in.maxCoeff(), grid.size_m - grid.joint_width_m / 2 + 1e-4);
        }
        ++tested;
      });
  EXPECT_GT(tested, 3000);
}

TEST(Layout, CorridorIsALoopOfThreeHundredMetresWithTightLeftTurns) {
  const auto line = layout::corridor_centre_line(0.25);
  double length = 0, turned = 0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    EXPECT_LE((line[k] - line[k - 1]).norm(), 0.2501);
    length += (line[k] - line[k - 1]).norm();
    if (k + 1 == line.size()) continue;
    const Vector2d a = line[k] - line[k - 1], b = line[k + 1] - line[k];
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    EXPECT_GE(turn, -1e-9);
    EXPECT_LE(turn, 0.26 / layout::corridor_turn_radius_m) << "no kink";
    turned += turn;
  }
  EXPECT_GT(length, 300);
  EXPECT_NEAR(turned, 2 * std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace tarmac::scenes
