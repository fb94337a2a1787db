#include "sim/imu/low_pass.h"

#include <cmath>
#include <numbers>

namespace tarmac::sim {

LowPass::LowPass(double cutoff_hz) : w_(2 * std::numbers::pi * cutoff_hz) {}

Eigen::Matrix2d LowPass::transition(double h_s) const {
  const double a = w_ / std::numbers::sqrt2, decay = std::exp(-a * h_s), c = std::cos(a * h_s), s = std::sin(a * h_s);
  Eigen::Matrix2d Phi;
  Phi << c + s, s / a, -2 * a * s, c - s;
  return decay * Phi;
}

Eigen::Matrix2d LowPass::stationary() const {
  Eigen::Matrix2d P = Eigen::Matrix2d::Zero();
  P(0, 0) = w_ / (2 * std::numbers::sqrt2);
  P(1, 1) = w_ * w_ * P(0, 0);
  return P;
}

Eigen::Matrix2d LowPass::noise(double h_s) const {
  const Eigen::Matrix2d Phi = transition(h_s), P = stationary();
  return P - Phi * P * Phi.transpose();
}

}  // namespace tarmac::sim
