/// The stand's ground: a smooth base that wheels follow, slabs laid on it, and the relief that is applied after
/// tracing.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "scenes/stand/options.h"

namespace tarmac::scenes {

/// Bounds of the base's derivatives over the whole plane.
struct GroundBounds {
  double slope = 0;            ///< |gradient|
  double curvature_per_m = 0;  ///< norm of the Hessian
  double third_per_m2 = 0;     ///< norm of the third derivatives
};

/// h(x, y) = c (y - y0) + sum_k A_k sin(kx_k x + ky_k y + phi_k): C-infinity, wavelengths 9 to 90 m.
class StandGround final : public Ground {
 public:
  StandGround(const StandOptions& options, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                  Eigen::Vector3d* hessian = nullptr) const override;
  GroundBounds bounds() const;

 private:
  struct Wave {
    double amplitude_m, kx_per_m, ky_per_m, phase_rad;
  };
  double crossfall_;
  std::array<Wave, 6> waves_;
};

/// Square slabs with joints between them; slab (i, j) spans origin + size * [i, i + 1] x [j, j + 1], less half a joint.
struct SlabGrid {
  explicit SlabGrid(const StandOptions& options);
  Eigen::Vector2d origin_m;
  double size_m;
  double joint_width_m = 0.015;
  int nx, ny;
};

/// Top of the slabs: the base plus each slab's own offset and tilt. Continuous on a slab, stepped from one to the next.
class SlabSurface {
 public:
  SlabSurface(const StandOptions& options, std::uint64_t seed, const Ground& ground);
  const SlabGrid& grid() const { return grid_; }
  /// Height of slab (i, j), continued beyond its edges [m].
  double height_m(int i, int j, double x_m, double y_m) const;

 private:
  struct Tilt {
    double offset_m, slope_x, slope_y;
  };
  const Ground* ground_;
  SlabGrid grid_;
  std::vector<Tilt> tilts_;
};

/// Texture: one lattice of nodes 5 cm apart whose heights are the sum of grains of 0.05, 0.2 and 0.8 m, interpolated by
/// quintics (C2, closed form a cell); it repeats every 12.8 m. Joints: grooves of profile exp(-(d/w)^4), w = half the
/// joint's width, whose depth wanders along the joint.
class StandRelief final : public Relief {
 public:
  StandRelief(const StandOptions& options, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr) const override;
  void heights_m(std::size_t count, const double* x_m, const double* y_m, float* heights, float* slope_x,
                 float* slope_y) const override;

 private:
  static constexpr int lattice_bits = 8, lattice_size = 1 << lattice_bits;
  double texture_m(double x_m, double y_m, Eigen::Vector2d& gradient) const;
  double groove_m(double across_m, double along_m, double& d_across, double& d_along) const;

  SlabGrid grid_;
  double slabs_per_m_, joint_depth_m_;
  double cos_per_m_, sin_per_m_;  ///< lattice coordinates = turned and scaled x, y
  std::vector<float> lattice_m_;  ///< heights at the nodes, row by row; the texture repeats after lattice_size of them
};

}  // namespace tarmac::scenes
