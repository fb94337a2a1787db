/// SO(3) and SE(3): exponentials, logarithms and their exact Jacobians.
///
/// Tangents of SE(3) are ordered translation first, xi = (rho, phi); perturbations act on the right unless a name says
/// otherwise: T <- T Exp(xi). A pose is an Eigen::Isometry3d named T_to_from: p_to = T_to_from * p_from.
/// Series replace the closed forms below an angle of 0.2 rad, where those lose digits.
/// Source: Barfoot, State Estimation for Robotics (2017), ch. 7; Sola et al. 2018 (arXiv:1812.01537).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tarmac::core {

using SE3 = Eigen::Isometry3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Row6 = Eigen::Matrix<double, 1, 6>;

namespace so3 {
Eigen::Matrix3d hat(const Eigen::Vector3d& phi);
Eigen::Matrix3d exp(const Eigen::Vector3d& phi);
/// By the quaternion and atan2: as exact near 0 and near pi as in between. |result| <= pi.
Eigen::Vector3d log(const Eigen::Matrix3d& R);
/// Jl: Exp(phi + d) = Exp(Jl d) Exp(phi) to first order. The right Jacobian is Jl(-phi).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi);
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);
inline Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi) {
  return left_jacobian(-phi);
}
inline Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& phi) {
  return left_jacobian_inverse(-phi);
}
/// Rotation angle in [0, pi], by atan2: no floor near 0, unlike acos of the trace.
double angle_rad(const Eigen::Matrix3d& R);
}  // namespace so3

namespace se3 {
SE3 exp(const Vector6& xi);
Vector6 log(const SE3& T);
/// Ad: T Exp(xi) T^-1 = Exp(Ad xi).
Matrix6 adjoint(const SE3& T);
Matrix6 left_jacobian(const Vector6& xi);
Matrix6 left_jacobian_inverse(const Vector6& xi);
inline Matrix6 right_jacobian(const Vector6& xi) {
  return left_jacobian(-xi);
}
inline Matrix6 right_jacobian_inverse(const Vector6& xi) {
  return left_jacobian_inverse(-xi);
}
/// The same motion with an exactly orthonormal rotation: call it after every product that accumulates.
SE3 normalized(const SE3& T);
/// From a translation [m] and a quaternion x, y, z, w; throws InputError when its norm is off 1 by more than 1e-3.
SE3 from_xyz_quat(const Eigen::Vector3d& xyz_m, const Eigen::Vector4d& quat_xyzw);
/// Quaternion x, y, z, w with w >= 0.
Eigen::Vector4d quat_xyzw(const SE3& T);
bool all_finite(const SE3& T);
}  // namespace se3

}  // namespace tarmac::core
