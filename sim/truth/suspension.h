/// Heave, pitch and roll of the body: three damped oscillators, driven by whatever the road and the driver do.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// q'' + 2 zeta w q' + w^2 q = F(t) for three modes. At varying speed this has no closed form. The solution is carried
/// from node to node (every millisecond) by the exact response of the oscillator,
///   q(t + h) = Phi(h) (q, q') + integral of g(h - x) F(t + x) dx,   g(x) = exp(-zeta w x) sin(w_d x) / w_d,
/// with Gauss-Legendre quadrature of the integral, in extended precision. Between nodes it is the polynomial of degree
/// 7 that has the solution's value and first three derivatives at both ends; what at() returns are exact derivatives of
/// it.
class Suspension {
 public:
  struct Oscillator {
    double frequency_hz = 1, damping = 0.3;
  };
  /// F of each mode, value and first derivative by time.
  using Forcing = std::function<std::array<Jet, 3>(double t_s)>;

  /// Begins at t = 0 with values `q` and rates `q_dot`; covers [0, end_s].
  Suspension(const std::array<Oscillator, 3>& modes, const Forcing& forcing, double end_s,
             const std::array<double, 3>& q, const std::array<double, 3>& q_dot);

  /// The three modes' values with derivatives by time.
  std::array<Jet, 3> at(double t_s) const;

  static constexpr double node_spacing_s = 1e-3;

 private:
  using Polynomial = std::array<double, 8>;  ///< coefficients of x^k, x in [0, 1] over one interval
  std::vector<std::array<Polynomial, 3>> intervals_;
};

}  // namespace tarmac::sim::truth
