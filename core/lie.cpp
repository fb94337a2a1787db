#include "core/lie.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace tarmac::core {
namespace {

/// Coefficients of the Jacobians as functions of the angle a. Below kSeries the closed forms lose digits (measured: the
/// cubic-and-higher ones lose 1e-8 at a = 1e-2), so power series take over; eight terms leave < 1e-17 at a = 0.2.
constexpr double kSeries = 0.2;

/// sum over k of (-1)^k x^k / reciprocals[k], by Horner.
double alternating_series(double x, const double* reciprocals, int n) {
  double sum = 0;
  for (int k = n - 1; k >= 0; --k) sum = 1.0 / reciprocals[k] - x * sum;
  return sum;
}

struct Coefficients {
  double A;  ///< sin a / a
  double B;  ///< (1 - cos a) / a^2
  double C;  ///< (a - sin a) / a^3
  double D;  ///< 1/a^2 - (1 + cos a)/(2 a sin a), of the inverse Jacobian
};

Coefficients coefficients(double a) {
  const double a2 = a * a;
  if (a < kSeries) {
    static constexpr double kA[] = {1, 6, 120, 5040, 362880, 39916800, 6227020800.};
    static constexpr double kB[] = {2, 24, 720, 40320, 3628800, 479001600, 87178291200.};
    static constexpr double kC[] = {6, 120, 5040, 362880, 39916800, 6227020800., 1307674368000.};
    // D has all-positive Bernoulli coefficients: 1/12, 1/720, 1/30240, 1/1209600, 1/47900160, 691/1307674368000, ...
    const double D =
        1.0 / 12 +
        a2 * (1.0 / 720 +
              a2 * (1.0 / 30240 +
                    a2 * (1.0 / 1209600 + a2 * (1.0 / 47900160 + a2 * (691.0 / 1307674368000. + a2 / 74724249600.)))));
    return {alternating_series(a2, kA, 7), alternating_series(a2, kB, 7), alternating_series(a2, kC, 7), D};
  }
  const double s = std::sin(a), half_s = std::sin(a / 2), half_c = std::cos(a / 2);
  // (a/2) cot(a/2) stays regular at a = pi, where (1 + cos a)/sin a would be 0/0.
  return {s / a, 2 * half_s * half_s / a2, (a - s) / (a2 * a), (1 - (a / 2) * half_c / half_s) / a2};
}

/// Q(rho, phi): the upper right block of the left Jacobian of SE(3), Barfoot (2017) eq. 7.86.
Eigen::Matrix3d q_block(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  const double a2 = phi.squaredNorm(), a = std::sqrt(a2);
  double c1, c2, c3;
  if (a < kSeries) {
    static constexpr double k1[] = {6, 120, 5040, 362880, 39916800, 6227020800., 1307674368000.};
    static constexpr double k2[] = {24, 720, 40320, 3628800, 479001600, 87178291200., 20922789888000.};
    // (2a - 3 sin a + a cos a)/(2 a^5): the a^(2k) coefficient is (k + 1)/(2k + 5)!.
    static constexpr double k3[] = {120, 2520, 120960, 9979200, 1245404160., 217945728000., 50812489728000.};
    c1 = alternating_series(a2, k1, 7);
    c2 = alternating_series(a2, k2, 7);
    c3 = alternating_series(a2, k3, 7);
  } else {
    const double s = std::sin(a), c = std::cos(a);
    c1 = (a - s) / (a2 * a);
    c2 = (a2 + 2 * c - 2) / (2 * a2 * a2);
    c3 = (2 * a - 3 * s + a * c) / (2 * a2 * a2 * a);
  }
  const Eigen::Matrix3d R = so3::hat(rho), P = so3::hat(phi);
  const Eigen::Matrix3d PR = P * R, RP = R * P, PRP = PR * P;
  return 0.5 * R + c1 * (PR + RP + PRP) + c2 * (P * PR + RP * P - 3 * PRP) + c3 * (PRP * P + P * PRP);
}

}  // namespace

