/// Small accelerations, as a prior of models that have none of their own.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "estimators/window/state_jacobian.h"

namespace tarmac::estimators {

/// One sample of the integral of |a_world|^2 / q_t + |alpha_body|^2 / q_r over a stretch of length weight_s:
///   r = sqrt(weight_s) (a / sqrt(q_t), alpha / sqrt(q_r));  a term with q = 0 is left out.
/// q is the power density of the white noise that acceleration is taken for: [m^2/s^3], [rad^2/s^3].
/// Source: Furgale, Barfoot, Sibley, ICRA 2012 (motion as white noise on the second derivative).
struct SmoothnessResidual {
  double q_translation = 0, q_rotation = 0;
  double weight_s = 0;

  core::Vector6 operator()(const core::Kinematics& state) const {
    core::Vector6 r;
    r << scale(q_translation) * state.a_world, scale(q_rotation) * state.alpha_body;
    return r;
  }
  core::Vector6 operator()(const core::Kinematics& state, StateJacobian<6>& J) const {
    J.setZero();
    J.block<3, 3>(0, core::state_row::acceleration).diagonal().setConstant(scale(q_translation));
    J.block<3, 3>(3, core::state_row::alpha).diagonal().setConstant(scale(q_rotation));
    return (*this)(state);
  }

 private:
  double scale(double q) const { return q > 0 ? std::sqrt(weight_s / q) : 0.0; }
};

/// Where in [0, 1] a stretch is sampled, and each sample's share: Gauss-Legendre, so that `samples` = 2 integrates the
/// square of an acceleration exactly that runs linearly between knots (a cubic spline's).
struct QuadratureNode {
  double place = 0, share = 0;
};
inline std::span<const QuadratureNode> quadrature(int samples) {
  static const std::array<QuadratureNode, 1> one = {{{0.5, 1.0}}};
  static const std::array<QuadratureNode, 2> two = {
      {{0.5 - std::sqrt(1.0 / 12), 0.5}, {0.5 + std::sqrt(1.0 / 12), 0.5}}};
  static const std::array<QuadratureNode, 3> three = {
      {{0.5 - std::sqrt(0.15), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + std::sqrt(0.15), 5.0 / 18}}};
  switch (samples) {
    case 1:
      return one;
    case 2:
      return two;
    case 3:
      return three;
    default:
      throw std::invalid_argument("smoothness is sampled once, twice or three times between knots");
  }
}

}  // namespace tarmac::estimators
