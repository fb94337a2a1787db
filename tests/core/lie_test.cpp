#include "core/lie.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/numeric.h"

namespace tarmac::core {
namespace {

constexpr double pi = std::numbers::pi;

/// Unit vector number i of a stream, uniform on the sphere.
Eigen::Vector3d direction(const RandomStream& stream, std::uint64_t i) {
  return Eigen::Vector3d(stream.normal(i, 0), stream.normal(i, 1), stream.normal(i, 2)).normalized();
}

Vector6 tangent(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  Vector6 xi;
  xi << rho, phi;
  return xi;
}

/// Angles where closed forms and series are hardest: log-spaced from 1e-12 to 0.1, both sides of the switch at 0.2, and
/// up to just below pi.
std::vector<double> edge_angles() {
  std::vector<double> angles;
  for (int k = 0; k <= 110; ++k) angles.push_back(1e-12 * std::pow(10.0, k / 10.0));
  for (const double a : {0.15, 0.2 - 1e-12, 0.2, 0.2 + 1e-12, 0.3, 1.0, 2.0, 3.0, pi - 1e-3, pi - 1e-6}) {
    angles.push_back(a);
  }
  return angles;
}

/// sum of X^n / (n+1)! in long double, so that rounding is not the oracle's: X = hat(phi) or the 6x6 curly hat(xi).
template <int N>
Eigen::Matrix<double, N, N> jacobian_by_series(const Eigen::Matrix<double, N, N>& X) {
  using Wide = Eigen::Matrix<long double, N, N>;
  const Wide wide = X.template cast<long double>();
  Wide term = Wide::Identity(), sum = term;
  for (int n = 1; n < 60; ++n) {
    term = term * wide / static_cast<long double>(n + 1);
    sum += term;
  }
  return sum.template cast<double>();
}

/// sum of B_n X^n / n!, 20 terms and more: for |phi| < 1.
template <int N>
Eigen::Matrix<double, N, N> inverse_jacobian_by_series(const Eigen::Matrix<double, N, N>& X) {
  // B_n from sum over k < n of binomial(n, k) B_k = 0.
  constexpr int terms = 26;
  std::vector<long double> bernoulli = {1};
  for (int n = 1; n < terms; ++n) {
    long double sum = 0, binomial = 1;  // binomial(n + 1, k)
    for (int k = 0; k < n; ++k) {
      sum += binomial * bernoulli[static_cast<std::size_t>(k)];
      binomial = binomial * static_cast<long double>(n + 1 - k) / static_cast<long double>(k + 1);
    }
    bernoulli.push_back(-sum / static_cast<long double>(n + 1));
  }
  using Wide = Eigen::Matrix<long double, N, N>;
  const Wide wide = X.template cast<long double>();
  Wide power = Wide::Identity(), sum = power;
  for (int n = 1; n < terms; ++n) {
    power = power * wide / static_cast<long double>(n);
    sum += bernoulli[static_cast<std::size_t>(n)] * power;
  }
  return sum.template cast<double>();
}

/// [[hat(phi), hat(rho)], [0, hat(phi)]].
Matrix6 curly_hat(const Vector6& xi) {
  Matrix6 X = Matrix6::Zero();
  X.topLeftCorner<3, 3>() = so3::hat(xi.tail<3>());
  X.bottomRightCorner<3, 3>() = X.topLeftCorner<3, 3>();
  X.topRightCorner<3, 3>() = so3::hat(xi.head<3>());
  return X;
}

SE3 random_pose(const RandomStream& stream, std::uint64_t i, double angle_rad, double length_m) {
  return se3::exp(tangent(length_m * direction(stream, 2 * i), angle_rad * direction(stream, 2 * i + 1)));
}

TEST(SO3, HatIsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_EQ(so3::hat(a) * b, a.cross(b));
}

TEST(SO3, LogUndoesExpForAMillionRotations) {
  const RandomStream stream(1, "test/so3_round_trip");
  double worst = 0;
  for (std::uint64_t i = 0; i < 1000000; ++i) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(stream.uniform(i, 0) - 0.5, stream.uniform(i, 1) - 0.5, stream.uniform(i, 2) - 0.5)
            .normalized();
    const Eigen::Vector3d phi = stream.uniform(i, 3) * (pi - 1e-6) * axis;
    worst = std::max(worst, (so3::log(so3::exp(phi)) - phi).norm());
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(SO3, LogUndoesExpAtEdgeAngles) {
  const RandomStream stream(2, "test/so3_edges");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Eigen::Vector3d phi = angle_rad * direction(stream, i++);
    EXPECT_LT((so3::log(so3::exp(phi)) - phi).norm(), 1e-12) << angle_rad;
    // Small angles keep their relative digits too: acos of the trace would return 0 below 1e-8.
    EXPECT_NEAR(so3::angle_rad(so3::exp(phi)) / angle_rad, 1, 1e-3) << angle_rad;
  }
}

TEST(SO3, LogOfAHalfTurnIsAHalfTurn) {
  const RandomStream stream(3, "test/half_turn");
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d axis = direction(stream, i);
    const Eigen::Matrix3d R = 2 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
    const Eigen::Vector3d phi = so3::log(R);
    EXPECT_NEAR(phi.norm(), pi, 1e-12);
    EXPECT_LT((so3::exp(phi) - R).norm(), 1e-12);  // the axis' sign is free, the rotation is not
  }
}

TEST(SO3, ExpIsAngleAxis) {
  const RandomStream stream(4, "test/angle_axis");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Eigen::Vector3d axis = direction(stream, i++);
    EXPECT_LT((so3::exp(angle_rad * axis) - Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix()).norm(), 1e-15)
        << angle_rad;
  }
}

