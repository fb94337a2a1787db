/// From a placed point and a map to a plane.
#pragma once

#include <Eigen/Core>

#include "estimators/blocks/nearest_points.h"

namespace tarmac::estimators {

/// The plane that a keypoint is drawn to: through q, unit normal n turned towards the sensor.
struct Association {
  bool used = false;
  Eigen::Vector3d q_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d n_map = Eigen::Vector3d::UnitZ();
  double weight = 0;  ///< w: the residual is w n^T (p_map - q)
  /// Where the keypoint was looked up and how far its last neighbour lay: the next search starts from that. Negative:
  /// there were too few.
  Eigen::Vector3d searched_at_map = Eigen::Vector3d::Zero();
  double reached_m = -1;
};

struct AssociationSettings {
  NearestSearch search;
  int min_neighbours = 20;
  bool farthest_plane_point = false;
  double planarity_weight = 1, neighbourhood_weight = 0, planarity_power = 2;
  double neighbourhood_distance_m = 0.3;
  double max_plane_distance_m = 0;  ///< 0: no gate
  int max_residuals = 0;            ///< 0: no limit; kept by the callers
};

/// The weight of a keypoint at `distance_m` from its plane point, in [0, 1]:
///   w = (A a2D^power + B exp(-distance / (d k))) / (A + B), k = min_neighbours
double association_weight(const AssociationSettings& settings, double planarity, double distance_m);

/// Of a point placed at p_map, its sensor at sensor_map: its neighbours in the map, the plane fitted to them, turned
/// towards the sensor, through the nearest of them, and the weight. Not used: points with too few neighbours, without
/// any planarity, or off the gate. `before` may be the association of the same point placed elsewhere in the same map,
/// which saves time; else it is Association().
Association associate_point(const NearestPointsFinder& finder, const AssociationSettings& settings,
                            const Eigen::Vector3d& p_map, const Eigen::Vector3d& sensor_map, const Association& before);

}  // namespace tarmac::estimators