namespace so3 {

Eigen::Matrix3d hat(const Eigen::Vector3d& phi) {
  Eigen::Matrix3d K;
  K << 0, -phi.z(), phi.y(), phi.z(), 0, -phi.x(), -phi.y(), phi.x(), 0;
  return K;
}

Eigen::Matrix3d exp(const Eigen::Vector3d& phi) {
  const Coefficients c = coefficients(phi.norm());
  const Eigen::Matrix3d K = hat(phi);
  return Eigen::Matrix3d::Identity() + c.A * K + c.B * K * K;
}

Eigen::Vector3d log(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.w() < 0) q.coeffs() *= -1;
  const double v = q.vec().norm(), w = q.w();
  // Near zero the ratio angle / |v| by its series in v/w: 2/w (1 - (v/w)^2/3).
  if (v < 1e-5) return q.vec() * (2 / w) * (1 - v * v / (3 * w * w));
  return q.vec() * (2 * std::atan2(v, w) / v);
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const Coefficients c = coefficients(phi.norm());
  const Eigen::Matrix3d K = hat(phi);
  return Eigen::Matrix3d::Identity() + c.B * K + c.C * K * K;
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const Coefficients c = coefficients(phi.norm());
  const Eigen::Matrix3d K = hat(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * K + c.D * K * K;
}

double angle_rad(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

}  // namespace so3

namespace se3 {

SE3 exp(const Vector6& xi) {
  SE3 T = SE3::Identity();
  const Eigen::Vector3d phi = xi.tail<3>();
  T.linear() = so3::exp(phi);
  T.translation() = so3::left_jacobian(phi) * xi.head<3>();
  return T;
}

Vector6 log(const SE3& T) {
  const Eigen::Vector3d phi = so3::log(T.linear());
  Vector6 xi;
  xi << so3::left_jacobian_inverse(phi) * T.translation(), phi;
  return xi;
}

Matrix6 adjoint(const SE3& T) {
  Matrix6 Ad = Matrix6::Zero();
  Ad.topLeftCorner<3, 3>() = T.linear();
  Ad.topRightCorner<3, 3>() = so3::hat(T.translation()) * T.linear();
  Ad.bottomRightCorner<3, 3>() = T.linear();
  return Ad;
}

Matrix6 left_jacobian(const Vector6& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  Matrix6 J = Matrix6::Zero();
  J.topLeftCorner<3, 3>() = so3::left_jacobian(phi);
  J.bottomRightCorner<3, 3>() = J.topLeftCorner<3, 3>();
  J.topRightCorner<3, 3>() = q_block(xi.head<3>(), phi);
  return J;
}

Matrix6 left_jacobian_inverse(const Vector6& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  const Eigen::Matrix3d Jinv = so3::left_jacobian_inverse(phi);
  Matrix6 J = Matrix6::Zero();
  J.topLeftCorner<3, 3>() = Jinv;
  J.bottomRightCorner<3, 3>() = Jinv;
  J.topRightCorner<3, 3>() = -Jinv * q_block(xi.head<3>(), phi) * Jinv;
  return J;
}

SE3 normalized(const SE3& T) {
  SE3 out = SE3::Identity();
  out.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  out.translation() = T.translation();
  return out;
}

SE3 from_xyz_quat(const Eigen::Vector3d& xyz_m, const Eigen::Vector4d& quat_xyzw) {
  const double norm = quat_xyzw.norm();
  if (!(std::abs(norm - 1) <= 1e-3) || !xyz_m.allFinite()) {
    throw InputError(
        fmt::format("a pose needs a finite translation and a quaternion x y z w of norm 1 (within 1e-3); "
                    "its norm is {:.6g}",
                    norm));
  }
  SE3 T = SE3::Identity();
  T.linear() =
      Eigen::Quaterniond(quat_xyzw[3], quat_xyzw[0], quat_xyzw[1], quat_xyzw[2]).normalized().toRotationMatrix();
  T.translation() = xyz_m;
  return T;
}

Eigen::Vector4d quat_xyzw(const SE3& T) {
  Eigen::Quaterniond q(T.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() *= -1;
  return q.coeffs();
}

bool all_finite(const SE3& T) {
  return T.matrix().allFinite();
}

}  // namespace se3
}  // namespace tarmac::core
