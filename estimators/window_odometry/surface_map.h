/// The map that sweeps are registered against, and what a placed point is drawn to in it.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "estimators/blocks/distribution_map.h"
#include "estimators/blocks/plane_association.h"
#include "estimators/blocks/voxel_map.h"
#include "estimators/window/lidar_factors.h"
#include "estimators/window_odometry/settings.h"

namespace tarmac::estimators {

/// One keypoint's search: what was found last time saves time this time.
struct SurfaceMatch {
  bool used = false;
  Association association;  ///< of planes
  LidarFactor factor;
};

/// Points with planes fitted to neighbours, or one normal distribution a voxel.
class SurfaceMap {
 public:
  SurfaceMap(const MapSettings& map, const LidarSettings& lidar);

  void add(std::span<const Eigen::Vector3d> points_map);
  void remove_far(const Eigen::Vector3d& centre_map);

  /// Matches every keypoint (p_body, placed at p_map, its sensor at sensor_map). Parallel, each for itself; `matches`
  /// holds those of another placement of the same keypoints in the same map, or default values. @returns how many are
  /// used
  int match(std::span<const Eigen::Vector3d> p_body, std::span<const Eigen::Vector3d> p_map,
            std::span<const Eigen::Vector3d> sensor_map, bool startup, std::vector<SurfaceMatch>& matches) const;

 private:
  void match_distribution(const DistributionMap& map, const Eigen::Vector3d& p_map, const Eigen::Vector3d& sensor_map,
                          SurfaceMatch& match) const;

  MapSettings map_settings_;
  LidarSettings lidar_;
  std::variant<VoxelMap, DistributionMap> map_;
};

}  // namespace tarmac::estimators
