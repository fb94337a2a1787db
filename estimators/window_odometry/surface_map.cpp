#include "estimators/window_odometry/surface_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "estimators/blocks/plane_fit.h"

namespace tarmac::estimators {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::variant<VoxelMap, DistributionMap> make_map(const MapSettings& map, const LidarSettings& lidar) {
  if (map.kind == "points") return VoxelMap(map.voxel_m, map.max_points_per_voxel, map.min_distance_m);
  return DistributionMap(map.voxel_m, lidar.min_distribution_points,
                         std::max(map.max_points_per_voxel, lidar.min_distribution_points));
}

}  // namespace

SurfaceMap::SurfaceMap(const MapSettings& map, const LidarSettings& lidar)
    : map_settings_(map), lidar_(lidar), map_(make_map(map, lidar)) {}

void SurfaceMap::add(std::span<const Vector3d> points_map) {
  std::visit(
      [&](auto& map) {
        for (const Vector3d& p : points_map) map.add(p);
      },
      map_);
}

void SurfaceMap::remove_far(const Vector3d& centre_map) {
  std::visit([&](auto& map) { map.remove_far(centre_map, map_settings_.radius_m); }, map_);
}

int SurfaceMap::match(std::span<const Vector3d> p_body, std::span<const Vector3d> p_map,
                      std::span<const Vector3d> sensor_map, bool startup, std::vector<SurfaceMatch>& matches) const {
  matches.resize(p_body.size());
  const auto each = [&](const auto& one) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, p_body.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        one(k, matches[k]);
        matches[k].factor.p_body = p_body[k];
      }
    });
  };
  if (const auto* points = std::get_if<VoxelMap>(&map_)) {
    const AssociationSettings settings{.search = {.max_points = lidar_.max_neighbours,
                                                  .reach = startup ? lidar_.startup_voxel_reach : lidar_.voxel_reach},
                                       .min_neighbours = lidar_.min_neighbours,
                                       .planarity_power = lidar_.planarity_power,
                                       .max_plane_distance_m = lidar_.max_plane_distance_m};
    const NearestPointsFinder finder(*points, settings.search);
    each([&](std::size_t k, SurfaceMatch& match) {
      match.association = associate_point(finder, settings, p_map[k], sensor_map[k], match.association);
      match.used = match.association.used;
      match.factor.q_map = match.association.q_map;
      match.factor.n_map = match.association.n_map;
      match.factor.weight = match.association.weight;
    });
  } else {
    const auto& distributions = std::get<DistributionMap>(map_);
    each(
        [&](std::size_t k, SurfaceMatch& match) { match_distribution(distributions, p_map[k], sensor_map[k], match); });
  }
  return static_cast<int>(std::count_if(matches.begin(), matches.end(), [](const SurfaceMatch& m) { return m.used; }));
}

void SurfaceMap::match_distribution(const DistributionMap& map, const Vector3d& p_map, const Vector3d& sensor_map,
                                    SurfaceMatch& match) const {
  match.used = false;
  const auto found = map.nearest(p_map);
  if (!found) return;
  // sigma^2 (C + sigma^2 I)^-1 = U^T U: along a direction of wide spread little is known, across it a point of full
  // weight counts as one on a plane.
  const double variance = lidar_.sigma_m * lidar_.sigma_m;
  const Matrix3d information = variance * (found->covariance_m2 + variance * Matrix3d::Identity()).inverse();
  match.factor.sqrt_information = information.llt().matrixU();
  match.factor.q_map = found->mean_map;
  const Vector3d n = smallest_eigen(found->covariance_m2).vector;
  match.factor.n_map = n.dot(sensor_map - found->mean_map) < 0 ? Vector3d(-n) : n;
  match.factor.weight = 1;
  const double off_m = std::abs(match.factor.n_map.dot(p_map - found->mean_map));
  match.used = lidar_.max_plane_distance_m <= 0 || off_m < lidar_.max_plane_distance_m;
}

}  // namespace tarmac::estimators
