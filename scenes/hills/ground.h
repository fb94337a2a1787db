/// Hilly ground, the track through it, and its mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/hills/options.h"
#include "scenes/primitives/mesh_builder.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// h(x, y) = sum_k A_k sin(kx_k x + ky_k y + phi_k) - h_0: 48 waves, their lengths spaced evenly on a logarithmic
/// scale, their directions drawn; h_0 makes the height at the origin 0. C-infinity. No direction is flat or level.
class HillyGround final : public Ground {
 public:
  HillyGround(const HillsOptions& options, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                  Eigen::Vector3d* hessian = nullptr) const override;

 private:
  struct Wave {
    double amplitude_m, kx_per_m, ky_per_m, phase_rad;
  };
  std::vector<Wave> waves_;
  double zero_m_ = 0;
};

/// The track that nothing stands on: a loop around the origin, as points at most 1 m apart.
std::vector<Eigen::Vector2d> hills_track();
/// From p to the nearest of the track's points.
double distance_m(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& track);
/// Cells of 0.5 m within 64 m of the origin, where the track runs, and of 2 m beyond; the two meet vertex on vertex.
Mesh make_hills_mesh(const Ground& ground, double half_size_m);

}  // namespace tarmac::scenes
