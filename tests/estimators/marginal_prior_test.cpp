#include "estimators/window/marginal_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/random.h"
#include "estimators/window/gravity_direction.h"
#include "tests/estimators/hermite_chain.h"

namespace tarmac::estimators {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of n unknowns, with `null` directions unknown.
MatrixXd information(int n, int null, std::uint64_t seed) {
  const core::RandomStream stream(seed, "test/information");
  MatrixXd root(n - null, n);
  for (int i = 0; i < root.size(); ++i) root.data()[i] = stream.normal(static_cast<std::uint64_t>(i));
  return root.transpose() * root;
}

TEST(Marginalise, IsTheInverseOfTheCovariancesBlock) {
  const MatrixXd H = information(20, 0, 1);
  const VectorXd g = VectorXd::LinSpaced(20, -1, 2);
  const Schur rest = marginalise(H, g, 12, 0);
  const MatrixXd P = H.inverse();
  EXPECT_LT((rest.H - P.bottomRightCorner(8, 8).inverse()).norm(), 1e-9 * rest.H.norm());
  const VectorXd whole = -H.ldlt().solve(g), part = -rest.H.ldlt().solve(rest.g);
  EXPECT_LT((whole.tail(8) - part).norm(), 1e-9 * part.norm()) << "the same minimum";
}

TEST(Marginalise, WhatIsUnknownOfTheRemovedTakesNothingAlong) {
  // An unknown that nothing looks at, and one that only a sum knows.
  MatrixXd H = MatrixXd::Zero(4, 4);
  const Eigen::RowVector4d sum(0, 1, 1, 0), own(0, 0, 0, 2);
  H += sum.transpose() * sum + own.transpose() * own;
  const VectorXd g = Eigen::Vector4d(0, 1, 1, -1);
  const Schur rest = marginalise(H, g, 2, 0);
  EXPECT_LT((rest.H - Eigen::Vector2d(0, 4).asDiagonal().toDenseMatrix()).norm(), 1e-12);
  EXPECT_LT((rest.g - Eigen::Vector2d(0, -1)).norm(), 1e-12);
}

TEST(Marginalise, ThresholdedPriorIsSemiDefiniteAndKeepsTheNullSpace) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const int null = 4, kept = 9;
    // Those unknown directions lie among what stays, as a drifting pose does.
    MatrixXd H = information(21, null, seed);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> whole(H);
    const MatrixXd N = whole.eigenvectors().leftCols(null);
    const Schur rest = marginalise(H, H * VectorXd::Ones(21), 12, 1e-6);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(rest.H);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-14 * eigen.eigenvalues().maxCoeff());
    int zeros = 0;
    for (const double value : eigen.eigenvalues()) zeros += value < 1e-12 * eigen.eigenvalues().maxCoeff() ? 1 : 0;
    EXPECT_EQ(zeros, null);
    EXPECT_LT((rest.H * N.bottomRows(kept)).norm(), 1e-9 * rest.H.norm()) << "directions that were unknown stay so";
    EXPECT_LT((N.bottomRows(kept).transpose() * rest.g).norm(), 1e-9 * rest.g.norm()) << "and are not pushed";
  }
}

TEST(Marginalise, ThresholdTakesOutWeakDirectionsOnly) {
  const VectorXd values = Eigen::Vector4d(1e-9, 1e-3, 1, 100);
  const MatrixXd Q = information(4, 0, 2).householderQr().householderQ();
  const MatrixXd H = Q * values.asDiagonal() * Q.transpose();
  const Schur rest = marginalise(H, Q * VectorXd::Ones(4), 0, 1e-6);
  const VectorXd expected = Eigen::Vector4d(0, 1e-3, 1, 100);
  EXPECT_LT((Q.transpose() * rest.H * Q - expected.asDiagonal().toDenseMatrix()).norm(), 1e-12);
  EXPECT_LT((Q.transpose() * rest.g - VectorXd(Eigen::Vector4d(0, 1, 1, 1))).norm(), 1e-10);
}

