/// A Gaussian process on SE(3) as a trajectory: knots (pose, velocity, and its derivative) with a prior between them.
///
/// Blocks are knots: pose (6, perturbed on the right), varpi (6), and for wnoj and singer varpi' (6). Between two knots
/// the process's mean is an O(1) query (gp_interval.h), at a knot it is the knot itself, bit for bit. All models give
/// accelerations: those of wnoj and singer are part of their state (continuous; within an interval equal to the
/// derivative of the velocity up to O(|xi|), by the published form), those of wnoa are the exact derivative of the
/// mean's velocity and jump at knots, where the one of the interval after the knot holds (at the last knot: before it).
/// A wnoa of one knot has none: zero. What is constant per interval is computed whenever knots change, so that const
/// calls may run side by side. Rotations between neighbouring knots should stay below about 0.5 rad, and must below pi.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/gp_interval.h"
#include "core/gp_prior.h"
#include "core/parametric_trajectory.h"

namespace tarmac::core {

/// Knots closer than this make the prior's information overflow (720/d^5).
inline constexpr Duration kGpMinimumSpacing = std::chrono::milliseconds(1);

/// A covariance that should be positive semi-definite; `projected` says that it was not and negative eigenvalues were
/// set to zero.
struct GpCovariance {
  Eigen::MatrixXd P;
  bool projected = false;
};

class GpTrajectory final : public ParametricTrajectory {
 public:
  /// One knot or more. Throws InputError for a bad prior, knots that are not finite, or closer than 1 ms.
  GpTrajectory(GpPrior prior, std::vector<GpKnot> knots);
  /// From what segment() made; qc is not kept in segments, and of no meaning to the mean.
  static GpTrajectory from_segment(const Segment& segment, const Vector6& qc = Vector6::Ones());

  const GpPrior& process() const { return prior_; }
  const std::vector<GpKnot>& knots() const { return knots_; }

  Time begin() const override { return knots_.front().t; }
  Time end() const override { return knots_.back().t; }
  SE3 pose(Time t) const override;
  Kinematics at(Time t) const override;

  int block_size() const override { return prior_.size(); }
  int blocks() const override { return static_cast<int>(knots_.size()); }
  int reach() const override { return 2; }
  Derivative has() const override { return Derivative::acceleration; }
  /// Columns: both knots' blocks; at a knot that knot's alone, where nothing else matters. Accelerations of jet.state
  /// are those of at() where they are asked for; else they may be zero.
  void jet(Time t, Derivative upto, StateJet& jet) const override;
  /// Exact for every row, by derivatives of the mean itself; at a knot those of the interval after it (the last: before
  /// it).
  StateVector rate(Time t, Derivative upto) const override;
  void poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const override;

  void retract(const Eigen::Ref<const Eigen::VectorXd>& step) override;
  /// The pose's upper 3x4 (12 numbers, by column), varpi, varpi'.
  Eigen::VectorXd value(int block) const override;
  void difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const override;

  int priors() const override { return blocks() - 1; }
  /// e = gamma_2 - Phi gamma_1, information Q^-1, J exact.
  void prior(int i, PriorJet& jet) const override;
  /// Zero at knots. Of wnoa the rows of acceleration, which is no part of its state, are zero.
  Eigen::MatrixXd conditional_covariance(Time t, Derivative upto) const override;

  /// Adds knots at `knots` with the process's mean, and one at `end` should they end before it. `begin` must not lie
  /// before the first knot.
  void extend(Time begin, Time end, std::span<const Time> knots) override;
  int first_block_at(Time t) const override;
  /// At least one knot remains.
  void drop(int count) override;

  /// Knots from the one at or before t0 to the one at or after t1, two at least.
  Segment segment(Time t0, Time t1) const override;
  std::unique_ptr<ParametricTrajectory> clone() const override { return std::make_unique<GpTrajectory>(*this); }

  /// Covariance of the knot-like state (pose, varpi[, varpi']) at t, from the joint covariance of the two knots around
  /// it (2 block_size() square; of the state's perturbations, columns as in jet()).
  GpCovariance covariance(Time t, const Eigen::MatrixXd& joint) const;
  /// The mean after the last knot and its covariance, from that of the last knot. Throws OutOfSpan before it.
  GpKnot extrapolated(Time t) const;
  GpCovariance extrapolated_covariance(Time t, const Eigen::MatrixXd& of_last_knot) const;

 private:
  std::size_t interval_at(Time t) const;
  void check_span(Time t) const;
  /// Intervals from `first` on, anew.
  void refresh(std::size_t first);
  double since_knot(std::size_t interval, Time t) const { return to_s(t - knots_[interval].t); }
  GpLocal predicted(const GpKnot& from, double d) const;

  GpPrior prior_;
  GpAxisGroups groups_;
  std::vector<GpKnot> knots_;
  std::vector<GpInterval> intervals_;
  std::vector<GpIntervalJacobian> jacobians_;
};

}  // namespace tarmac::core
