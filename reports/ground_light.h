/// Arithmetic of shadows and pixels. No VTK here.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reports/stills.h"

namespace tarmac::reports {

/// A square picture of how dark the ground is, 0 to 1; first row at the bottom (south), as in a texture.
class GroundLight {
 public:
  explicit GroundLight(int size) : size_px(size), value(static_cast<std::size_t>(size) * size) {}
  int size_px;
  std::vector<float> value;

  /// Three box filters in both directions: near enough to a Gaussian.
  void blur(int radius_px);

 private:
  std::size_t row(int y) const;
  void blur_columns(int radius_px);
  void transpose();
};

/// Moves every point along `direction` onto the plane z = height + gradient . (xy - at).
Eigen::Matrix4d project_onto(const Eigen::Vector3d& direction, const Eigen::Vector2d& at, double height_m,
                             const Eigen::Vector2d& gradient);

/// Averages squares of `factor` pixels and puts the first row on top (OpenGL's is at the bottom).
Image reduce(const unsigned char* rgb, int width_px, int height_px, int factor);

}  // namespace tarmac::reports
