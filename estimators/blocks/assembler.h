/// From residuals at a time to normal equations of a trajectory's parameters.
///
/// A residual knows its Jacobian by the pose at its own time, a segment knows how that pose depends on its parameters;
/// the assembler chains the two, so that any residual works on any segment.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/lie.h"
#include "core/trajectory.h"

namespace tarmac::estimators {

/// Poses and Jacobians of one segment at many instants: what Segment::pose gives, with what does not depend on the
/// instant worked out once.
class SegmentSampler {
 public:
  SegmentSampler() = default;
  /// Models: two_pose_slerp, two_pose_screw, held; others throw std::invalid_argument.
  explicit SegmentSampler(const core::Segment& segment);

  /// Parameter blocks of the segment: 2, or 1 when held.
  int blocks() const { return blocks_; }
  /// s in [0, 1] is the instant's place between t0 and t1.
  core::SE3 pose(double s) const;
  /// And its Jacobian by each block, the first blocks() entries.
  core::SE3 pose(double s, std::array<core::BlockJacobian, 2>& jacobians) const;

 private:
  core::SegmentModel model_ = core::SegmentModel::held;
  int blocks_ = 1;
  core::SE3 T0_ = core::SE3::Identity(), T1_ = core::SE3::Identity();
  core::Vector6 twist_ = core::Vector6::Zero();  ///< screw: Log(T0^-1 T1); slerp: the rotation's in its last three
  core::Matrix6 right_inverse_ = core::Matrix6::Identity(), left_inverse_ = core::Matrix6::Identity();
};

/// Normal equations of 6-dimensional blocks, data and priors apart:
///   H = sum w J^T J,  g = sum w J^T r,   cost = sum w r^2 / 2;   step: (H_data + H_prior) x = -(g_data + g_prior)
/// Blocks are poses perturbed on the right, translation first.
class NormalEquations {
 public:
  explicit NormalEquations(int blocks);

  int blocks() const { return blocks_; }
  int data_rows() const { return data_rows_; }
  void set_zero();

  /// A residual with its Jacobian by the pose at its time, and that pose's by the blocks.
  void add_data(double residual, double weight, const core::Row6& by_pose, std::span<const core::BlockJacobian> pose);
  /// A prior with its Jacobian by each block that it depends on.
  struct PriorTerm {
    int block = 0;
    core::Row6 jacobian = core::Row6::Zero();
  };
  void add_prior(double residual, double weight, std::span<const PriorTerm> terms);
  /// Adds the sums of others, taken over parts of the same problem.
  void add(const NormalEquations& other);

  const Eigen::MatrixXd& H_data() const { return H_data_; }
  const Eigen::MatrixXd& H_prior() const { return H_prior_; }
  const Eigen::VectorXd& g_data() const { return g_data_; }
  const Eigen::VectorXd& g_prior() const { return g_prior_; }

  /// The step of both parts together. False where the matrix is singular to working precision: x is then unchanged.
  bool solve(Eigen::VectorXd& x) const;

 private:
  int blocks_;
  int data_rows_ = 0;
  Eigen::MatrixXd H_data_, H_prior_;
  Eigen::VectorXd g_data_, g_prior_;
};

}  // namespace tarmac::estimators
