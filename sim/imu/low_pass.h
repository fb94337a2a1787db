/// The low-pass filter of an IMU's output: second-order Butterworth, and what white noise becomes behind it.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace tarmac::sim {

/// y'' + sqrt(2) w y' + w^2 y = w^2 x, w = 2 pi cutoff: gain 1 at rest, 1/sqrt(2) at the cutoff. States are (y, y').
/// With a = w / sqrt(2): Phi(h) = exp(-a h) [cos ah + sin ah, sin(ah) / a; -2 a sin ah, cos ah - sin ah].
class LowPass {
 public:
  explicit LowPass(double cutoff_hz);

  /// At frequencies well below the cutoff: sqrt(2) / w.
  double group_delay_s() const { return std::sqrt(2) / w_; }
  /// 1 / w: parts of an integral over the input must be no longer.
  double time_constant_s() const { return 1 / w_; }
  /// Phi(h): how a state develops without input.
  Eigen::Matrix2d transition(double h_s) const;
  /// The state that a unit impulse of x leaves after h: Phi(h) (0, w^2).
  Eigen::Vector2d impulse(double h_s) const { return transition(h_s).col(1) * (w_ * w_); }
  /// Covariance of the state under white noise of density 1 (two-sided, x^2 / Hz): var y = w / (2 sqrt(2)).
  Eigen::Matrix2d stationary() const;
  /// Covariance that white noise of density 1 adds to the state over h: P - Phi P Phi^T.
  Eigen::Matrix2d noise(double h_s) const;

 private:
  double w_;
};

}  // namespace tarmac::sim
