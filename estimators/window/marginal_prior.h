/// What is left of states that have left the window: a Gaussian on those that remain.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimators/window/banded_system.h"
#include "estimators/window/window_state.h"

namespace tarmac::estimators {

/// Eliminates the first `removed` unknowns of H x = -g: S = H_kk - H_kr H_rr^-1 H_rk, s = g_k - H_kr H_rr^-1 g_r.
/// H_rr is inverted on the space where its eigenvalues exceed 1e-12 of the largest, after scaling to unit diagonal
/// (units differ). With threshold > 0, eigenvalues of S below threshold x the largest are set to zero (and s
/// projected). Source: Sibley, Matthies, Sukhatme, JFR 27(5) 2010.
struct Schur {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};
Schur marginalise(const Eigen::Ref<const Eigen::MatrixXd>& H, const Eigen::Ref<const Eigen::VectorXd>& g, int removed,
                  double threshold);

/// A quadratic cost around the values that some unknowns had when it was made:
///   c(d) = d^T H d / 2 + g^T d + const,   d = difference of the present values from those
/// d and its exact Jacobian are taken in the unknowns' own tangents; H and g stay as they were (they are not linearised
/// anew). The constant makes the least cost zero.
class MarginalPrior {
 public:
  MarginalPrior() = default;
  /// Which unknowns of the border it speaks of: columns of bias knots (6 knot + axis), gravity's two, the offset.
  struct Border {
    std::vector<int> biases;
    bool gravity = false, offset = false;
  };
  /// On the first `blocks` blocks of the state's trajectory and then those of the border, with the state's present
  /// values as the base.
  MarginalPrior(const WindowState& state, int blocks, Border border, Schur information);

  bool empty() const { return information_.g.size() == 0; }
  int blocks() const { return static_cast<int>(blocks_.size()); }
  const Schur& information() const { return information_; }
  double cost(const WindowState& state) const;
  void add_to(const WindowState& state, const BorderLayout& layout, BandedSystem& system) const;
  /// d, and dd/d(step), steps in the order of the prior's unknowns.
  void difference(const WindowState& state, Eigen::VectorXd& d, Eigen::MatrixXd& J) const;
  /// Where the prior's columns of the border stand in a layout. Throws std::logic_error where one is no unknown there.
  std::vector<int> border_columns(const BorderLayout& layout) const;

 private:
  std::vector<Eigen::VectorXd> blocks_;  ///< values of the trajectory's first blocks
  Border border_;
  std::vector<BiasKnot> biases_;
  Eigen::Vector3d gravity_map_ = -Eigen::Vector3d::UnitZ();
  double imu_offset_s_ = 0;
  Schur information_;
  double constant_ = 0;
};

}  // namespace tarmac::estimators
