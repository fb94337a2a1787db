#include "estimators/blocks/assembler.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "estimators/blocks/point_to_plane.h"
#include "tests/estimators/landmark_world.h"
#include "tests/support/numeric.h"

namespace tarmac::estimators {
namespace {

using core::BlockJacobian;
using core::Row6;
using core::SE3;
using core::Segment;
using core::SegmentModel;
using core::Vector6;

const core::Time kBegin = core::time_from_ns(0), kEnd = core::time_from_ns(1'000'000'000);

/// The angle between begin and end, where the formulas have their edges.
constexpr double kAngles_rad[] = {0.0, 1e-9, 1e-3, 0.5, 3.1};

Segment segment_of(SegmentModel model, double angle_rad) {
  const SE3 T0 = tests::some_pose();
  if (model == SegmentModel::held) return Segment::hold(kBegin, kEnd, T0);
  return Segment::two_pose(model, kBegin, T0, kEnd, T0 * tests::some_pose(angle_rad, 0.8));
}

class EveryModel : public testing::TestWithParam<SegmentModel> {};

TEST_P(EveryModel, SamplesAsTheSegmentItselfDoes) {
  for (const double angle_rad : kAngles_rad) {
    const Segment segment = segment_of(GetParam(), angle_rad);
    const SegmentSampler sampler(segment);
    ASSERT_EQ(sampler.blocks(), static_cast<int>(segment.poses.size()));
    for (const double s : {0.0, 0.125, 0.75, 1.0}) {
      std::array<BlockJacobian, 2> chain;
      std::vector<BlockJacobian> expected;
      const core::Time t = core::time_from_ns(static_cast<std::int64_t>(s * 1e9));
      const SE3 T = segment.pose(t, expected);
      EXPECT_LT(tests::pose_difference(sampler.pose(s, chain), T), 1e-12);
      EXPECT_LT(tests::pose_difference(sampler.pose(s), T), 1e-12);
      for (std::size_t b = 0; b < expected.size(); ++b) {
        EXPECT_EQ(chain[b].block, expected[b].block);
        EXPECT_LT((chain[b].jacobian - expected[b].jacobian).norm(), 1e-9) << "angle " << angle_rad << " s " << s;
      }
    }
  }
}

TEST_P(EveryModel, GradientIsTheNumericOneOfTheCost) {
  for (const double angle_rad : kAngles_rad) {
    const Segment segment = segment_of(GetParam(), angle_rad);
    const int blocks = static_cast<int>(segment.poses.size());
    const PointToPlane plane{{4, -3, 1}, {0.3, 0.1, -0.2}, Eigen::Vector3d(0.48, 0.6, -0.64)};
    for (const double s : {0.0, 0.3, 1.0}) {
      const auto half_square = [&](const Eigen::Matrix<double, 12, 1>& x) {
        Segment moved = segment;
        for (int b = 0; b < blocks; ++b) moved.poses[b] = segment.poses[b] * core::se3::exp(x.segment<6>(6 * b));
        const double r = plane(SegmentSampler(moved).pose(s));
        return Eigen::Matrix<double, 1, 1>(0.5 * 0.7 * r * r);
      };
      const Eigen::Matrix<double, 12, 1> at_zero = Eigen::Matrix<double, 12, 1>::Zero();
      const Eigen::Matrix<double, 1, 12> numeric = tests::numeric_jacobian<1, 12>(half_square, at_zero);
      NormalEquations equations(blocks);
      std::array<BlockJacobian, 2> chain;
      const SegmentSampler sampler(segment);
      Row6 J;
      const double r = plane(sampler.pose(s, chain), J);
      equations.add_data(r, 0.7, J, std::span(chain.data(), static_cast<std::size_t>(blocks)));
      const Eigen::VectorXd expected = numeric.head(6 * blocks).transpose();
      EXPECT_LT(tests::relative_difference(equations.g_data(), expected), 1e-7) << "angle " << angle_rad;
      // H = w J^T J, with g = w J^T r.
      EXPECT_LT((equations.H_data() - equations.g_data() * equations.g_data().transpose() / (0.7 * r * r)).norm(),
                1e-9 * equations.H_data().norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Segments, EveryModel,
                         testing::Values(SegmentModel::two_pose_slerp, SegmentModel::two_pose_screw,
                                         SegmentModel::held));

TEST(SegmentSampler, RefusesModelsThatItDoesNotKnow) {
  const Segment sampled = Segment::sampled(SegmentModel::sampled_slerp, {kBegin, kEnd}, {SE3(), SE3()});
  EXPECT_THROW(SegmentSampler{sampled}, std::invalid_argument);
}

TEST(PointToPlane, JacobianMatchesCentralDifferencesAlsoNearZeroAndPi) {
  for (const double angle_rad : {0.0, 1e-9, 0.5, 3.14159}) {
    const PointToPlane plane{{30, -41, 5}, {0.3, -0.1, 0.9}, Eigen::Vector3d(-0.6, 0, 0.8)};
    const SE3 T = tests::some_pose(angle_rad, 20);
    const auto moved = [&](const Vector6& xi) { return Eigen::Matrix<double, 1, 1>(plane(T * core::se3::exp(xi))); };
    Row6 J;
    EXPECT_EQ(plane(T, J), plane(T));
    const Vector6 zero = Vector6::Zero();
    EXPECT_LT(tests::relative_difference(J, (tests::numeric_jacobian<1, 6>(moved, zero))), 1e-7);
  }
}

/// Independent rows on 12 parameters.
NormalEquations some_equations(int rows, std::uint64_t seed) {
  const core::RandomStream random(seed, "test/rows");
  NormalEquations equations(2);
  for (int i = 0; i < rows; ++i) {
    std::array<BlockJacobian, 2> chain;
    Row6 J;
    std::uint32_t j = 0;
    for (int k = 0; k < 6; ++k) J[k] = random.normal(static_cast<std::uint64_t>(i), j++);
    for (std::size_t b = 0; b < 2; ++b) {
      chain[b].block = static_cast<int>(b);
      for (int k = 0; k < 36; ++k) chain[b].jacobian(k / 6, k % 6) = random.normal(static_cast<std::uint64_t>(i), j++);
    }
    equations.add_data(random.normal(static_cast<std::uint64_t>(i), j++), 1, J, chain);
  }
  return equations;
}

TEST(NormalEquations, StepSolvesBothPartsTogetherWhichAreKeptApart) {
  NormalEquations equations = some_equations(40, 1);
  const Eigen::MatrixXd H_data = equations.H_data();
  NormalEquations::PriorTerm terms[2];
  terms[0].jacobian << 1, 0, 2, 0, 0, 0;
  terms[1].block = 1;
  terms[1].jacobian << 0, -1, 0, 0, 0, 3;
  equations.add_prior(0.5, 10, terms);
  EXPECT_EQ(equations.H_data(), H_data);
  EXPECT_DOUBLE_EQ(equations.H_prior()(2, 0), 20);
  EXPECT_DOUBLE_EQ(equations.H_prior()(0, 7), -10);
  EXPECT_DOUBLE_EQ(equations.g_prior()(11), 15);
  EXPECT_EQ(equations.data_rows(), 40);
  Eigen::VectorXd x;
  ASSERT_TRUE(equations.solve(x));
  const Eigen::VectorXd rest =
      (equations.H_data() + equations.H_prior()) * x + equations.g_data() + equations.g_prior();
  EXPECT_LT(rest.norm(), 1e-9 * equations.g_data().norm());
}

TEST(NormalEquations, SumsOfPartsAreTheSumsOfAll) {
  NormalEquations sum = some_equations(30, 2);
  sum.add(some_equations(20, 3));
  const NormalEquations second = some_equations(20, 3), first = some_equations(30, 2);
  EXPECT_LT((sum.H_data() - first.H_data() - second.H_data()).norm(), 1e-12 * sum.H_data().norm());
  EXPECT_EQ(sum.data_rows(), 50);
}

TEST(NormalEquations, SaysWhenTheyAreSingular) {
  Eigen::VectorXd x = Eigen::VectorXd::Constant(12, 7);
  EXPECT_FALSE(NormalEquations(2).solve(x));
  EXPECT_FALSE(some_equations(11, 4).solve(x));
  EXPECT_EQ(x, Eigen::VectorXd::Constant(12, 7));
  EXPECT_TRUE(some_equations(12, 4).solve(x));
}

}  // namespace
}  // namespace tarmac::estimators
