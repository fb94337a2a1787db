/// Paved ground: a smooth base that wheels follow, slabs laid on it, and the relief that is applied after tracing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace tarmac::scenes {

/// A rectangle of slabs. Slabs begin at `low_m` and cover at least up to `high_m`.
struct PavingSpec {
  Eigen::Vector2d low_m{-150, -105}, high_m{150, 52.5};
  double slab_size_m = 7.5;
  double crossfall_percent = 0.8;        ///< towards -y
  double crossfall_zero_y_m = 0;         ///< where the fall alone has height 0
  double undulation_mm = 24;             ///< amplitude of the longest wave of the base
  double slab_tilt_mm = 2;               ///< standard deviation of a slab's corner about the base
  double relief_rms_mm = 2;              ///< texture
  double joint_depth_mm = 3;             ///< mean depth of the grooves
  double cell_m = 0.625;                 ///< of the mesh, at most; 0.6 m follows the base to a tenth of a millimetre
  std::string stream = "scenes/paving";  ///< names of random draws begin with it
};

/// Bounds of the base's derivatives over the whole plane.
struct GroundBounds {
  double slope = 0;            ///< |gradient|
  double curvature_per_m = 0;  ///< norm of the Hessian
  double third_per_m2 = 0;     ///< norm of the third derivatives
};

/// h(x, y) = c (y - y0) + sum_k A_k sin(kx_k x + ky_k y + phi_k): C-infinity, wavelengths 9 to 90 m.
class WavyGround final : public Ground {
 public:
  WavyGround(const PavingSpec& spec, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                  Eigen::Vector3d* hessian = nullptr) const override;
  GroundBounds bounds() const;

 private:
  struct Wave {
    double amplitude_m, kx_per_m, ky_per_m, phase_rad;
  };
  double crossfall_, crossfall_zero_y_m_;
  std::array<Wave, 6> waves_;
};

/// Square slabs with joints between them; slab (i, j) spans origin + size * [i, i + 1] x [j, j + 1], less half a joint.
struct SlabGrid {
  explicit SlabGrid(const PavingSpec& spec);
  Eigen::Vector2d origin_m;
  double size_m;
  double joint_width_m = 0.015;
  double cell_m;  ///< of the mesh
  int nx, ny;
};

/// Top of the slabs: the base plus each slab's own offset and tilt. Continuous on a slab, stepped from one to the next.
class SlabSurface {
 public:
  SlabSurface(const PavingSpec& spec, std::uint64_t seed, const Ground& ground);
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
class SlabRelief final : public Relief {
 public:
  SlabRelief(const PavingSpec& spec, std::uint64_t seed);
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
