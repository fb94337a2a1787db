/// A function of the distance that is known by its values and first three derivatives at equidistant nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "scenes/paths/hermite7.h"

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
    const Hermite7 c = hermite7(extended(nodes_[k]), extended(nodes_[k + 1]), spacing_);
    return evaluate(c, place - static_cast<double>(k), 1 / spacing_);
  }

 private:
  static Jet taylor(const Jet& n, double d) {
    return {n.f + d * (n.d1 + d * (n.d2 / 2 + d * n.d3 / 6)), n.d1 + d * (n.d2 + d * n.d3 / 2), n.d2 + d * n.d3, n.d3};
  }
  double spacing_;
  std::vector<Jet> nodes_;
};

}  // namespace tarmac::scenes
