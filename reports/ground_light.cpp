#include "reports/ground_light.h"

#include <algorithm>

namespace tarmac::reports {

void GroundLight::blur(int radius_px) {
  for (int pass = 0; pass < 3; ++pass) {
    blur_columns(radius_px);
    transpose();
    blur_columns(radius_px);
    transpose();
  }
}

std::size_t GroundLight::row(int y) const {
  return static_cast<std::size_t>(std::clamp(y, 0, size_px - 1)) * size_px;
}

// Running sums of all columns at once, row by row: the order in which memory lies.
void GroundLight::blur_columns(int radius_px) {
  const std::vector<float> from = value;
  std::vector<float> sum(size_px, 0);
  for (int y = -radius_px; y <= radius_px; ++y) {
    for (int x = 0; x < size_px; ++x) sum[x] += from[row(y) + x];
  }
  const float scale = 1.0f / static_cast<float>(2 * radius_px + 1);
  for (int y = 0; y < size_px; ++y) {
    const std::size_t here = row(y), enters = row(y + radius_px + 1), leaves = row(y - radius_px);
    for (int x = 0; x < size_px; ++x) {
      value[here + x] = scale * sum[x];
      sum[x] += from[enters + x] - from[leaves + x];
    }
  }
}

void GroundLight::transpose() {
  constexpr int kTile = 32;  // a tile of both sides fits the cache
  for (int y0 = 0; y0 < size_px; y0 += kTile) {
    for (int x0 = 0; x0 <= y0; x0 += kTile) {
      for (int y = y0; y < std::min(y0 + kTile, size_px); ++y) {
        for (int x = x0; x < std::min(x0 + kTile, y); ++x) std::swap(value[row(y) + x], value[row(x) + y]);
      }
    }
  }
}

Eigen::Matrix4d project_onto(const Eigen::Vector3d& direction, const Eigen::Vector2d& at, double height_m,
                             const Eigen::Vector2d& gradient) {
  // p' = p - direction (n.p - c) / n.direction, with the plane n.p = c.
  const Eigen::Vector3d n(-gradient.x(), -gradient.y(), 1);
  const double c = height_m - gradient.dot(at);
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  M.topLeftCorner<3, 3>() -= direction * n.transpose() / n.dot(direction);
  M.topRightCorner<3, 1>() = direction * c / n.dot(direction);
  return M;
}

Image reduce(const unsigned char* rgb, int width_px, int height_px, int factor) {
  Image image{width_px / factor, height_px / factor, {}};
  image.rgb.resize(std::size_t(3) * image.width_px * image.height_px);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int k = 0; k < factor * factor; ++k) {
          const std::size_t row = height_px - 1 - (y * factor + k / factor);
          sum += rgb[3 * (row * width_px + x * factor + k % factor) + channel];
        }
        image.rgb[3 * (std::size_t(y) * image.width_px + x) + channel] =
            static_cast<std::uint8_t>((sum + factor * factor / 2) / (factor * factor));
      }
    }
  }
  return image;
}

}  // namespace tarmac::reports
