#include "core/lie_derivatives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/stumpff.h"
#include "tests/support/numeric.h"

namespace tarmac::core {
namespace {

Vector6 random_tangent(const RandomStream& stream, std::uint64_t i, double angle_rad) {
  Vector6 v;
  for (std::uint32_t k = 0; k < 6; ++k) v[k] = stream.normal(i, k);
  v.tail<3>() *= angle_rad / v.tail<3>().norm();
  return v;
}

/// Both sides of the switch at 1 rad, small angles log-spaced, and large ones.
std::vector<double> edge_angles() {
  std::vector<double> angles = {0};
  for (int k = -10; k < 0; ++k) angles.push_back(std::pow(10.0, k));
  for (const double a : {0.3, 0.6, 0.99, 1 - 1e-12, 1.0, 1 + 1e-12, 1.01, 2.0, 3.0}) angles.push_back(a);
  return angles;
}

using Wide = Eigen::Matrix<long double, 6, 6>;

/// Coefficients of Jr = sum (-X)^n/(n+1)! and of Jr^-1 = sum B_n (-X)^n/n!, in long double.
std::vector<long double> right_jacobian_terms(int terms) {
  std::vector<long double> c = {1};
  for (int n = 1; n < terms; ++n) c.push_back(-c.back() / static_cast<long double>(n + 1));
  return c;
}
std::vector<long double> right_jacobian_inverse_terms(int terms) {
  // The product of both series is 1.
  const std::vector<long double> a = right_jacobian_terms(terms);
  std::vector<long double> b = {1};
  for (std::size_t n = 1; n < a.size(); ++n) {
    long double sum = 0;
    for (std::size_t k = 1; k <= n; ++k) sum -= a[k] * b[n - k];
    b.push_back(sum);
  }
  return b;
}

/// d(sum c_n X^n w)/dxi term by term: d(X^n w) = sum over k of X^(n-1-k) (-curly_hat(X^k w)).
Matrix6 derivative_by_series(const std::vector<long double>& c, const Vector6& xi, const Vector6& w) {
  const Wide X = se3::curly_hat(xi).cast<long double>();
  Eigen::Matrix<long double, 6, 1> power = w.cast<long double>();  // X^n w
  Wide d = Wide::Zero(), sum = Wide::Zero();                       // d(X^n w), and all of them
  for (std::size_t n = 1; n < c.size(); ++n) {
    // d(X u) = -curly_hat(u) + X du.
    Wide curly = Wide::Zero();
    const auto hat = [](const Eigen::Matrix<long double, 3, 1>& v) {
      Eigen::Matrix<long double, 3, 3> K;
      K << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
      return K;
    };
    curly.topLeftCorner<3, 3>() = curly.bottomRightCorner<3, 3>() = hat(power.tail<3>());
    curly.topRightCorner<3, 3>() = hat(power.head<3>());
    d = (X * d - curly).eval();
    power = (X * power).eval();
    sum += c[n] * d;
  }
  return sum.cast<double>();
}

TEST(CurlyHat, IsTheBracketAndTheAdjointsLogarithm) {
  const RandomStream stream(1, "test/curly_hat");
  const Vector6 a = random_tangent(stream, 0, 0.7), b = random_tangent(stream, 1, 1.1);
  EXPECT_LT((se3::curly_hat(a) * b + se3::curly_hat(b) * a).norm(), 1e-15);
  Matrix6 sum = Matrix6::Identity(), term = sum;
  for (int n = 1; n < 30; ++n) {
    term = (term * se3::curly_hat(a) / n).eval();
    sum += term;
  }
  EXPECT_LT((sum - se3::adjoint(se3::exp(a))).norm(), 1e-14);
}

TEST(LieDerivatives, MatchPowerSeriesWithoutAStepAtTheSwitch) {
  const RandomStream stream(2, "test/lie_derivative_series");
  // The inverse's series converges like (angle / 2 pi)^n.
  const auto forward = right_jacobian_terms(60), inverse = right_jacobian_inverse_terms(100);
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Vector6 xi = random_tangent(stream, i++, angle_rad), w = random_tangent(stream, i++, 2.5);
    const Matrix6 expected = derivative_by_series(forward, xi, w);
    EXPECT_LT((se3::right_jacobian_derivative(xi, w) - expected).norm(), 1e-14 * (1 + w.norm() * xi.norm()))
        << angle_rad;
    EXPECT_LT((se3::right_jacobian_rate(xi, w) - expected * w).norm(), 2e-14 * (1 + w.squaredNorm() * xi.norm()))
        << angle_rad;
    EXPECT_LT((se3::right_jacobian_inverse_derivative(xi, w) - derivative_by_series(inverse, xi, w)).norm(),
              2e-14 * (1 + w.norm() * xi.norm()))
        << angle_rad;
  }
}

TEST(LieDerivatives, MatchCentralDifferences) {
  const RandomStream stream(3, "test/lie_derivative_differences");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Vector6 xi = random_tangent(stream, i++, angle_rad), w = random_tangent(stream, i++, 2.5);
    const auto forward = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& x) -> Vector6 { return se3::right_jacobian(x) * w; }, xi, 1e-5);
    const auto inverse = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& x) -> Vector6 { return se3::right_jacobian_inverse(x) * w; }, xi, 1e-5);
    EXPECT_LT(tests::relative_difference(se3::right_jacobian_derivative(xi, w), forward), 1e-8) << angle_rad;
    EXPECT_LT(tests::relative_difference(se3::right_jacobian_inverse_derivative(xi, w), inverse), 1e-8) << angle_rad;
    Matrix6 by_xi, by_w;
    const Vector6 rate = se3::right_jacobian_rate(xi, w, &by_xi, &by_w);
    EXPECT_EQ(rate, se3::right_jacobian_rate(xi, w));
    const auto rate_by_xi = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& x) -> Vector6 { return se3::right_jacobian_rate(x, w); }, xi, 1e-5);
    const auto rate_by_w = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& x) -> Vector6 { return se3::right_jacobian_rate(xi, x); }, w, 1e-5);
    EXPECT_LT(tests::relative_difference(by_xi, rate_by_xi), 1e-8) << angle_rad;
    EXPECT_LT(tests::relative_difference(by_w, rate_by_w), 1e-8) << angle_rad;
  }
}

