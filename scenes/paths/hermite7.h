/// The polynomial of degree 7 between two nodes with values and three derivatives: C3 from interval to interval.
#pragma once

#include <array>
#include <cstddef>

#include "scenes/paths/jet.h"

namespace tarmac::scenes {

/// Coefficients of x^k, x in [0, 1] over one interval.
using Hermite7 = std::array<double, 8>;

/// Extended, since the higher coefficients are small differences of the two nodes.
using Extended = long double;
struct ExtendedJet {
  Extended f = 0, d1 = 0, d2 = 0, d3 = 0;
};
inline ExtendedJet extended(const Jet& j) {
  return {j.f, j.d1, j.d2, j.d3};
}

/// From node `a` to node `b`, `h` apart in what their derivatives are by.
inline Hermite7 hermite7(const ExtendedJet& a, const ExtendedJet& b, Extended h) {
  const Extended c0 = a.f, c1 = h * a.d1, c2 = h * h * a.d2 / 2, c3 = h * h * h * a.d3 / 6;
  const Extended e0 = b.f - (c0 + c1 + c2 + c3), e1 = h * b.d1 - (c1 + 2 * c2 + 3 * c3);
  const Extended e2 = h * h * b.d2 - (2 * c2 + 6 * c3), e3 = h * h * h * b.d3 - 6 * c3;
  const Extended c4 = 35 * e0 - 15 * e1 + 2.5L * e2 - e3 / 6, c5 = -84 * e0 + 39 * e1 - 7 * e2 + e3 / 2;
  const Extended c6 = 70 * e0 - 34 * e1 + 6.5L * e2 - e3 / 2, c7 = -20 * e0 + 10 * e1 - 2 * e2 + e3 / 6;
  const auto d = [](Extended x) { return static_cast<double>(x); };
  return {d(c0), d(c1), d(c2), d(c3), d(c4), d(c5), d(c6), d(c7)};
}

/// Exact derivatives of the polynomial at x in [0, 1], for an interval of length h = 1 / r.
inline Jet evaluate(const Hermite7& c, double x, double r) {
  double f = 0, d1 = 0, d2 = 0, d3 = 0;  // d2 and d3 are collected divided by 2 and 6
  for (std::size_t i = c.size(); i-- > 0;) {
    d3 = d3 * x + d2;
    d2 = d2 * x + d1;
    d1 = d1 * x + f;
    f = f * x + c[i];
  }
  return {f, d1 * r, 2 * d2 * r * r, 6 * d3 * r * r * r};
}

}  // namespace tarmac::scenes
