/// Slabs, joints, paint on them, and the grass around.
#pragma once

#include "scenes/paving/paving.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {

/// Slabs in cells of at most PavingSpec::cell_m, and sealed joints between.
Mesh make_pavement(const SlabSurface& slabs);
/// Grass beyond the apron's edges, 5 cm lower.
Mesh make_grass(const Ground& ground, const SlabGrid& grid);

/// Thin paint that follows the slabs and leaves the joints free.
class Painter {
 public:
  explicit Painter(const SlabSurface& slabs) : slabs_(&slabs), builder_("paint") {}
  Painter& use(MaterialId paint) {
    builder_.use(paint);
    return *this;
  }
  /// Thickness above the slab [m]; a line that crosses another lies in another layer.
  Painter& layer(int layer) {
    thickness_m_ = 0.0012 + 0.0004 * layer;
    return *this;
  }
  void rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high);
  /// A band of `width_m` along a polyline, mitred at its corners.
  void line(const std::vector<Eigen::Vector2d>& points, double width_m);
  /// Marks of `mark_m` with gaps of `gap_m` along a straight.
  void dashes(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m, double mark_m, double gap_m);
  void polygon(const std::vector<Eigen::Vector2d>& convex_counter_clockwise);
  Mesh build() && { return std::move(builder_).build(); }

 private:
  const SlabSurface* slabs_;
  MeshBuilder builder_;
  double thickness_m_ = 0.0012;
};

}  // namespace tarmac::scenes