/// What the derivative is for: how a body-centric velocity changes along Exp(xi(t)), xi(t) = xi + t w.
TEST(LieDerivatives, RateIsTheVelocitysDerivativeAlongAStraightLineOfTangents) {
  const RandomStream stream(4, "test/lie_rate");
  for (const double angle_rad : {0.1, 1.3}) {
    const Vector6 xi = random_tangent(stream, 0, angle_rad), w = random_tangent(stream, 1, 0.8);
    const auto velocity = [&](double t) -> Vector6 {
      constexpr double h = 1e-3;
      const auto part = [&](double e) -> Vector6 {
        return se3::log(se3::exp(xi + (t - e) * w).inverse() * se3::exp(xi + (t + e) * w)) / (2 * e);
      };
      return (4 * part(h / 2) - part(h)) / 3;
    };
    constexpr double step = 1e-2;
    const Vector6 numeric =
        (8 * (velocity(step) - velocity(-step)) - (velocity(2 * step) - velocity(-2 * step))) / (12 * step);
    EXPECT_LT((se3::right_jacobian_rate(xi, w) - numeric).norm(), 1e-7) << angle_rad;
  }
}

TEST(Stumpff, FunctionsAndDerivativesAgreeOnBothSidesOfTheSwitch) {
  for (const double x : {kStumpffSeriesBelow, 4.0, 30.0}) {
    // Values by the definition, derivatives by the power series' own, in long double.
    for (const int n : {2, 3}) {
      for (int j = 0; j < 4; ++j) {
        long double sum = 0;
        for (int k = 0; k < 40; ++k) {
          long double term = (k + j) % 2 == 0 ? 1 : -1;
          for (int i = 1; i <= k; ++i) term *= x;
          for (int i = k + 1; i <= k + j; ++i) term *= i;
          for (int i = 2; i <= 2 * k + 2 * j + n; ++i) term /= i;
          sum += term;
        }
        for (const double beside : {x * (1 - 1e-15), x}) {
          const StumpffDerivatives s = stumpff_derivatives(beside);
          const double value = (n == 2 ? s.s2 : s.s3)[static_cast<std::size_t>(j)];
          EXPECT_NEAR(value, static_cast<double>(sum), 1e-15) << "n " << n << " derivative " << j << " at " << beside;
        }
      }
    }
    const Stumpff s = stumpff(x);
    EXPECT_NEAR(s.s1, std::sin(std::sqrt(x)) / std::sqrt(x), 1e-15);
    EXPECT_NEAR(s.s2, (1 - std::cos(std::sqrt(x))) / x, 1e-15);
  }
}

}  // namespace
}  // namespace tarmac::core
