/// KISS-ICP in the LiDAR's own frame: sweep in, pose at the sweep's last point out.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/measurements.h"
#include "estimators/blocks/local_plane.h"
#include "estimators/blocks/voxel_map.h"
#include "estimators/blocks/voxel_sampler.h"
#include "estimators/kiss_icp/adaptive_threshold.h"
#include "estimators/kiss_icp/deskew.h"
#include "estimators/kiss_icp/options.h"
#include "estimators/kiss_icp/registration.h"

namespace tarmac::estimators {

/// The whole method by its publication: deskew, range gate, thin out twice, predict, register, adapt, map.
/// Source: Vizzo et al., RA-L 8(2) 2023, section III; upstream v1.2.3.
class KissOdometry {
 public:
  explicit KissOdometry(const KissIcpOptions& options);

  /// One point against the plane that the map holds where the registration put it.
  struct SurfacePoint {
    std::uint32_t point = 0;  ///< index into the sweep
    LocalPlane plane;         ///< in the map's axes
  };
  struct Step {
    IcpResult icp;
    std::vector<SurfacePoint> surface;  ///< if asked for
    SweepMotion motion;                 ///< by which the points were placed
    double sigma_m = 0;
    std::vector<std::pair<std::string, double>> stages_ms;
  };
  /// Deskewing and prediction by the motion of the sweep before. Parallel inside the calling task arena.
  Step add(const core::LidarSweep& sweep);
  /// The same with both from elsewhere. `T_predicted`: of the LiDAR in the map, at the sweep's last point.
  Step add(const core::LidarSweep& sweep, const SweepMotion& motion, const core::SE3& T_predicted);
  /// Look for planes at every point that could go into the map, in the map as it was kSurfaceAge sweeps ago: what is
  /// wrong with this sweep was likely wrong with the last few in the same way, and their points would hide it.
  void look_for_surfaces() { surfaces_ = true; }
  static constexpr std::int32_t kSurfaceAge = 10;

  const core::SE3& T_map_lidar() const { return T_map_lidar_; }
  const AdaptiveThreshold& threshold() const { return threshold_; }
  const VoxelMap& map() const { return map_; }
  const Registration& registration() const { return registration_; }
  /// Of the last sweep: all its points at its end, and which of them (indices) went into the map and into the ICP.
  const std::vector<Eigen::Vector3d>& deskewed_m() const { return deskewed_m_; }
  const std::vector<std::uint32_t>& map_sample() const { return map_sample_; }
  const std::vector<std::uint32_t>& icp_sample() const { return icp_sample_; }

 private:
  void gate_range();
  void thin_out();
  std::vector<SurfacePoint> surfaces_at(const core::SE3& T_map_lidar) const;
  void update_map();

  KissIcpOptions options_;
  bool surfaces_ = false;
  std::int32_t sweeps_ = 0;  ///< until now
  VoxelSampler sampler_;
  Registration registration_;
  VoxelMap map_;
  AdaptiveThreshold threshold_;
  core::SE3 T_map_lidar_ = core::SE3::Identity();
  core::SE3 D_ = core::SE3::Identity();  ///< last relative motion, T_{k-1}^-1 T_k

  std::vector<Eigen::Vector3d> deskewed_m_;
  std::vector<std::uint32_t> in_range_, map_sample_, icp_sample_;
  std::vector<Eigen::Vector3d> source_m_;
};

}  // namespace tarmac::estimators
