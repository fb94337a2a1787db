#include "core/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace tarmac::core {

SymmetricEigen::SymmetricEigen(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  values_ = solver.eigenvalues();
  vectors_ = solver.eigenvectors();
}

}  // namespace tarmac::core
