/// Gaussian-process priors on motion: what a motion is expected to do between two knots, and how far it may stray.
///
/// A local variable gamma obeys gamma' = A gamma + L w with white noise w, one axis beside the other:
///   wnoa    gamma = (xi, xi')        xi''  = w                      white noise on acceleration
///   wnoj    gamma = (xi, xi', xi'')  xi''' = w                      white noise on jerk
///   singer  gamma = (xi, xi', xi'')  xi''' = -a xi'' + w            an acceleration that forgets itself at the rate a
/// Phi(d) carries its mean over a time d, Q(d) is the covariance that it gathers: Q(d1 + d2) = Phi(d2) Q(d1) Phi(d2)^T
/// + Q(d2). A Singer prior of rate 0 is wnoj; with growing rate and qc/a^2 held it becomes wnoa.
/// Sources: Barfoot, Tong, Sarkka, RSS 2014 (wnoa); Tang, Yoon, Barfoot, RA-L 2019 (wnoj); Wong et al., RA-L 2020
/// (Singer). Singer's Q as one function of a d per entry, its power series, and the unit-free scaling are our own.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/lie.h"

namespace tarmac::core {

enum class GpModel : std::uint8_t { wnoa, wnoj, singer };

/// 2x2 (wnoa) or 3x3, on the stack.
using GpBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// How many vectors of 6 a knot has: pose and velocity, or pose, velocity and its derivative.
constexpr int gp_order(GpModel model) {
  return model == GpModel::wnoa ? 2 : 3;
}

/// One axis at unit power spectral density. `rate` [1/s] is Singer's a and of no meaning to the others; d [s] >= 0.
GpBlock gp_transition(GpModel model, double rate, double d);
GpBlock gp_noise(GpModel model, double rate, double d);
/// Inverse of gp_noise(), d > 0. Factored per axis and free of units, since Q's entries span d to d^5.
GpBlock gp_noise_inverse(GpModel model, double rate, double d);

/// A prior on all six axes (translation first).
struct GpPrior {
  GpModel model = GpModel::wnoa;
  /// Power spectral density of the white noise: (m/s^2)^2/Hz, (rad/s^2)^2/Hz for wnoa; of jerk for the others.
  Vector6 qc = Vector6::Ones();
  Vector6 rate = Vector6::Zero();  ///< [1/s], singer only, >= 0

  int order() const { return gp_order(model); }
  int size() const { return 6 * order(); }
  /// Throws InputError unless qc is positive, rates are not negative, and all are finite.
  void check() const;

  // Over all axes, size() x size(), vectors of 6 one after the other.
  Eigen::MatrixXd transition(double d) const;
  Eigen::MatrixXd noise(double d) const;
  Eigen::MatrixXd information(double d) const;
};

/// Rows: gamma's entries, one derivative each, and one derivative more; columns: gamma at either knot. The mean between
/// two knots a time T apart is Lambda gamma_1 + Psi gamma_2, at any d in [0, T].
struct GpWeights {
  std::array<std::array<double, 3>, 4> Lambda{}, Psi{};
};

/// The mean between two knots of one axis. qc cancels.
class GpAxis {
 public:
  GpAxis(GpModel model, double rate, double T);
  /// Row 0 to `rows` - 1 are filled (wnoa: three of two entries' mean and its derivatives).
  GpWeights weights(double d) const;
  /// Covariance of gamma at d, both knots held, at unit density.
  GpBlock conditional_noise(double d) const;

 private:
  GpModel model_;
  double rate_, T_;
  Eigen::Matrix3d transition_, noise_inverse_;  // of T, Singer only
};

/// Singer's mean of xi between two knots written as what it is: with s = d/T - 1/2 and y = a T,
///   xi = c0 + c1 s + c2 s^2 + c3 s^3 + c4 C(s) + c5 S(s)
///   C = t4(y s)/t4(y/2)   S = t5(y s)/t5(y/2)   t4 = cosh z - 1 - z^2/2   t5 = sinh z - z - z^3/6,
/// C and S made free of overflow and of cancellation, so that y -> 0 gives wnoj's quintic and y -> inf wnoa's cubic
/// with a layer at either knot. For the many poses that a sweep asks for: two exponentials or a short series a query.
class SingerCurve {
 public:
  SingerCurve(double rate, double T);
  using Coefficients = std::array<double, 6>;
  /// c from xi, T xi', T^2 xi'' at both knots.
  Coefficients fit(const Eigen::Vector3d& at_first, const Eigen::Vector3d& at_second) const;
  void basis(double s, double& C, double& S) const;

 private:
  double y_, norm_C_, norm_S_;
  Eigen::Matrix<double, 6, 6> fit_;
};

}  // namespace tarmac::core
