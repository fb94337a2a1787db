/// From keypoints and a map to planes.
#pragma once

#include <span>
#include <vector>

#include "estimators/ct_icp/elastic_problem.h"

namespace tarmac::estimators {

/// For every keypoint, placed by `motion`: its neighbours in the map, the plane fitted to them, turned towards the
/// sensor (at p_body_lidar in the body), through the nearest of them, and the weight. Not used: keypoints with too few
/// neighbours, without any planarity, off the gate, or beyond max_residuals. Parallel; each keypoint stands for itself.
/// `associations` may hold those of another motion with the same keypoints and map, which saves time; else it is empty.
/// @returns how many are used
int associate(const VoxelMap& map, const AssociationSettings& settings, const core::Segment& motion,
              const Eigen::Vector3d& p_body_lidar, std::span<const Keypoint> keypoints,
              std::vector<Association>& associations);

}  // namespace tarmac::estimators
