/// Two knots of a Gaussian process on SE(3) and the mean between them.
///
/// A knot is T = T_world_body, its body-centric velocity varpi = (R^T v_world, omega_body), dT/dt = T varpi^, and (not
/// wnoa) the derivative varpi' of that. With xi(t) = Log(T_1^-1 T(t)) a pose is T_1 Exp(xi), perturbed on the right as
/// everywhere here, and varpi = Jr(xi) xi'. The local variables at the knots are therefore
///   gamma_1 = (0, varpi_1, varpi'_1)
///   gamma_2 = (xi, eta, zeta)   eta = Jr^-1(xi) varpi_2   zeta = Jr^-1(xi) varpi'_2 + 1/2 curly(eta) varpi_2
/// where d/dt Jr^-1(xi) = 1/2 curly(xi') + O(xi): the published form, exact only for small xi (stay below about 0.5 rad
/// between knots); the term is -1/4 curly(eta) curly(xi) eta in leading order, where exact would be -1/6. Between the
/// knots gamma is linear in the two (gp_prior.h) and
///   T = T_1 Exp(xi)   varpi = Jr(xi) eta   varpi' = Jr(xi) (zeta - 1/2 curly(eta) varpi),
/// the inverse of the above, so that both knots are hit. Since eta is exactly the derivative of xi, pose and velocity
/// are consistent to rounding; varpi' of wnoj and singer differs from the derivative of varpi by O(|xi|). wnoa has no
/// varpi' of its own; its mean's is given, exactly: varpi' = d/dt (Jr(xi) eta), with zeta = eta'. Source: Barfoot,
/// State Estimation for Robotics, 2nd ed. (2024), 11.1-11.3, with T_vi perturbed on the left; this is its mirror image:
/// xi and varpi change sign, left Jacobians become right ones, curly(.) changes sign.
#pragma once

#include <array>
#include <vector>

#include "core/gp_prior.h"
#include "core/parametric_trajectory.h"
#include "core/trajectory.h"

namespace tarmac::core {

struct GpKnot {
  Time t;
  SE3 T_world_body = SE3::Identity();
  Vector6 varpi = Vector6::Zero();   ///< [m/s, rad/s], body axes
  Vector6 dvarpi = Vector6::Zero();  ///< [m/s^2, rad/s^2]; not of wnoa
};
/// varpi' = (R^T a_world - omega x R^T v_world, alpha_body): a body-centric velocity turns with its axes.
GpKnot gp_knot(Time t, const Kinematics& state);
Kinematics kinematics(const GpKnot& knot);

/// Jacobian of a knot-like state at one time: 6, 12 or 18 rows (pose, varpi, varpi') by the columns of two knots.
using GpJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 18, 36>;

/// The axes of a prior, equal rates taken together.
struct GpAxisGroups {
  std::vector<double> rates;
  std::array<std::size_t, 6> group_of_axis{};
};
GpAxisGroups group_axes(const GpPrior& prior);

/// gamma at one time with its time derivative: what the mean's linear part gives.
struct GpLocal {
  std::array<Vector6, 4> row{};  ///< xi, eta, zeta, zeta'
};

/// The state at T_first Exp(xi) from its local variables, without time; dvarpi also of wnoa. Its Jacobian by them,
/// T_first held: 6 (upto + 1) square.
GpKnot state_of(GpModel model, const SE3& T_first, const GpLocal& local);
GpJacobian state_by_gamma(GpModel model, const GpLocal& local, Derivative upto);

class GpInterval {
 public:
  GpInterval(GpModel model, const GpAxisGroups& groups, const GpKnot& first, const GpKnot& second);

  /// d [s] from the first knot, in [0, T].
  SE3 pose(double d) const;
  GpKnot state(double d) const;
  /// d(state)/dt: (varpi, varpi', varpi''), exact derivatives of pose(), of state().varpi and of state().dvarpi.
  std::array<Vector6, 3> rate(double d) const;

  const std::array<Vector6, 3>& gamma_1() const { return gamma_1_; }
  const std::array<Vector6, 3>& gamma_2() const { return gamma_2_; }
  const SE3& T_first() const { return T_first_; }
  double duration_s() const { return T_; }
  const GpAxis& axis(int k) const { return axes_[groups_.group_of_axis[static_cast<std::size_t>(k)]]; }
  GpModel model() const { return model_; }
  /// Row by row and axis by axis: Lambda and Psi at d.
  struct Weights {
    std::array<std::array<Vector6, 3>, 4> Lambda, Psi;
  };
  Weights weights(double d) const;
  GpLocal local(double d, const Weights& weights_at_d) const;

 private:
  Vector6 xi(double d) const;
  void fit_curve();

  GpModel model_;
  GpAxisGroups groups_;
  double T_;
  SE3 T_first_;
  std::vector<GpAxis> axes_;
  std::array<Vector6, 3> gamma_1_, gamma_2_;
  std::vector<SingerCurve> singer_;  ///< one a group; none for the others
  std::array<Vector6, 6> curve_;     ///< xi: coefficients of a polynomial of d/T, or of Singer's basis
};

/// gamma_2's Jacobian by both knots, and what follows from it.
class GpIntervalJacobian {
 public:
  GpIntervalJacobian(const GpInterval& interval, const GpKnot& second);

  /// d(gamma_2)/d(knots): 12 x 24 or 18 x 36.
  GpJacobian gamma_2() const;
  /// The state at d up to `upto` (its velocity in any case), and its Jacobian by both knots, 6 (upto + 1) rows.
  GpJacobian state(const GpInterval& interval, double d, Derivative upto, GpKnot& state) const;

 private:
  int order_;
  Matrix6 J_inverse_;  ///< Jr^-1(xi)
  std::array<Matrix6, 3> by_T1_, by_T2_;
  Matrix6 zeta_by_varpi2_ = Matrix6::Zero();
};

/// Rows of core::state_row from those of (pose, varpi, varpi') at `s`: v = R nu, a = R (nu' + omega x nu).
void world_rows(const GpKnot& s, const GpJacobian& body, StateJet& jet);

}  // namespace tarmac::core
