/// Thin paint that follows a Ground: markings on asphalt, where there are no slabs to follow (pavement.h paints slabs).
#pragma once

#include <string>
#include <vector>

#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

class GroundPainter {
 public:
  explicit GroundPainter(const Ground& ground, std::string name = "paint")
      : ground_(&ground), builder_(std::move(name)) {}
  GroundPainter& use(MaterialId paint) {
    builder_.use(paint);
    return *this;
  }
  /// Thickness above the ground [m]; a line that crosses another lies in another layer.
  GroundPainter& layer(int layer) {
    thickness_m_ = 0.0012 + 0.0004 * layer;
    return *this;
  }
  /// Convex, counter-clockwise, at most about a metre wide in one direction; longer ones go through `line`.
  void polygon(const std::vector<Eigen::Vector2d>& convex_counter_clockwise);
  /// A rectangle in the frame whose origin is `at` and whose x axis points along `yaw_rad`.
  void rectangle(const Eigen::Vector2d& at, double yaw_rad, const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  /// A band of `width_m` along a polyline, mitred at its corners.
  void line(const std::vector<Eigen::Vector2d>& points, double width_m);
  /// Marks of `mark_m` with gaps of `gap_m` along a straight.
  void dashes(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m, double mark_m, double gap_m);
  /// Digits and letters of seven bars (0-9, A, C, E, F, L, P, U), `height_m` tall, read by who looks along `yaw_rad`;
  /// `at` is the middle of the text's foot. Throws std::invalid_argument for other characters.
  void text(const std::string& text, const Eigen::Vector2d& at, double yaw_rad, double height_m);
  Mesh build() && { return std::move(builder_).build(); }

 private:
  const Ground* ground_;
  MeshBuilder builder_;
  double thickness_m_ = 0.0012;
};

}  // namespace tarmac::scenes
