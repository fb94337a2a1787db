/// A point map in voxels, each with a bounded number of points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "estimators/blocks/voxel.h"

namespace tarmac::estimators {

/// Voxel -> up to `max_points` points, none nearer than a minimum distance to another of the same voxel.
///
/// A flat table of 16-byte entries leads from a voxel to its block; a block is a fixed run of coordinates, x, y and z
/// apart, so that a search reads whole cache lines and the compiler may vectorise it.
/// Source: the local map of KISS-ICP, Vizzo et al., RA-L 8(2) 2023, section III-C.
class VoxelMap {
 public:
  /// The minimum distance is voxel_size / sqrt(max_points), KISS-ICP's.
  VoxelMap(double voxel_size_m, int max_points);
  VoxelMap(double voxel_size_m, int max_points, double min_distance_m);

  double voxel_size_m() const { return voxel_size_m_; }
  int max_points() const { return max_points_; }
  bool empty() const { return voxel_count_ == 0; }
  std::size_t voxel_count() const { return voxel_count_; }
  /// Adds a point unless its voxel is full or holds one that is too near. Points that are not finite or out of the
  /// grid's reach are left out. `birth` is kept with it, for gather(). @returns whether it was added
  bool add(const Eigen::Vector3d& p, std::int32_t birth = 0);
  /// Drops every voxel whose first point is at `radius_m` or farther from `centre`.
  void remove_far(const Eigen::Vector3d& centre, double radius_m);

  struct Neighbour {
    bool found = false;
    double distance2_m2 = 0;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  /// The nearest point among the 27 voxels around q's, if it is nearer than sqrt(below_m2): exact, but a nearer one
  /// beyond those voxels stays unseen. `hint` may be a point of this map that is likely near: it only saves time.
  Neighbour nearest(const Eigen::Vector3d& q, double below_m2, const Eigen::Vector3d* hint = nullptr) const;

  /// The points of one voxel, coordinates apart; count 0 where there is no such voxel. Valid until the map changes.
  struct Points {
    int count = 0;
    const double *x_m = nullptr, *y_m = nullptr, *z_m = nullptr;
  };
  Points points_in(const Voxel& voxel) const {
    const std::int32_t b = find(voxel);
    if (b == kNone) return {};
    const double* x = block(b);
    return {counts_[static_cast<std::size_t>(b)], x, x + capacity_, x + 2 * capacity_};
  }

  /// Appends to `points` those of the 27 voxels around q's that lie nearer to q than `radius_m` and were born no later
  /// than `latest_birth`, in an order that the map's history alone decides.
  void gather(const Eigen::Vector3d& q, double radius_m, std::int32_t latest_birth,
              std::vector<Eigen::Vector3d>& points) const;

  /// The points of every voxel in order of their insertion; voxels in no particular (but deterministic) order.
  std::vector<std::vector<Eigen::Vector3d>> voxels() const;

 private:
  struct Entry {
    Voxel voxel;
    std::int32_t block = kNone;
  };
  static constexpr std::int32_t kNone = -1;

  std::size_t home(const Voxel& v) const;
  std::int32_t find(const Voxel& v) const;
  std::int32_t insert_voxel(const Voxel& v);
  void erase_entry(std::size_t slot);
  void grow();
  double* block(std::int32_t b) { return coordinates_.data() + static_cast<std::size_t>(b) * stride_; }
  const double* block(std::int32_t b) const { return coordinates_.data() + static_cast<std::size_t>(b) * stride_; }
  Eigen::Vector3d point(std::int32_t b, int k) const;
  bool too_near(std::int32_t b, const Eigen::Vector3d& p) const;
  void search_block(std::int32_t b, const Eigen::Vector3d& q, Neighbour& best) const;

  double voxel_size_m_;
  double min_distance2_m2_;
  int max_points_;
  std::size_t capacity_;  ///< points a block, rounded up to an even number
  std::size_t stride_;    ///< doubles a block
  std::size_t voxel_count_ = 0;
  std::vector<Entry> table_;
  std::vector<double> coordinates_;
  std::vector<std::int32_t> counts_;  ///< points of each block
  std::vector<std::int32_t> births_;  ///< of every point, `capacity_` a block
  std::vector<std::int32_t> free_;    ///< blocks of dropped voxels
};

}  // namespace tarmac::estimators
