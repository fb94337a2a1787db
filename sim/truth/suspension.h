/// Heave, pitch and roll of the body: three damped oscillators, driven by whatever the road and the driver do.
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// q'' + 2 zeta w q' + w^2 q = F(t) for three modes. At varying speed this has no closed form. The solution is carried
/// from node to node (every millisecond) by the exact response of the oscillator,
///   q(t + h) = Phi(h) (q, q') + integral of g(h - x) F(t + x) dx,   g(x) = exp(-zeta w x) sin(w_d x) / w_d,
/// with Gauss-Legendre quadrature of the integral, in extended precision. Between nodes it is the polynomial of degree
/// 7 that has the solution's value and first three derivatives at both ends; what at() returns are exact derivatives of
/// it.
///
/// The states are kept every 256 nodes (0.75 kB a second of drive). What lies between is there for 66 s (13 MB) at a
/// time, and is made again, to the last bit, when it is asked for and gone.
class Suspension {
 public:
  struct Oscillator {
    double frequency_hz = 1, damping = 0.3;
  };
  /// F of each mode, value and first derivative by time. Kept, and called from several threads.
  using Forcing = std::function<std::array<Jet, 3>(double t_s)>;

  /// Sees the modes at every node while the solution is carried on, in order of time.
  using Visitor = std::function<void(double t_s, const std::array<Jet, 3>& q)>;

  /// Begins at t = 0 with values `q` and rates `q_dot`; covers [0, end_s].
  Suspension(const std::array<Oscillator, 3>& modes, Forcing forcing, double end_s, const std::array<double, 3>& q,
             const std::array<double, 3>& q_dot, const Visitor& visit = {});

  /// The three modes' values with derivatives by time. Safe from several threads.
  std::array<Jet, 3> at(double t_s) const;

  static constexpr double node_spacing_s = 1e-3;

 private:
  class Solution;
  std::shared_ptr<const Solution> solution_;
};

}  // namespace tarmac::sim::truth
