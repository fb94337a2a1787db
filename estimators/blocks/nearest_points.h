/// The k nearest points of a voxel map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "estimators/blocks/voxel_map.h"

namespace tarmac::estimators {

/// Up to `capacity` points in order of their distance from the query, coordinates apart and relative to the query, so
/// that moments of them keep their digits far from the map's origin.
struct NearestPoints {
  static constexpr int kCapacity = 64;
  int count = 0;
  std::array<double, kCapacity> distance2_m2, x_m, y_m, z_m;  ///< the first `count` of each hold values

  Eigen::Vector3d offset(int k) const {
    const auto i = static_cast<std::size_t>(k);
    return {x_m[i], y_m[i], z_m[i]};
  }
};

/// Which cells are visited and which of their points may be taken.
struct NearestSearch {
  int max_points = 20;  ///< at most NearestPoints::kCapacity
  int reach = 1;        ///< voxels each way: 1 visits 3 x 3 x 3
  double radius_m = std::numeric_limits<double>::infinity();
};

/// Finds the nearest points among the visited cells: exact there, but a nearer one beyond those cells stays unseen, as
/// in the published programs. Cells are visited from the nearest on, and those that cannot hold a nearer point than the
/// last one kept are left out. Equal distances: whoever is met first.
class NearestPointsFinder {
 public:
  /// Throws std::invalid_argument when max_points is above the capacity or reach below 1.
  NearestPointsFinder(const VoxelMap& map, const NearestSearch& search);
  /// `expected_m` may be an upper bound of the distance of the last point to be found, such as follows from a search
  /// nearby: it only saves time. Where fewer than max_points are within it, the search is done again without.
  /// May be called from several threads.
  void find(const Eigen::Vector3d& query, NearestPoints& found,
            double expected_m = std::numeric_limits<double>::infinity()) const;

 private:
  struct Candidate {
    double distance2_m2;
    const double *x_m, *y_m, *z_m;
  };
  int search(const Eigen::Vector3d& query, double radius2_m2, Candidate* kept) const;

  struct Cell {
    std::int8_t x, y, z;  ///< steps: 0 the same, -k and +k across the k nearer and farther faces
  };
  const VoxelMap& map_;
  NearestSearch settings_;
  std::vector<Cell> cells_;
};

}  // namespace tarmac::estimators
