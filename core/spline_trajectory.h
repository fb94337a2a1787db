/// Cumulative B-splines as trajectories, of order 4 (cubic) to 6, on knots at any ascending times.
///
/// n control points have n + order knots t_0 < t_1 < ...; interval i, [t_i, t_{i+1}), depends on the control points
/// i - order + 1 to i, so the span begins at knot order - 1 and ends before knot n. (The first and the last knot bear
/// no weight; they keep the count of the textbooks.) A block is a control point's six parameters, translation first.
/// Split: p <- p + rho (world axes), R <- R Exp(phi). Se3: T <- T Exp(rho, phi).
///
/// Neighbouring control points may be turned against each other by less than pi; keep it below pi/2 (knots so close
/// that spacing x |omega| < 1 rad), since at pi the way between them is ambiguous. Nothing checks it. All const
/// functions may be called at the same time from several threads. Source: de Boor, A Practical Guide to Splines (2001);
/// Sommer et al., CVPR 2020.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/parametric_trajectory.h"
#include "core/spline_interval.h"

namespace tarmac::core {

class SplineTrajectory final : public ParametricTrajectory {
 public:
  /// Throws InputError unless order is 4 to 6, there are at least `order` control points, all finite, `order` more
  /// knots than control points, and the knots ascend.
  SplineTrajectory(SplineKind kind, int order, std::vector<SE3> control_points, std::vector<Time> knots);
  /// Standing still: all control points equal, as many as the knots ask for (knots.h makes knots).
  static SplineTrajectory at_rest(SplineKind kind, int order, const SE3& T_world_body, std::vector<Time> knots);

  SplineKind kind() const { return kind_; }
  int order() const { return order_; }
  const std::vector<SE3>& control_points() const { return control_; }
  const std::vector<Time>& knots() const { return knots_; }

  /// Knot order - 1.
  Time begin() const override { return knots_[static_cast<std::size_t>(order_ - 1)]; }
  /// One nanosecond before knot n: intervals hold their beginning but not their end.
  Time end() const override { return knots_[control_.size()] - Duration(1); }
  SE3 pose(Time t) const override;
  Kinematics at(Time t) const override;

  int block_size() const override { return 6; }
  int blocks() const override { return static_cast<int>(control_.size()); }
  int reach() const override { return order_; }
  Derivative has() const override { return Derivative::acceleration; }
  void jet(Time t, Derivative upto, StateJet& jet) const override;
  StateVector rate(Time t, Derivative upto) const override;
  /// The same bits as pose(). Throws OutOfSpan, and InputError for times that do not ascend.
  void poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const override;

  /// Throws std::domain_error, changing nothing, for a step that is not finite.
  void retract(const Eigen::Ref<const Eigen::VectorXd>& step) override;
  /// Rotation column by column, then translation.
  Eigen::VectorXd value(int block) const override;
  void difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const override;

  /// Knots that exist never move, also those beyond the end (a knot bears on order - 2 intervals before it). Of
  /// `knots`, those at or before the last one are ignored, the others are appended, and then the last spacing is
  /// repeated until `order` knots lie after `end`. So a rule for knots comes to bear only beyond knots().back(): pass
  /// it that time, and have it place `order` knots after `end` (knots.h). A new control point repeats the way between
  /// the last two, scaled by the ratio of spacings of their Greville abscissae: a motion at constant velocity goes on
  /// exactly. Throws InputError where `begin` lies before begin() or `knots` do not ascend.
  void extend(Time begin, Time end, std::span<const Time> knots) override;
  /// Also beyond the end, as far as knots tell; 0 before the begin.
  int first_block_at(Time t) const override;
  /// Throws std::invalid_argument where fewer than `order` control points would be left.
  void drop(int count) override;

  Segment segment(Time t0, Time t1) const override;
  std::unique_ptr<ParametricTrajectory> clone() const override { return std::make_unique<SplineTrajectory>(*this); }

 private:
  int interval_at(Time t) const;  ///< index into intervals_; throws OutOfSpan
  SplineView view(int interval) const;
  void refresh(std::size_t first_control);

  SplineKind kind_;
  int order_;
  std::vector<SE3> control_;
  std::vector<Time> knots_;
  // What follows is derived from those.
  std::vector<SplineStep> steps_;  ///< from control point i to i + 1
  std::vector<SplineStepJacobians> step_jacobians_;
  std::vector<SplineInterval> intervals_;  ///< the first begins at knot order - 1
};

/// The time about which a control point acts: the mean of the order - 1 knots after its first. A straight motion at
/// constant velocity has its control points on the line, at those times.
double greville_ns_after(Time origin, std::span<const Time> knots, int order, int control_point);

}  // namespace tarmac::core
