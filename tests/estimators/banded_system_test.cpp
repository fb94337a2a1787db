#include "estimators/window/banded_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/random.h"

namespace tarmac::estimators {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Shape {
  int band, half, border;
};
void PrintTo(const Shape& s, std::ostream* out) {
  *out << s.band << "_half" << s.half << "_border" << s.border;
}

/// Residuals all along the band with units from 1e-3 to 1e3, every third one with the border too.
BandedSystem filled(const Shape& shape, std::uint64_t seed) {
  const core::RandomStream stream(seed, "test/banded");
  BandedSystem system(shape.band, shape.half, shape.border);
  std::uint64_t draw = 0;
  const auto matrix = [&](Eigen::Index rows, Eigen::Index cols, int first) {
    MatrixXd m(rows, cols);
    for (Eigen::Index c = 0; c < cols; ++c)
      for (Eigen::Index r = 0; r < rows; ++r)
        m(r, c) = stream.normal(++draw) * std::pow(10.0, 3 * std::sin(static_cast<double>(first + c)));
    return m;
  };
  const int width = std::min(shape.half + 1, shape.band);
  const int rows = width + 7;  // enough for the shortest band, which one of them has to determine
  for (int first = 0; first + width <= shape.band; ++first) {
    std::vector<BandedSystem::BorderJacobian> border;
    if (first % 3 == 0)
      for (int column = 0; column + 3 <= shape.border; column += 3) border.push_back({column, matrix(rows, 3, column)});
    const VectorXd root = matrix(rows, 1, 0).col(0);
    const MatrixXd weights = MatrixXd::Identity(rows, rows) + root * root.transpose();
    system.add(first, matrix(rows, width, first), border, weights, matrix(rows, 1, 0).col(0));
  }
  return system;
}

/// Relative to what each entry's own scalars make of it: |A - B|_ij / sqrt(B_ii B_jj).
double scaled_difference(const MatrixXd& a, const MatrixXd& b) {
  const VectorXd s = b.diagonal().cwiseSqrt().cwiseInverse();
  return (s.asDiagonal() * (a - b) * s.asDiagonal()).cwiseAbs().maxCoeff();
}

/// H^-1 by scaling to unit diagonal first, so that the reference keeps its digits.
MatrixXd dense_inverse(const MatrixXd& H) {
  const VectorXd s = H.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd unit = s.asDiagonal() * H * s.asDiagonal();
  return s.asDiagonal() * unit.ldlt().solve(MatrixXd::Identity(H.rows(), H.cols())) * s.asDiagonal();
}

class Banded : public ::testing::TestWithParam<Shape> {};

TEST_P(Banded, SolvesAsTheDenseSystem) {
  const BandedSystem system = filled(GetParam(), 1);
  for (const double lambda : {0.0, 1e-3, 10.0}) {
    MatrixXd H = system.dense();
    H.diagonal() *= 1 + lambda;
    VectorXd step;
    ASSERT_TRUE(system.solve(lambda, step));
    const VectorXd expected = -dense_inverse(H) * system.g();
    const VectorXd unit = H.diagonal().cwiseSqrt();
    EXPECT_LT(unit.cwiseProduct(step - expected).norm(), 1e-10 * unit.cwiseProduct(expected).norm()) << lambda;
  }
  MatrixXd H = system.dense();
  H.diagonal().array() += 2.0;
  VectorXd step;
  ASSERT_TRUE(system.solve_with_identity(2.0, step));
  EXPECT_LT((H * step + system.g()).norm(), 1e-9 * system.g().norm());
}

TEST_P(Banded, CovarianceIsTheDenseInverse) {
  const BandedSystem system = filled(GetParam(), 2);
  const MatrixXd inverse = dense_inverse(system.dense());
  const int count = std::min(system.band(), 12), first = (system.band() - count) / 2, border = system.border();
  EXPECT_LT(scaled_difference(system.covariance(first, count), inverse.block(first, first, count, count)), 1e-10);
  if (border == 0) return;
  EXPECT_LT(scaled_difference(system.covariance(system.band(), border), inverse.bottomRightCorner(border, border)),
            1e-10);
  const MatrixXd joint = system.covariance_with_border(first, count);
  MatrixXd expected(count + border, count + border);
  expected << inverse.block(first, first, count, count), inverse.block(first, system.band(), count, border),
      inverse.block(system.band(), first, border, count), inverse.bottomRightCorner(border, border);
  EXPECT_LT(scaled_difference(joint, expected), 1e-10);
}

TEST_P(Banded, CovarianceRunsAreBlocksOfTheDenseInverse) {
  const BandedSystem system = filled(GetParam(), 3);
  const MatrixXd inverse = dense_inverse(system.dense());
  const int run = system.half_bandwidth() + 1, block = std::max(1, run / 4);
  const std::vector<MatrixXd> runs = system.covariance_runs(block, run);
  ASSERT_EQ(static_cast<int>(runs.size()), (system.band() - run) / block + 1);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const int first = block * static_cast<int>(i);
    EXPECT_LT(scaled_difference(runs[i], inverse.block(first, first, run, run)), 1e-10) << i;
  }
}

