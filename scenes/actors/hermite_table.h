/// A function of the distance that is known by its values and first three derivatives at equidistant nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "scenes/paths/jet.h"

namespace tarmac::scenes {

/// Between nodes the polynomial of degree 7 that agrees with both of them: C3, and what at() returns are its exact
/// derivatives. Before the first node and after the last one their Taylor polynomials.
class HermiteTable {
 public:
  explicit HermiteTable(double spacing) : spacing_(spacing) {}
  void append(const Jet& node) { nodes_.push_back(node); }
  std::size_t size() const { return nodes_.size(); }
  const Jet& back() const { return nodes_.back(); }

  Jet at(double x) const {
    const auto last = static_cast<double>(nodes_.size() - 1);
    const double place = x / spacing_;
    if (place <= 0 || nodes_.size() == 1) return taylor(nodes_.front(), x);
    if (place >= last) return taylor(nodes_.back(), x - last * spacing_);
    const auto k = static_cast<std::size_t>(place);
    return between(nodes_[k], nodes_[k + 1], place - static_cast<double>(k));
  }

 private:
  static Jet taylor(const Jet& n, double d) {
    return {n.f + d * (n.d1 + d * (n.d2 / 2 + d * n.d3 / 6)), n.d1 + d * (n.d2 + d * n.d3 / 2), n.d2 + d * n.d3, n.d3};
  }
  Jet between(const Jet& a, const Jet& b, double u) const {
    const double h = spacing_, h2 = h * h, h3 = h2 * h;
    const double c1 = h * a.d1, c2 = h2 * a.d2 / 2, c3 = h3 * a.d3 / 6;
    const double e0 = (b.f - a.f) - (c1 + c2 + c3), e1 = h * b.d1 - (c1 + 2 * c2 + 3 * c3);
    const double e2 = h2 * b.d2 - (2 * c2 + 6 * c3), e3 = h3 * b.d3 - 6 * c3;
    const double c[8] = {a.f,
                         c1,
                         c2,
                         c3,
                         35 * e0 - 15 * e1 + 2.5 * e2 - e3 / 6,
                         -84 * e0 + 39 * e1 - 7 * e2 + e3 / 2,
                         70 * e0 - 34 * e1 + 6.5 * e2 - e3 / 2,
                         -20 * e0 + 10 * e1 - 2 * e2 + e3 / 6};
    double f = 0, d1 = 0, d2 = 0, d3 = 0;  // d2 and d3 are collected divided by 2 and 6
    for (int i = 7; i >= 0; --i) {
      d3 = d3 * u + d2;
      d2 = d2 * u + d1;
      d1 = d1 * u + f;
      f = f * u + c[i];
    }
    return {f, d1 / h, 2 * d2 / h2, 6 * d3 / h3};
  }

  double spacing_;
  std::vector<Jet> nodes_;
};

}  // namespace tarmac::scenes
