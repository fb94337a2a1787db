/// A gentle hill, so that slopes, their turning under the vehicle, and curvature all take part.
#pragma once

#include <cmath>

#include "scenes/scene.h"

namespace tarmac::tests {

class Hill final : public scenes::Ground {
 public:
  double height_m(double x, double y, Eigen::Vector2d* g, Eigen::Vector3d* H) const override {
    const double sx = std::sin(x / 30), cx = std::cos(x / 30), sy = std::sin(y / 20), cy = std::cos(y / 20);
    if (g) *g << 0.4 * cx * cy / 30, -0.4 * sx * sy / 20;
    if (H) *H << -0.4 * sx * cy / 900, -0.4 * cx * sy / 600, -0.4 * sx * cy / 400;
    return 0.4 * sx * cy;
  }
};

}  // namespace tarmac::tests
