/// Gauss-Legendre quadrature with three nodes: exact for polynomials up to degree 5.
#pragma once

#include <array>

namespace tarmac::scenes {

struct Gauss3 {
  static constexpr std::array<double, 3> node{0.11270166537925831148, 0.5, 0.88729833462074168852};  ///< in [0, 1]
  static constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

  /// Integral of f: double -> double from a to b.
  template <class F>
  static double integrate(const F& f, double a, double b) {
    const double h = b - a;
    return (f(a + node[0] * h) * weight[0] + f(a + node[1] * h) * weight[1] + f(a + node[2] * h) * weight[2]) * h;
  }
};

}  // namespace tarmac::scenes
