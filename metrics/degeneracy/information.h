/// How much a sweep's residuals say of the pose, and of the two poses at its begin and end.
///
/// One perturbation for all, whatever a method's own parameters are: the sweep as a whole is moved from the left, in
/// the frame c (axes of the body at mid-sweep, origin in the LiDAR then): T(t) <- T_c Exp(xi) T_c^-1 T(t), xi = (rho,
/// phi).
///   6-DOF    xi is the same over the sweep
///   12-DOF   xi(t) = (1 - a) xi_begin + a xi_end, a = phase in the sweep: J12 = [(1 - a) J, a J]
/// Since xi acts in a fixed frame, what a surface leaves free at every instant is free in the 12-DOF block too, with
/// motion in the sweep as without.
///
/// Scaling: phi is counted in metres at the sweep's mean range r (columns of rotation divided by r), and the sum over
/// residuals is divided by sum w |dr/drho|^2, the trace of the translation block: N for point-to-plane rows of
/// weight 1. Eigenvalues are therefore per residual, between 0 and about 1, and depend neither on the number of points,
/// nor on the weights' unit, nor on metres or millimetres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "core/lie.h"

namespace tarmac::metrics {

using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Sums over the residuals of a sweep: sum w a^k J'J for k = 0, 1, 2, which hold every block of xi(t) linear in a.
class SweepInformation {
 public:
  /// J by xi in frame c; `weight` as in the method's cost. Rows that are not finite or have no weight are left out.
  void add(const core::Row6& J, double weight, double phase);
  /// A 6-DOF block alone, when single residuals were not kept: the 12-DOF block is then unknown.
  void add_block(const core::Matrix6& H, std::size_t rows);

  std::size_t rows() const { return rows_; }
  bool has_phases() const { return has_phases_; }
  /// Sum w |dr/drho|^2.
  double translation_trace() const { return moments_[0].topLeftCorner<3, 3>().trace(); }
  const core::Matrix6& moment(int k) const { return moments_[static_cast<std::size_t>(k)]; }

 private:
  std::array<core::Matrix6, 3> moments_{core::Matrix6::Zero(), core::Matrix6::Zero(), core::Matrix6::Zero()};
  std::size_t rows_ = 0;
  bool has_phases_ = true;
};

/// Eigenvalues in ascending order (negative rounding noise as 0) with their unit vectors as columns.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  double min() const { return values[0]; }
  /// Largest over smallest; at most 1e16, which is what an exact null space gives.
  double condition() const;
};
Spectrum spectrum_of(const Eigen::MatrixXd& symmetric);

/// With m = (xi_begin + xi_end) / 2 and d = xi_end - xi_begin: the mean's Schur complement asks whether the pose is
/// observable when the motion inside the sweep is free, the difference's whether that motion is when the pose is free.
struct BlockAnalysis {
  Spectrum pose;  ///< 6-DOF
  // Without phases the following three are empty.
  std::optional<Spectrum> two_pose;    ///< 12-DOF, begin before end
  std::optional<Spectrum> mean;        ///< 6, Schur complement
  std::optional<Spectrum> difference;  ///< 6, Schur complement
};

/// Empty when there is nothing to analyse: fewer than `min_rows` rows, no translational information, r not above 0.
std::optional<BlockAnalysis> analyse(const SweepInformation& information, double mean_range_m,
                                     std::size_t min_rows = 100);

/// The scaled blocks themselves.
core::Matrix6 scaled_pose_block(const SweepInformation& information, double mean_range_m);
Matrix12 scaled_two_pose_block(const SweepInformation& information, double mean_range_m);

}  // namespace tarmac::metrics
