/// Normal equations of a chain of states with a border, and their solution in time linear in the chain's length.
#pragma once

#include <Eigen/Core>
#include <span>

namespace tarmac::estimators {

/// H x = -g over `band` scalars, of which two further apart than the half bandwidth never meet, and `border` scalars that
/// meet all of them:
///   H = [ B  E ; E^T C ]
/// Solved by a blocked Cholesky of the band and the Schur complement of the border.
/// Source: Golub and Van Loan, Matrix Computations (2013), 4.3.
class BandedSystem {
 public:
  BandedSystem(int band, int half_bandwidth, int border);

  int band() const { return band_; }
  int border() const { return border_; }
  void set_zero();

  struct BorderJacobian {
    int column = 0;  ///< within the border
    Eigen::MatrixXd J;
  };
  /// Adds y^T H_local y / 2 + g_local^T y, where y = J x[first...] + sum J_k border[column_k...].
  void add(int first, const Eigen::Ref<const Eigen::MatrixXd>& J, std::span<const BorderJacobian> border,
           const Eigen::Ref<const Eigen::MatrixXd>& H_local, const Eigen::Ref<const Eigen::VectorXd>& g_local);
  void add(const BandedSystem& other);

  /// step = -(H + lambda diag H)^-1 g, band then border. False where that is not positive definite to working precision.
  bool solve(double lambda, Eigen::VectorXd& step) const;
  /// Columns of H^-1 for the scalars first..first+count of the band (or, from band() on, of the border), their rows only:
  /// the joint covariance of those. Empty where H is singular.
  Eigen::MatrixXd covariance(int first, int count) const;
  /// Their covariance with the border too: (count + border) square.
  Eigen::MatrixXd covariance_with_border(int first, int count) const;
  /// The entries of H^-1 inside the band, whole runs of `block` neighbours at a time, in time linear in band(): element i
  /// is the joint covariance of scalars [i * block, i * block + run). (Takahashi's recursion.)
  std::vector<Eigen::MatrixXd> covariance_runs(int block, int run) const;

  Eigen::MatrixXd dense() const;  ///< H, for tests and small windows
  const Eigen::VectorXd& g() const { return g_; }

 private:
  int band_, border_, half_;
  Eigen::VectorXd g_;
};

}  // namespace tarmac::estimators
