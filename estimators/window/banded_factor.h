/// The Cholesky factor of a banded system with border.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimators/window/banded_system.h"

namespace tarmac::estimators {

/// With D = diag(H)^-1/2 and D H D = [ B E ; E^T C ]: B = L L^T by panels, W = L^-1 E, C - W^T W = M M^T.
class BandedFactor {
 public:
  /// H + lambda diag(H), or H + lambda I.
  BandedFactor(const BandedSystem& system, double lambda, bool identity);

  /// False where the matrix is not positive definite to working precision: nothing else may be asked then.
  bool ok() const { return ok_; }
  /// Multiply-adds that it took, counted by the sizes of the products.
  double operations() const { return operations_; }
  /// H^-1 x in place; x has band + border rows.
  void solve(Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Entries of H^-1 within the band, as BandedSystem::covariance_runs.
  std::vector<Eigen::MatrixXd> runs(int block, int run) const;

 private:
  static constexpr int kPanel = BandedSystem::kPanel;
  using Panel = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kPanel>>;
  using ConstPanel = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kPanel>>;
  Panel panel(int k) { return {L_.data() + panel_offset(k), rows_, kPanel}; }
  ConstPanel panel(int k) const { return {L_.data() + panel_offset(k), rows_, kPanel}; }
  std::size_t panel_offset(int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(kPanel);
  }
  /// Rows of panel k that lie within the padded band.
  int rows_of(int k) const { return std::min(rows_, kPanel * (panels_ - k)); }
  void scale(const BandedSystem& system, double lambda, bool identity);
  bool factor_band();
  bool factor_border(const BandedSystem& system, double lambda, bool identity);
  void forward(Eigen::Ref<Eigen::MatrixXd> x) const;   ///< x <- L^-1 x, of padded rows
  void backward(Eigen::Ref<Eigen::MatrixXd> x) const;  ///< x <- L^-T x

  int band_, half_, border_, panels_, rows_;
  bool ok_ = false;
  double operations_ = 0;
  Eigen::VectorXd scale_;  ///< D, band then border
  std::vector<double> L_;  ///< panels
  Eigen::MatrixXd W_;      ///< padded band x border
  Eigen::MatrixXd M_;      ///< lower
};

}  // namespace tarmac::estimators