TEST(SO3, JacobiansMatchPowerSeriesWithoutAStepAtTheSwitch) {
  const RandomStream stream(5, "test/so3_jacobian");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Eigen::Vector3d phi = angle_rad * direction(stream, i++);
    const Eigen::Matrix3d K = so3::hat(phi), J = so3::left_jacobian(phi), Jinv = so3::left_jacobian_inverse(phi);
    EXPECT_LT((J - jacobian_by_series<3>(K)).norm(), 1e-13) << angle_rad;
    EXPECT_LT((so3::right_jacobian(phi) - jacobian_by_series<3>(-K)).norm(), 1e-13) << angle_rad;
    EXPECT_LT((J * Jinv - Eigen::Matrix3d::Identity()).norm(), 1e-12) << angle_rad;
    EXPECT_LT((so3::right_jacobian(phi) * so3::right_jacobian_inverse(phi) - Eigen::Matrix3d::Identity()).norm(), 1e-12)
        << angle_rad;
    if (angle_rad <= 1) {
      EXPECT_LT((Jinv - inverse_jacobian_by_series<3>(K)).norm(), 1e-13) << angle_rad;
    }
    // Exp(phi) = I + hat(phi) Jl and Jl = Exp(phi) Jr.
    EXPECT_LT((so3::exp(phi) - Eigen::Matrix3d::Identity() - K * J).norm(), 1e-13) << angle_rad;
    EXPECT_LT((J - so3::exp(phi) * so3::right_jacobian(phi)).norm(), 1e-13) << angle_rad;
  }
}

