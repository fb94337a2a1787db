#include "estimators/ct_icp/association.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace tarmac::estimators {

using Eigen::Vector3d;

int associate(const VoxelMap& map, const AssociationSettings& settings, const core::Segment& motion,
              const Vector3d& p_body_lidar, std::span<const Keypoint> keypoints,
              std::vector<Association>& associations) {
  associations.resize(keypoints.size());
  const NearestPointsFinder finder(map, settings.search);
  const SegmentSampler sampler(motion);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keypoints.size(), 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const core::SE3 T_map_body = sampler.pose(keypoints[k].alpha);
      associations[k] = associate_point(finder, settings, T_map_body * keypoints[k].p_body, T_map_body * p_body_lidar,
                                        associations[k]);
    }
  });
  int used = 0;
  for (Association& a : associations) {
    if (a.used && settings.max_residuals > 0 && used == settings.max_residuals) a.used = false;
    if (a.used) ++used;
  }
  return used;
}

}  // namespace tarmac::estimators
