#include "estimators/blocks/assembler.h"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace tarmac::estimators {

using core::BlockJacobian;
using core::Matrix6;
using core::Row6;
using core::SE3;
using core::SegmentModel;
using Eigen::Matrix3d;
using Eigen::Vector3d;
namespace so3 = core::so3;
namespace se3 = core::se3;

SegmentSampler::SegmentSampler(const core::Segment& segment) : model_(segment.model), T0_(segment.poses.at(0)) {
  if (model_ == SegmentModel::held) return;
  if (model_ != SegmentModel::two_pose_slerp && model_ != SegmentModel::two_pose_screw) {
    throw std::invalid_argument("SegmentSampler knows held and two-pose segments");
  }
  blocks_ = 2;
  T1_ = segment.poses.at(1);
  if (model_ == SegmentModel::two_pose_screw) {
    twist_ = se3::log(T0_.inverse() * T1_);
    right_inverse_ = se3::right_jacobian_inverse(twist_);
    left_inverse_ = se3::left_jacobian_inverse(twist_);
  } else {
    const Vector3d w = so3::log(T0_.linear().transpose() * T1_.linear());
    twist_.tail<3>() = w;
    right_inverse_.bottomRightCorner<3, 3>() = so3::right_jacobian_inverse(w);
    left_inverse_.bottomRightCorner<3, 3>() = so3::left_jacobian_inverse(w);
  }
}

SE3 SegmentSampler::pose(double s) const {
  if (blocks_ == 1) return T0_;
  if (model_ == SegmentModel::two_pose_screw) return T0_ * se3::exp(s * twist_);
  SE3 T = SE3::Identity();
  T.linear() = T0_.linear() * so3::exp(s * twist_.tail<3>());
  T.translation() = (1 - s) * T0_.translation() + s * T1_.translation();
  return T;
}

SE3 SegmentSampler::pose(double s, std::array<BlockJacobian, 2>& jacobians) const {
  // The chain is core/trajectory.cpp's.
  const SE3 T = pose(s);
  jacobians[0].block = 0;
  jacobians[1].block = 1;
  Matrix6 &J0 = jacobians[0].jacobian, &J1 = jacobians[1].jacobian;
  if (blocks_ == 1) {
    J0.setIdentity();
    return T;
  }
  if (model_ == SegmentModel::two_pose_screw) {
    const Matrix6 Jr_s = s * se3::right_jacobian(s * twist_);
    J1.noalias() = Jr_s * right_inverse_;
    J0 = se3::adjoint(se3::exp(-s * twist_)) - Jr_s * left_inverse_;
    return T;
  }
  const Vector3d w = twist_.tail<3>();
  const Matrix3d Jr_s = s * so3::right_jacobian(s * w);
  J0.setZero();
  J1.setZero();
  J0.topLeftCorner<3, 3>() = (1 - s) * T.linear().transpose() * T0_.linear();
  J1.topLeftCorner<3, 3>() = s * T.linear().transpose() * T1_.linear();
  J0.bottomRightCorner<3, 3>() = T.linear().transpose() * T0_.linear() - Jr_s * left_inverse_.bottomRightCorner<3, 3>();
  J1.bottomRightCorner<3, 3>() = Jr_s * right_inverse_.bottomRightCorner<3, 3>();
  return T;
}

NormalEquations::NormalEquations(int blocks) : blocks_(blocks) {
  H_data_.setZero(6 * blocks, 6 * blocks);
  H_prior_.setZero(6 * blocks, 6 * blocks);
  g_data_.setZero(6 * blocks);
  g_prior_.setZero(6 * blocks);
}

void NormalEquations::set_zero() {
  data_rows_ = 0;
  H_data_.setZero();
  H_prior_.setZero();
  g_data_.setZero();
  g_prior_.setZero();
}

void NormalEquations::add_data(double residual, double weight, const Row6& by_pose,
                               std::span<const BlockJacobian> pose) {
  std::array<Row6, 8> rows;
  if (pose.size() > rows.size()) throw std::invalid_argument("a pose depends on at most 8 blocks here");
  for (std::size_t a = 0; a < pose.size(); ++a) {
    rows[a].noalias() = by_pose * pose[a].jacobian;
    const Row6 weighted = weight * rows[a];
    g_data_.segment<6>(6 * pose[a].block) += residual * weighted.transpose();
    for (std::size_t b = 0; b <= a; ++b) {
      H_data_.block<6, 6>(6 * pose[a].block, 6 * pose[b].block).noalias() += weighted.transpose() * rows[b];
      if (b != a) {
        H_data_.block<6, 6>(6 * pose[b].block, 6 * pose[a].block).noalias() += rows[b].transpose() * weighted;
      }
    }
  }
  ++data_rows_;
}

void NormalEquations::add_prior(double residual, double weight, std::span<const PriorTerm> terms) {
  for (const PriorTerm& a : terms) {
    g_prior_.segment<6>(6 * a.block) += weight * residual * a.jacobian.transpose();
    for (const PriorTerm& b : terms) {
      H_prior_.block<6, 6>(6 * a.block, 6 * b.block).noalias() += weight * a.jacobian.transpose() * b.jacobian;
    }
  }
}

void NormalEquations::add(const NormalEquations& other) {
  data_rows_ += other.data_rows_;
  H_data_ += other.H_data_;
  H_prior_ += other.H_prior_;
  g_data_ += other.g_data_;
  g_prior_ += other.g_prior_;
}

bool NormalEquations::solve(Eigen::VectorXd& x) const {
  const Eigen::MatrixXd H = H_data_ + H_prior_;
  // Rotations and translations have different units: scaled to a unit diagonal, pivots can be compared.
  const Eigen::VectorXd diagonal = H.diagonal();
  if (!(diagonal.minCoeff() > 0) || !diagonal.allFinite()) return false;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(scale.asDiagonal() * H * scale.asDiagonal());
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 1e-12)) return false;
  const Eigen::VectorXd step = scale.asDiagonal() * ldlt.solve(-(scale.asDiagonal() * (g_data_ + g_prior_)));
  if (!step.allFinite()) return false;
  x = step;
  return true;
}

}  // namespace tarmac::estimators