TEST_P(Banded, AddingSystemsAddsTheirMatrices) {
  BandedSystem a = filled(GetParam(), 4);
  const BandedSystem b = filled(GetParam(), 5);
  const MatrixXd sum = a.dense() + b.dense();
  const VectorXd g = a.g() + b.g();
  a.add(b);
  EXPECT_EQ(a.dense(), sum);
  EXPECT_EQ(a.g(), g);
  const VectorXd x = VectorXd::LinSpaced(a.size(), -1, 1);
  EXPECT_NEAR(a.quadratic(x), x.dot(sum * x), 1e-10 * x.dot(sum * x));
  a.set_zero();
  EXPECT_EQ(a.dense(), MatrixXd::Zero(sum.rows(), sum.cols()));
}

INSTANTIATE_TEST_SUITE_P(Shapes, Banded,
                         ::testing::Values(Shape{60, 23, 0}, Shape{72, 35, 9}, Shape{150, 35, 15}, Shape{151, 11, 3},
                                           Shape{30, 29, 6}, Shape{7, 2, 3}, Shape{6, 5, 0}));

TEST(Banded, IndefiniteOrSingularIsNotSolved) {
  BandedSystem system = filled({60, 11, 3}, 1);
  VectorXd step = VectorXd::Constant(63, 7.0);
  BandedSystem indefinite = system;
  indefinite.add_to_diagonal(30, -2 * system.diagonal(30));
  EXPECT_FALSE(indefinite.solve(0, step));
  BandedSystem in_the_border = system;
  in_the_border.add_to_diagonal(61, -0.999 * system.diagonal(61));
  EXPECT_FALSE(in_the_border.solve(0, step));
  EXPECT_EQ(step, VectorXd::Constant(63, 7.0)) << "the step is left alone";
  EXPECT_EQ(indefinite.covariance(0, 3).size(), 0);
  EXPECT_TRUE(indefinite.covariance_runs(6, 12).empty());

  // Differences of neighbours alone leave the common shift free.
  BandedSystem free(40, 1, 0);
  for (int i = 0; i + 1 < 40; ++i) {
    const Eigen::RowVector2d J(-1, 1);
    free.add(i, J, {}, MatrixXd::Identity(1, 1), VectorXd::Ones(1));
  }
  EXPECT_FALSE(free.solve(0, step));
  EXPECT_TRUE(free.solve(1e-3, step)) << "damping makes it solvable";

  BandedSystem untouched(12, 3, 0);
  EXPECT_FALSE(untouched.solve(0, step));
  EXPECT_FALSE(untouched.solve(1, step)) << "lambda diag H is nothing where H has nothing";
  EXPECT_TRUE(untouched.solve_with_identity(1, step));
}

TEST(Banded, WhatDoesNotFitIsRefused) {
  BandedSystem system(30, 5, 2);
  const MatrixXd one = MatrixXd::Identity(1, 1);
  const VectorXd g = VectorXd::Zero(1);
  EXPECT_THROW(system.add(0, MatrixXd::Ones(1, 7), {}, one, g), std::invalid_argument);
  EXPECT_THROW(system.add(27, MatrixXd::Ones(1, 4), {}, one, g), std::invalid_argument);
  EXPECT_THROW(system.add(-1, MatrixXd::Ones(1, 4), {}, one, g), std::invalid_argument);
  const std::vector<BandedSystem::BorderJacobian> beyond = {{1, MatrixXd::Ones(1, 2)}};
  EXPECT_THROW(system.add(0, MatrixXd::Ones(1, 4), beyond, one, g), std::invalid_argument);
  EXPECT_THROW(system.covariance_runs(6, 7), std::invalid_argument);
}

TEST(Banded, WorkAndMemoryAreLinearInTheLength) {
  const auto operations = [](int band) { return filled({band, 35, 15}, 1).factor_operations(); };
  const auto stored = [](int band) { return static_cast<double>(BandedSystem(band, 35, 15).stored()); };
  // Equal pieces added to the length add equal work: what does not grow with it cancels in differences.
  EXPECT_NEAR(operations(576) - operations(288), 2 * (operations(288) - operations(144)), 1.0);
  EXPECT_DOUBLE_EQ(stored(24000) - stored(12000), 10 * (stored(2400) - stored(1200)));
  EXPECT_LT(stored(24000), 24000.0 * (36 + 12 + 15 + 1) + 400) << "a dense matrix would hold 24000^2";
}

}  // namespace
}  // namespace tarmac::estimators
