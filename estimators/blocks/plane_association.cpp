#include "estimators/blocks/plane_association.h"

#include <cmath>
#include <limits>

#include "estimators/blocks/plane_fit.h"

namespace tarmac::estimators {

using Eigen::Vector3d;

Association associate_point(const NearestPointsFinder& finder, const AssociationSettings& settings,
                            const Vector3d& p_map, const Vector3d& sensor_map, const Association& before) {
  Association a;
  NearestPoints neighbours;
  // The neighbours of the search before are no farther than they were, plus the way that the point has gone.
  const double expected_m = before.reached_m < 0 ? std::numeric_limits<double>::infinity()
                                                 : before.reached_m + (p_map - before.searched_at_map).norm() + 1e-9;
  finder.find(p_map, neighbours, expected_m);
  if (neighbours.count < settings.min_neighbours) return a;
  a.searched_at_map = p_map;
  if (neighbours.count == settings.search.max_points) a.reached_m = neighbours.offset(neighbours.count - 1).norm();
  const PlaneFit plane = fit_plane(neighbours);
  const Vector3d to_q = neighbours.offset(settings.farthest_plane_point ? neighbours.count - 1 : 0);
  a.q_map = p_map + to_q;
  a.n_map = plane.normal.dot(sensor_map - a.q_map) < 0 ? Vector3d(-plane.normal) : plane.normal;
  a.weight = association_weight(settings, plane.planarity, to_q.norm());
  const bool in_gate =
      settings.max_plane_distance_m <= 0 || std::abs(a.n_map.dot(to_q)) < settings.max_plane_distance_m;
  a.used = in_gate && a.weight > 0;
  return a;
}

double association_weight(const AssociationSettings& settings, double planarity, double distance_m) {
  const double A = settings.planarity_weight, B = settings.neighbourhood_weight;
  const double power = settings.planarity_power;
  const double flat = power == 2 ? planarity * planarity : std::pow(planarity, power);
  const double near =
      B > 0 ? std::exp(-distance_m / (settings.neighbourhood_distance_m * settings.min_neighbours)) : 0.0;
  return (A * flat + B * near) / (A + B);
}

}  // namespace tarmac::estimators
