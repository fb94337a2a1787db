/// Which points of a sweep CT-ICP uses, and all that sample as it does.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/measurements.h"
#include "core/random.h"
#include "estimators/blocks/voxel_sampler.h"

namespace tarmac::estimators {

/// One random point a cell: the points are shuffled and the first to come of every cell is kept; the kept ones are
/// shuffled again, and the first of every larger cell is a keypoint. Draws are named by seed, purpose and sweep.
class ElasticSampler {
 public:
  explicit ElasticSampler(std::int64_t seed);

  struct Limits {
    double min_range_m = 0, max_range_m = 0, cell_m = 0;
  };
  /// Thins the sweep out to `sample()`, in random order. Keeps points with min < range < max, both strict.
  void thin_out(const core::LidarSweep& sweep, const Limits& limits);
  /// Chooses `keypoints()` out of the sample.
  void choose_keypoints(double cell_m);

  /// Indices into the sweep.
  const std::vector<std::uint32_t>& sample() const { return sample_; }
  const std::vector<std::uint32_t>& keypoints() const { return keypoints_; }

 private:
  core::RandomStream choice_, order_, keypoint_order_;
  VoxelSampler sampler_;
  std::uint32_t sweep_ = 0;
  std::vector<Eigen::Vector3d> points_m_;
  std::vector<std::uint32_t> candidates_, sample_, keypoints_;
};

}  // namespace tarmac::estimators
