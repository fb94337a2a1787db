#include "core/blending.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace tarmac::core {
namespace {

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}
double choose(int n, int k) {
  return k < 0 || k > n ? 0 : factorial(n) / factorial(k) / factorial(n - k);
}

/// Coefficient of u^n in the weight of control point j, equal spacing: expand the truncated powers of the cardinal
/// B-spline, N(x) = 1/(k-1)! sum over l of (-1)^l C(k, l) (x - l)_+^{k-1} at x = u + k - 1 - j.
BlendingMatrix uniform_matrix(int k) {
  BlendingMatrix M = BlendingMatrix::Zero(k, k);
  for (int j = 0; j < k; ++j) {
    for (int l = 0; l <= k - 1 - j; ++l) {
      const double sign = l % 2 == 0 ? 1 : -1;
      for (int n = 0; n < k; ++n) {
        M(n, j) += sign * choose(k, l) * choose(k - 1, n) * std::pow(k - 1 - j - l, k - 1 - n) / factorial(k - 1);
      }
    }
  }
  return M;
}

std::vector<Time> uniform_knots_from(std::int64_t begin_ns, std::int64_t spacing_ns, int count) {
  std::vector<Time> knots;
  for (int i = 0; i < count; ++i) knots.push_back(time_from_ns(begin_ns + i * spacing_ns));
  return knots;
}

/// Spacings between 10 and 200 ms.
std::vector<Time> random_knots(std::uint64_t seed, int count) {
  const RandomStream stream(seed, "test/knots");
  std::vector<Time> knots = {time_from_ns(1'700'000'000'123'456'789)};
  for (int i = 1; i < count; ++i) {
    knots.push_back(knots.back() +
                    Duration(static_cast<std::int64_t>(1e7 + 1.9e8 * stream.uniform(static_cast<std::uint64_t>(i)))));
  }
  return knots;
}

/// derivative-th derivative by u of the weights at u.
Eigen::VectorXd weights(const BlendingMatrix& M, double u, int derivative) {
  Eigen::VectorXd powers = Eigen::VectorXd::Zero(M.rows());
  for (int m = derivative; m < M.rows(); ++m) {
    powers[m] = factorial(m) / factorial(m - derivative) * std::pow(u, m - derivative);
  }
  return M.transpose() * powers;
}

class EveryOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Blending, EveryOrder, ::testing::Values(4, 5, 6));

TEST_P(EveryOrder, EqualSpacingGivesTheClosedForm) {
  const int k = GetParam();
  for (const std::int64_t spacing_ns : {1L, 33'333'333L, 100'000'000L}) {
    const auto knots = uniform_knots_from(1'700'000'000'000'000'000, spacing_ns, 2 * k - 2);
    EXPECT_LT((blending_matrix(k, knots) - uniform_matrix(k)).cwiseAbs().maxCoeff(), 1e-14) << spacing_ns;
  }
}

TEST_P(EveryOrder, WeightsArePositiveAndAddUpToOne) {
  const int k = GetParam();
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const BlendingMatrix M = blending_matrix(k, random_knots(seed, 2 * k - 2));
    for (int n = 0; n <= 10; ++n) {
      const Eigen::VectorXd w = weights(M, n / 10.0, 0);
      EXPECT_NEAR(w.sum(), 1, 1e-13);
      EXPECT_GT(w.minCoeff(), -1e-14);
    }
    EXPECT_LT(M.rowwise().sum().tail(k - 1).cwiseAbs().maxCoeff(), 1e-13) << "coefficients of powers of u cancel";
  }
}