TEST(SO3, JacobiansMatchCentralDifferences) {
  const RandomStream stream(6, "test/so3_differences");
  std::uint64_t i = 0;
  for (const double angle_rad : {0.0, 1e-9, 1e-5, 0.1, 0.19, 0.21, 0.5, 2.0, 3.0}) {
    const Eigen::Vector3d phi = angle_rad * direction(stream, i++);
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    const Eigen::Matrix3d R = so3::exp(phi);
    const auto left = tests::numeric_jacobian<3, 3>(
        [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return so3::log(so3::exp(x) * R.transpose()); }, phi);
    const auto right = tests::numeric_jacobian<3, 3>(
        [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return so3::log(R.transpose() * so3::exp(x)); }, phi);
    const auto left_inverse = tests::numeric_jacobian<3, 3>(
        [&](const Eigen::Vector3d& d) -> Eigen::Vector3d { return so3::log(so3::exp(d) * R); }, zero);
    const auto right_inverse = tests::numeric_jacobian<3, 3>(
        [&](const Eigen::Vector3d& d) -> Eigen::Vector3d { return so3::log(R * so3::exp(d)); }, zero);
    EXPECT_LT(tests::relative_difference(so3::left_jacobian(phi), left), 1e-6) << angle_rad;
    EXPECT_LT(tests::relative_difference(so3::right_jacobian(phi), right), 1e-6) << angle_rad;
    EXPECT_LT(tests::relative_difference(so3::left_jacobian_inverse(phi), left_inverse), 1e-6) << angle_rad;
    EXPECT_LT(tests::relative_difference(so3::right_jacobian_inverse(phi), right_inverse), 1e-6) << angle_rad;
  }
}

TEST(SE3, LogUndoesExpForAMillionMotions) {
  const RandomStream stream(7, "test/se3_round_trip");
  double worst = 0;
  for (std::uint64_t i = 0; i < 1000000; ++i) {
    const auto centred = [&](std::uint32_t j) { return stream.uniform(i, j) - 0.5; };
    const Eigen::Vector3d axis = Eigen::Vector3d(centred(0), centred(1), centred(2)).normalized();
    const Eigen::Vector3d rho = 10 * Eigen::Vector3d(centred(3), centred(4), centred(5));
    const Vector6 xi = tangent(rho, stream.uniform(i, 6) * (pi - 1e-6) * axis);
    worst = std::max(worst, (se3::log(se3::exp(xi)) - xi).norm());
  }
  EXPECT_LT(worst, 1e-11);
}

TEST(SE3, JacobiansMatchPowerSeriesWithoutAStepAtTheSwitch) {
  const RandomStream stream(8, "test/se3_jacobian");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const Vector6 xi = tangent(0.9 * direction(stream, i), angle_rad * direction(stream, i + 1));
    i += 2;
    const Matrix6 J = se3::left_jacobian(xi), Jinv = se3::left_jacobian_inverse(xi);
    EXPECT_LT((J - jacobian_by_series<6>(curly_hat(xi))).norm(), 1e-13) << angle_rad;
    EXPECT_LT((se3::right_jacobian(xi) - jacobian_by_series<6>(-curly_hat(xi))).norm(), 1e-13) << angle_rad;
    EXPECT_LT((J * Jinv - Matrix6::Identity()).norm(), 1e-12) << angle_rad;
    EXPECT_LT((se3::right_jacobian(xi) * se3::right_jacobian_inverse(xi) - Matrix6::Identity()).norm(), 1e-12)
        << angle_rad;
    if (angle_rad <= 1) {
      EXPECT_LT((Jinv - inverse_jacobian_by_series<6>(curly_hat(xi))).norm(), 1e-13) << angle_rad;
    }
  }
}

TEST(SE3, JacobiansMatchCentralDifferences) {
  const RandomStream stream(9, "test/se3_differences");
  std::uint64_t i = 0;
  for (const double angle_rad : {0.0, 1e-9, 1e-5, 0.1, 0.19, 0.21, 0.5, 2.0, 3.0}) {
    const Vector6 xi = tangent(2 * direction(stream, i), angle_rad * direction(stream, i + 1));
    i += 2;
    const SE3 T = se3::exp(xi), T_inverse = T.inverse();
    const auto left = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& x) -> Vector6 { return se3::log(se3::exp(x) * T_inverse); }, xi);
    const auto right_inverse = tests::numeric_jacobian<6, 6>(
        [&](const Vector6& d) -> Vector6 { return se3::log(T * se3::exp(d)); }, Vector6(Vector6::Zero()));
    EXPECT_LT(tests::relative_difference(se3::left_jacobian(xi), left), 1e-6) << angle_rad;
    EXPECT_LT(tests::relative_difference(se3::right_jacobian_inverse(xi), right_inverse), 1e-6) << angle_rad;
  }
}