/// Two knots of a chain, a bias knot of two, gravity and the offset.
struct Prior : ::testing::Test {
  Prior() {
    state.trajectory = std::make_unique<HermiteChain>(core::time_from_ns(0), core::Duration(100'000'000), 3, 1.0);
    state.biases = {{core::time_from_ns(0), core::Vector6::Constant(0.1)}, {core::time_from_ns(100), core::Vector6::Zero()}};
    state.gravity_map = Eigen::Vector3d(0.1, -0.2, -0.97).normalized();
    const int n = 12 + 6 + 3;
    const VectorXd g = VectorXd::LinSpaced(n, -1, 1);
    prior = MarginalPrior(state, 2, {{0, 1, 2, 3, 4, 5}, true, true}, Schur{information(n, 0, 1), g});
  }
  /// In the order of the prior's unknowns.
  WindowState moved(const WindowState& from, const VectorXd& d) const {
    WindowState to(from);
    VectorXd step = VectorXd::Zero(18 + 15);
    step.head(12) = d.head(12);
    step.segment(18, 6) = d.segment(12, 6);
    step.tail(3) = d.tail(3);
    retract(to, BorderLayout(to, true, true), step);
    return to;
  }
  WindowState state;
  MarginalPrior prior;
};

TEST_F(Prior, CostIsTheQuadraticAboutItsBaseAndLeastAtZero) {
  const MatrixXd& H = prior.information().H;
  const VectorXd& g = prior.information().g;
  const VectorXd d = 0.1 * VectorXd::LinSpaced(21, 1, -1);
  EXPECT_NEAR(prior.cost(moved(state, d)) - prior.cost(state), d.dot(H * d) / 2 + g.dot(d), 1e-10);
  EXPECT_NEAR(prior.cost(state), g.dot(H.ldlt().solve(g)) / 2, 1e-9);
}

TEST_F(Prior, GradientIsExactAwayFromItsBase) {
  const WindowState away = moved(state, 0.3 * VectorXd::LinSpaced(21, 1, -1));
  const BorderLayout layout(away, true, true);
  BandedSystem system(18, 11, 15);
  prior.add_to(away, layout, system);
  for (int i = 0; i < 21; ++i) {
    VectorXd d = VectorXd::Zero(21);
    d[i] = 1e-5;
    const double numeric = (prior.cost(moved(away, d)) - prior.cost(moved(away, -d))) / 2e-5;
    const int at = i < 12 ? i : i < 18 ? 18 + i - 12 : 30 + i - 18;
    EXPECT_NEAR(system.g()[at], numeric, 1e-6 * std::max(1.0, std::abs(numeric))) << i;
  }
}

TEST(GravityDirection, DifferenceUndoesMovedAndItsJacobianIsExact) {
  for (const Eigen::Vector3d& base : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0.3, -0.8, 0.5)}) {
    const Eigen::Vector3d from = base.normalized();
    for (const double angle : {0.0, 1e-6, 5e-4, 2e-3, 0.3, 2.0}) {
      const Eigen::Vector2d d = angle * Eigen::Vector2d(0.6, -0.8);
      const Eigen::Vector3d g = gravity_direction::moved(from, d);
      EXPECT_NEAR(g.norm(), 1, 1e-15);
      Eigen::Matrix2d J, unused;
      EXPECT_LT((gravity_direction::difference(from, g, J) - d).norm(), 1e-12 * std::max(1.0, angle));
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d h = 1e-6 * Eigen::Vector2d::Unit(axis);
        const Eigen::Vector2d numeric = (gravity_direction::difference(from, gravity_direction::moved(g, h), unused) -
                                         gravity_direction::difference(from, gravity_direction::moved(g, -h), unused)) /
                                        2e-6;
        EXPECT_LT((J.col(axis) - numeric).norm(), 1e-8) << angle;
      }
    }
  }
}

}  // namespace
}  // namespace tarmac::estimators
