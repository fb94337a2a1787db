#include "estimators/blocks/distribution_map.h"

#include <limits>

namespace tarmac::estimators {

using Eigen::Vector3d;

DistributionMap::DistributionMap(double voxel_size_m, int min_points, int max_points)
    : voxel_size_m_(voxel_size_m), min_points_(min_points), max_points_(max_points) {}

void DistributionMap::add(const Vector3d& p_map) {
  if (!has_voxel(p_map, voxel_size_m_)) return;
  Cell& cell = cells_[voxel_of(p_map, voxel_size_m_)];
  if (cell.points == max_points_) return;
  ++cell.points;
  const Vector3d before = p_map - cell.mean;
  cell.mean += before / cell.points;
  cell.scatter += before * (p_map - cell.mean).transpose();
}

void DistributionMap::remove_far(const Vector3d& centre, double radius_m) {
  std::erase_if(cells_,
                [&](const auto& entry) { return (entry.second.mean - centre).squaredNorm() >= radius_m * radius_m; });
}

std::optional<DistributionMap::Distribution> DistributionMap::nearest(const Vector3d& p_map) const {
  if (!has_voxel(p_map, voxel_size_m_)) return std::nullopt;
  const Voxel own = voxel_of(p_map, voxel_size_m_);
  const Cell* best = nullptr;
  double best2 = std::numeric_limits<double>::infinity();
  for (std::int32_t dx = -1; dx <= 1; ++dx) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dz = -1; dz <= 1; ++dz) {
        const auto found = cells_.find({own.x + dx, own.y + dy, own.z + dz});
        if (found == cells_.end() || found->second.points < min_points_) continue;
        const double d2 = (found->second.mean - p_map).squaredNorm();
        if (d2 < best2) {
          best2 = d2;
          best = &found->second;
        }
      }
    }
  }
  if (best == nullptr) return std::nullopt;
  return Distribution{best->mean, 0.5 / best->points * (best->scatter + best->scatter.transpose()), best->points};
}

}  // namespace tarmac::estimators
