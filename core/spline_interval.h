/// The arithmetic of a cumulative B-spline within one interval between knots, shared by spline_trajectory.h and
/// spline_segment.h; nobody else needs it.
///
/// T(t) = T_0 A_1 ... A_{k-1} with A_j = Exp(lambda_j(t) d_j), d_j = Log(T_{j-1}^-1 T_j). Split: of rotations alone,
/// and p(t) = p_0 + sum of lambda_j (p_j - p_{j-1}). Velocity, acceleration, jerk and the Jacobians take O(k) steps.
/// Source: Sommer et al., Efficient Derivative Computation for Cumulative B-Splines on Lie Groups, CVPR 2020.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/blending.h"
#include "core/parametric_trajectory.h"

namespace tarmac::core {

enum class SplineKind : std::uint8_t {
  split,  ///< rotations on SO(3), positions on their own: acceleration is linear in the positions' control points
  se3,    ///< whole poses on SE(3): a constant twist in the body's frame is a straight line
};

/// What does not depend on time of the way from one control point to the next: d = angle * axis, and (se3) the
/// translation rho taken apart along and across the axis, so that Exp(lambda d) costs one sine and cosine.
struct SplineStep {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< unit, or zero where nothing turns
  double angle_rad = 0;
  Eigen::Vector3d along_m = Eigen::Vector3d::Zero();   ///< axis (axis . rho)
  Eigen::Vector3d across_m = Eigen::Vector3d::Zero();  ///< (rho - along)/angle
  Eigen::Vector3d turned_m = Eigen::Vector3d::Zero();  ///< (axis x rho)/angle
};
SplineStep spline_step(SplineKind kind, const SE3& T_from, const SE3& T_to);

/// d, and the inverse Jacobians of Log at d. Every 6x6 matrix that occurs is [X Y; 0 X], kept as X (`real`) and Y
/// (`dual`); split has X alone.
struct SplineStepJacobians {
  Eigen::Vector3d phi, rho;
  Eigen::Matrix3d right_inverse_real, right_inverse_dual, left_inverse_real, left_inverse_dual;
};
SplineStepJacobians spline_step_jacobians(SplineKind kind, const SE3& T_from, const SE3& T_to);

/// What does not depend on time of one interval.
struct SplineInterval {
  Time begin, end;
  double per_ns = 0;  ///< 1/(end - begin)
  double per_s = 0;
  /// lambda[m][j - 1]: coefficient of u^m in lambda_j.
  std::array<std::array<double, kMaxSplineOrder - 1>, kMaxSplineOrder> lambda{};
  Eigen::Quaterniond q_first = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_first = Eigen::Vector3d::Zero();
  /// Split: p = sum of position[m] u^m.
  std::array<Eigen::Vector3d, kMaxSplineOrder> position{};

  double u(Time t) const { return static_cast<double>((t - begin).count()) * per_ns; }
};
/// `knots`: 2 order - 2, `control`: order poses.
SplineInterval spline_interval(SplineKind kind, int order, std::span<const Time> knots, std::span<const SE3> control);

/// An interval with its order - 1 steps.
struct SplineView {
  SplineKind kind;
  int order;
  const SplineInterval* interval;
  const SplineStep* steps;
  const SplineStepJacobians* jacobians = nullptr;  ///< poses alone need none
};

SE3 spline_pose(const SplineView& view, double u);
/// Poses at ascending times from the view's interval on; intervals and steps stand one after the other in memory, the
/// last interval being `last`. Equal times are evaluated once. Throws InputError for times that do not ascend.
void spline_poses(SplineView view, const SplineInterval* last, std::span<const Time> ascending, std::span<SE3> out);
Kinematics spline_kinematics(const SplineView& view, double u);
StateVector spline_rate(const SplineView& view, double u, Derivative upto);
/// State and Jacobian by the interval's order control points, 6 columns each; jet.first is left alone.
void spline_jet(const SplineView& view, double u, Derivative upto, StateJet& jet);

}  // namespace tarmac::core