TEST_P(EveryOrder, NeighbouringIntervalsMeetWithAllDerivativesUpToOrderMinusTwo) {
  const int k = GetParam();
  for (std::uint64_t seed = 0; seed <= 50; ++seed) {
    const auto knots = seed == 0 ? uniform_knots_from(0, 100'000'000, 2 * k - 1) : random_knots(seed, 2 * k - 1);
    const auto width_ns = [&](int i) {
      return static_cast<double>(
          (knots[static_cast<std::size_t>(k - 1 + i)] - knots[static_cast<std::size_t>(k - 2 + i)]).count());
    };
    const std::span<const Time> all(knots);
    const std::size_t count = static_cast<std::size_t>(2 * k - 2);
    const BlendingMatrix left = blending_matrix(k, all.first(count)), right = blending_matrix(k, all.last(count));
    for (int derivative = 0; derivative <= k - 2; ++derivative) {
      // Control points 0..k: the left interval knows all but the last, the right one all but the first. In units of the
      // left interval's length.
      Eigen::VectorXd before = Eigen::VectorXd::Zero(k + 1), after = Eigen::VectorXd::Zero(k + 1);
      before.head(k) = weights(left, 1, derivative);
      after.tail(k) = weights(right, 0, derivative) * std::pow(width_ns(0) / width_ns(1), derivative);
      EXPECT_LT((before - after).cwiseAbs().maxCoeff(), 1e-10 * std::max(1.0, before.cwiseAbs().maxCoeff()))
          << "seed " << seed << " derivative " << derivative;
    }
  }
}

TEST_P(EveryOrder, CumulativeColumnsAreTheSumsFromTheRight) {
  const int k = GetParam();
  const BlendingMatrix M = blending_matrix(k, random_knots(7, 2 * k - 2)), C = cumulative(M);
  for (int j = 0; j < k; ++j) EXPECT_LT((C.col(j) - M.rightCols(k - j).rowwise().sum()).norm(), 1e-13) << j;
  EXPECT_EQ(C(0, 0), 1);
  EXPECT_EQ(C.col(0).tail(k - 1).norm(), 0);
}

/// The cubic weights written out for any spacing (h the interval's length), as published for non-uniform splines.
TEST(CubicBlending, AgreesWithTheClosedFormForUnevenSpacing) {
  const std::int64_t spacing_ns[] = {100'000'000, 50'000'000, 33'333'333, 25'000'000, 100'000'000};
  std::vector<Time> t = {time_from_ns(0)};
  for (const std::int64_t s : spacing_ns) t.push_back(t.back() + Duration(s));
  const auto d = [&](int a, int b) {
    return to_s(t[static_cast<std::size_t>(a + 2)] - t[static_cast<std::size_t>(b + 2)]);
  };
  const double h = d(1, 0);
  const double m00 = h * h / (d(1, -1) * d(1, -2)), m02 = d(0, -1) * d(0, -1) / (d(2, -1) * d(1, -1));
  const double m12 = 3 * h * d(0, -1) / (d(2, -1) * d(1, -1)), m22 = 3 * h * h / (d(2, -1) * d(1, -1));
  const double m33 = h * h / (d(3, 0) * d(2, 0)), m32 = -m22 / 3 - m33 - h * h / (d(2, 0) * d(2, -1));
  BlendingMatrix expected(4, 4);  // column = control point, row = power
  expected.col(0) << m00, -3 * m00, 3 * m00, -m00;
  expected.col(2) << m02, m12, m22, m32;
  expected.col(3) << 0, 0, 0, m33;
  expected.col(1) = -expected.col(0) - expected.col(2) - expected.col(3);
  expected(0, 1) += 1;
  EXPECT_LT((blending_matrix(4, t) - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Blending, RefusesWhatMakesNoInterval) {
  const auto knots = uniform_knots_from(0, 10, 6);
  EXPECT_THROW(blending_matrix(5, knots), InputError);
  EXPECT_THROW(blending_matrix(7, uniform_knots_from(0, 10, 12)), InputError);
  EXPECT_THROW(blending_matrix(0, knots), InputError);
  auto equal = knots;
  equal[3] = equal[2];
  EXPECT_THROW(blending_matrix(4, equal), InputError);
  std::swap(equal[1], equal[2]);
  EXPECT_THROW(blending_matrix(4, equal), InputError);
}

}  // namespace
}  // namespace tarmac::core
