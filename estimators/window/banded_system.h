/// Normal equations of a chain of states with a border, and their solution in time linear in the chain's length.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tarmac::estimators {

class BandedFactor;

/// H x = -g over `band` scalars, of which two further apart than the half bandwidth never meet, and `border` scalars
/// that meet all of them:
///   H = [ B  E ; E^T C ]
/// Solved by a blocked Cholesky of the band and the Schur complement of the border, after scaling to unit diagonal
/// (units differ). Time and memory are linear in `band`.
/// Source: Golub and Van Loan, Matrix Computations (2013), 4.3.
class BandedSystem {
 public:
  BandedSystem(int band, int half_bandwidth, int border);

  int band() const { return band_; }
  int half_bandwidth() const { return half_; }
  int border() const { return border_; }
  int size() const { return band_ + border_; }
  void set_zero();

  struct BorderJacobian {
    int column = 0;  ///< within the border
    Eigen::MatrixXd J;
  };
  /// Adds y^T H_local y / 2 + g_local^T y, where y = J x[first...] + sum J_k border[column_k...].
  /// Throws std::invalid_argument where J has more columns than half bandwidth + 1, or reaches beyond either end.
  void add(int first, const Eigen::Ref<const Eigen::MatrixXd>& J, std::span<const BorderJacobian> border,
           const Eigen::Ref<const Eigen::MatrixXd>& H_local, const Eigen::Ref<const Eigen::VectorXd>& g_local);
  /// Adds y^T H y / 2 + g^T y, where y stacks the `count` scalars of the band from `first` on and those of the border
  /// that `columns` lists. Only the lower triangle of H is read. Throws as above.
  void add(int first, int count, std::span<const int> columns, const Eigen::Ref<const Eigen::MatrixXd>& H,
           const Eigen::Ref<const Eigen::VectorXd>& g);
  void add(const BandedSystem& other);
  void add_to_diagonal(int scalar, double value);

  double diagonal(int scalar) const;
  /// x^T H x.
  double quadratic(const Eigen::Ref<const Eigen::VectorXd>& x) const;

  /// step = -(H + lambda diag H)^-1 g, band then border. False where that is not positive definite to working
  /// precision; step is then unchanged.
  bool solve(double lambda, Eigen::VectorXd& step) const;
  /// The same with lambda I instead of lambda diag H.
  bool solve_with_identity(double lambda, Eigen::VectorXd& step) const;
  /// Columns of H^-1 for the scalars first..first+count of the band (or, from band() on, of the border), their rows
  /// only: the joint covariance of those. Empty where H is singular.
  Eigen::MatrixXd covariance(int first, int count) const;
  /// Their covariance with the border too: (count + border) square. Of scalars of the band only.
  Eigen::MatrixXd covariance_with_border(int first, int count) const;
  /// The entries of H^-1 inside the band, whole runs of `block` neighbours at a time, in time linear in band(): element
  /// i is the joint covariance of scalars [i * block, i * block + run). Empty where H is singular; throws
  /// std::invalid_argument for a run longer than half bandwidth + 1. (Takahashi's recursion.)
  std::vector<Eigen::MatrixXd> covariance_runs(int block, int run) const;

  Eigen::MatrixXd dense() const;  ///< H, for tests and small windows
  const Eigen::VectorXd& g() const { return g_; }
  /// Doubles kept, and multiply-adds that one factorisation took, counted as it went: both linear in band().
  std::size_t stored() const;
  double factor_operations() const;

 private:
  friend class BandedFactor;
  /// Columns of the band come in panels of kPanel; a panel keeps the rows from its first column down to the band's end
  /// of its last one, one dense column-major matrix, so that Cholesky is a few matrix products a panel.
  static constexpr int kPanel = 12;
  int panels() const { return (band_ + kPanel - 1) / kPanel; }
  int panel_rows() const { return kPanel + half_; }
  double* column(int j);
  const double* column(int j) const;  ///< rows j, j + 1, ... of column j
  bool solve(double lambda, bool identity, Eigen::VectorXd& step) const;

  int band_, half_, border_;
  std::vector<double> panels_;  ///< lower triangle of B
  Eigen::MatrixXd E_;           ///< band x border
  Eigen::MatrixXd C_;           ///< lower triangle
  Eigen::VectorXd g_;
};

}  // namespace tarmac::estimators
