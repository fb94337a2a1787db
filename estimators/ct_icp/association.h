/// From keypoints and a map to planes.
#pragma once

#include <span>
#include <vector>

#include "estimators/blocks/nearest_points.h"
#include "estimators/ct_icp/elastic_problem.h"

namespace tarmac::estimators {

struct AssociationSettings {
  NearestSearch search;
  int min_neighbours = 20;
  bool farthest_plane_point = false;
  double planarity_weight = 1, neighbourhood_weight = 0, planarity_power = 2;
  double neighbourhood_distance_m = 0.3;
  double max_plane_distance_m = 0;  ///< 0: no gate
  int max_residuals = 0;            ///< 0: no limit
};

/// The weight of a keypoint at `distance_m` from its plane point, in [0, 1]:
///   w = (A a2D^power + B exp(-distance / (d k))) / (A + B), k = min_neighbours
double association_weight(const AssociationSettings& settings, double planarity, double distance_m);

/// For every keypoint, placed by `motion`: its neighbours in the map, the plane fitted to them, turned towards the
/// sensor (at p_body_lidar in the body), through the nearest of them, and the weight. Not used: keypoints with too few
/// neighbours, without any planarity, off the gate, or beyond max_residuals. Parallel; each keypoint stands for itself.
/// `associations` may hold those of another motion with the same keypoints and map, which saves time; else it is empty.
/// @returns how many are used
int associate(const VoxelMap& map, const AssociationSettings& settings, const core::Segment& motion,
              const Eigen::Vector3d& p_body_lidar, std::span<const Keypoint> keypoints,
              std::vector<Association>& associations);

}  // namespace tarmac::estimators
