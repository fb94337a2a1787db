#include "core/measurements.h"

namespace tarmac::core {

void LidarSweep::reserve(std::size_t n) {
  x_m.reserve(n);
  y_m.reserve(n);
  z_m.reserve(n);
  t_ns.reserve(n);
  ring.reserve(n);
  intensity.reserve(n);
}

void LidarSweep::push_back(const Eigen::Vector3f& p_lidar, std::int32_t point_t_ns, std::uint16_t point_ring,
                           float point_intensity) {
  x_m.push_back(p_lidar.x());
  y_m.push_back(p_lidar.y());
  z_m.push_back(p_lidar.z());
  t_ns.push_back(point_t_ns);
  ring.push_back(point_ring);
  intensity.push_back(point_intensity);
}

}  // namespace tarmac::core
