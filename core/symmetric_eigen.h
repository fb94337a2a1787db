/// Eigenvalues and eigenvectors of symmetric matrices whose size is known only at run time.
#pragma once

#include <Eigen/Core>

namespace tarmac::core {

/// As Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>, to the bit; only the lower triangle is read. Compiled once,
/// because that takes six seconds. Sizes known to the compiler are better served by Eigen's own.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Eigen::MatrixXd& symmetric);
  const Eigen::VectorXd& eigenvalues() const { return values_; }    ///< ascending
  const Eigen::MatrixXd& eigenvectors() const { return vectors_; }  ///< in columns, of length 1

 private:
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_;
};

}  // namespace tarmac::core