TEST(SE3, AdjointCarriesATangentThroughAPose) {
  const RandomStream stream(10, "test/adjoint");
  std::uint64_t i = 0;
  for (const double angle_rad : edge_angles()) {
    const SE3 T = random_pose(stream, i, 2.0, 1.0);
    const Vector6 xi = tangent(direction(stream, i + 1000), angle_rad * direction(stream, i + 2000));
    ++i;
    const SE3 moved = T * se3::exp(xi) * T.inverse();
    EXPECT_LT((moved.matrix() - se3::exp(se3::adjoint(T) * xi).matrix()).norm(), 1e-13) << angle_rad;
  }
}

TEST(SE3, AdjointOfAProductIsTheProductOfAdjoints) {
  const RandomStream stream(11, "test/adjoint_product");
  const SE3 A = random_pose(stream, 0, 1.2, 3), B = random_pose(stream, 1, 2.7, 2);
  EXPECT_LT((se3::adjoint(A * B) - se3::adjoint(A) * se3::adjoint(B)).norm(), 1e-13);
  EXPECT_LT((se3::adjoint(A.inverse()) * se3::adjoint(A) - Matrix6::Identity()).norm(), 1e-13);
}

TEST(SE3, NormalizedRestoresARotationAfterAccumulatedProducts) {
  const SE3 step = se3::exp(tangent({0.1, 0, 0}, {0.01, -0.02, 0.03}));
  SE3 drifting = SE3::Identity();
  // Rounding made visible: each product is off by 1e-9.
  for (int k = 0; k < 1000; ++k) drifting = SE3(drifting * step).matrix() * (1 + 1e-9);
  const Eigen::Matrix3d before = drifting.linear(), after = se3::normalized(drifting).linear();
  EXPECT_GT((before.transpose() * before - Eigen::Matrix3d::Identity()).norm(), 1e-7);
  EXPECT_LT((after.transpose() * after - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_EQ(se3::normalized(drifting).translation(), drifting.translation());
}

TEST(SE3, QuaternionsRoundTripWithNonNegativeW) {
  const RandomStream stream(12, "test/quaternion");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const SE3 T = random_pose(stream, i, pi * stream.uniform(i), 5);
    const Eigen::Vector4d q = se3::quat_xyzw(T);
    EXPECT_GE(q[3], 0);
    EXPECT_NEAR(q.norm(), 1, 1e-15);
    EXPECT_LT((se3::from_xyz_quat(T.translation(), q).matrix() - T.matrix()).norm(), 1e-14);
    EXPECT_LT((se3::from_xyz_quat(T.translation(), -q).matrix() - T.matrix()).norm(), 1e-14);
  }
}

TEST(SE3, FromQuaternionTakesRoundedOnesAndRefusesOthers) {
  EXPECT_NO_THROW(se3::from_xyz_quat({0, 0, 0}, {0, 0, 0.70711, 0.70711}));
  const SE3 T = se3::from_xyz_quat({0, 0, 0}, {0, 0, 0.70711, 0.70711});
  EXPECT_LT((T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  const double nan = std::nan("");
  EXPECT_THROW(se3::from_xyz_quat({0, 0, 0}, {0, 0, 0, 1.002}), InputError);
  EXPECT_THROW(se3::from_xyz_quat({0, 0, 0}, {0, 0, 0, 0}), InputError);
  EXPECT_THROW(se3::from_xyz_quat({0, 0, 0}, {0, 0, 0, nan}), InputError);
  EXPECT_THROW(se3::from_xyz_quat({0, nan, 0}, {0, 0, 0, 1}), InputError);
}

TEST(SE3, AllFiniteSeesNanAndInfinity) {
  SE3 T = SE3::Identity();
  EXPECT_TRUE(se3::all_finite(T));
  T.translation().y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(se3::all_finite(T));
  T = SE3::Identity();
  T.matrix()(1, 2) = std::nan("");
  EXPECT_FALSE(se3::all_finite(T));
}

}  // namespace
}  // namespace tarmac::core
