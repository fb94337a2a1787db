#include "estimators/window/marginal_prior.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "core/symmetric_eigen.h"
#include "estimators/window/gravity_direction.h"

namespace tarmac::estimators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmallestEigenvalue = 1e-12;
/// By Cholesky, which keeps more digits, where what it gives up is far from rounding.
constexpr double kWellConditioned = 1e-9;

VectorXd unit_scale(const MatrixXd& H) {
  return H.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
}

/// H^+ X, with H scaled to unit diagonal and inverted where its eigenvalues exceed kSmallestEigenvalue of the largest.
MatrixXd pseudo_solve(const MatrixXd& H, const MatrixXd& X) {
  const VectorXd scale = unit_scale(H);
  const MatrixXd unit = scale.asDiagonal() * H * scale.asDiagonal(), x = scale.asDiagonal() * X;
  const Eigen::LLT<MatrixXd> llt(unit);
  if (llt.info() == Eigen::Success && llt.rcond() > kWellConditioned) return scale.asDiagonal() * llt.solve(x);
  const core::SymmetricEigen eigen(unit);
  const double least = kSmallestEigenvalue * eigen.eigenvalues().maxCoeff();
  const VectorXd inverse =
      eigen.eigenvalues().unaryExpr([least](double value) { return value > least ? 1 / value : 0.0; });
  const auto& V = eigen.eigenvectors();
  return scale.asDiagonal() * (V * (inverse.asDiagonal() * (V.transpose() * x)));
}

}  // namespace

Schur marginalise(const Eigen::Ref<const MatrixXd>& H, const Eigen::Ref<const VectorXd>& g, int removed,
                  double threshold) {
  const Index r = removed, k = H.rows() - r;
  Schur result{H.bottomRightCorner(k, k), g.tail(k)};
  if (r > 0) {
    MatrixXd both(r, k + 1);
    both << H.topRightCorner(r, k), g.head(r);
    const MatrixXd x = pseudo_solve(H.topLeftCorner(r, r), both);
    result.H.noalias() -= H.bottomLeftCorner(k, r) * x.leftCols(k);
    result.g.noalias() -= H.bottomLeftCorner(k, r) * x.col(k);
  }
  result.H = ((result.H + result.H.transpose()) / 2).eval();
  if (!(threshold > 0) || k == 0) return result;
  const core::SymmetricEigen eigen(result.H);
  const double least = threshold * eigen.eigenvalues().maxCoeff();
  // Written as a product of a matrix with itself, so that rounding leaves no negative eigenvalue but its own.
  MatrixXd kept = eigen.eigenvectors();
  VectorXd projected = VectorXd::Zero(k);
  for (Index i = 0; i < k; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > 0 && value >= least) projected += kept.col(i) * kept.col(i).dot(result.g);
    kept.col(i) *= value > 0 && value >= least ? std::sqrt(value) : 0.0;
  }
  result.H = kept * kept.transpose();
  result.g = projected;
  return result;
}

MarginalPrior::MarginalPrior(const WindowState& state, int blocks, Border border, Schur information)
    : border_(std::move(border)),
      biases_(state.biases),
      gravity_map_(state.gravity_map),
      imu_offset_s_(state.imu_offset_s),
      information_(std::move(information)) {
  for (int block = 0; block < blocks; ++block) blocks_.push_back(state.trajectory->value(block));
  constant_ = information_.g.dot(pseudo_solve(information_.H, information_.g).col(0)) / 2;
}

std::vector<int> MarginalPrior::border_columns(const BorderLayout& layout) const {
  if ((border_.gravity && layout.gravity < 0) || (border_.offset && layout.offset < 0))
    throw std::logic_error("what a prior speaks of is no unknown any more");
  std::vector<int> columns = border_.biases;
  if (border_.gravity) columns.insert(columns.end(), {layout.gravity, layout.gravity + 1});
  if (border_.offset) columns.push_back(layout.offset);
  return columns;
}

void MarginalPrior::difference(const WindowState& state, VectorXd& d, MatrixXd& J) const {
  const Index n = information_.g.size();
  d.setZero(n);
  J.setIdentity(n, n);
  Index at = 0;
  VectorXd block_d;
  MatrixXd block_J;
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    state.trajectory->difference(static_cast<int>(block), blocks_[block], block_d, block_J);
    d.segment(at, block_d.size()) = block_d;
    J.block(at, at, block_d.size(), block_d.size()) = block_J;
    at += block_d.size();
  }
  for (const int column : border_.biases) {
    const auto knot = static_cast<std::size_t>(column / 6);
    d[at++] = state.biases[knot].gyro_accel[column % 6] - biases_[knot].gyro_accel[column % 6];
  }
  if (border_.gravity) {
    Eigen::Matrix2d by_gravity;
    d.segment<2>(at) = gravity_direction::difference(gravity_map_, state.gravity_map, by_gravity);
    J.block<2, 2>(at, at) = by_gravity;
    at += 2;
  }
  if (border_.offset) d[at] = state.imu_offset_s - imu_offset_s_;
}

double MarginalPrior::cost(const WindowState& state) const {
  if (empty()) return 0;
  VectorXd d;
  MatrixXd J;
  difference(state, d, J);
  return d.dot(information_.H * d) / 2 + information_.g.dot(d) + constant_;
}

void MarginalPrior::add_to(const WindowState& state, const BorderLayout& layout, BandedSystem& system) const {
  if (empty()) return;
  VectorXd d;
  MatrixXd J;
  difference(state, d, J);
  const MatrixXd H = J.transpose() * information_.H * J;
  const VectorXd g = J.transpose() * (information_.H * d + information_.g);
  system.add(0, blocks() * state.trajectory->block_size(), border_columns(layout), H, g);
}

}  // namespace tarmac::estimators
