#include "estimators/kiss_icp/odometry.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "estimators/blocks/stopwatch.h"
#include "estimators/estimator.h"

namespace tarmac::estimators {

using core::SE3;
using Eigen::Vector3d;

KissOdometry::KissOdometry(const KissIcpOptions& options)
    : options_(options),
      registration_({.max_iterations = options.max_iterations, .convergence = options.convergence}),
      map_(options.voxel_size_m, options.max_points_per_voxel),
      threshold_(options.initial_threshold_m, options.min_motion_m, options.max_range_m) {}

KissOdometry::Step KissOdometry::add(const core::LidarSweep& sweep) {
  return add(sweep, SweepMotion(sweep, D_, options_.deskew), core::se3::normalized(T_map_lidar_ * D_));
}

KissOdometry::Step KissOdometry::add(const core::LidarSweep& sweep, const SweepMotion& motion, const SE3& T_predicted) {
  Step step;
  Stopwatch stopwatch(step.stages_ms);

  step.motion = motion;
  deskew(sweep, step.motion, deskewed_m_);
  stopwatch.lap("deskew");

  gate_range();
  thin_out();
  stopwatch.lap("sampling");

  step.sigma_m = options_.fixed_threshold_m > 0 ? options_.fixed_threshold_m : threshold_.sigma_m();
  step.icp = registration_.align(source_m_, map_, T_predicted, step.sigma_m);
  stopwatch.lap("icp");

  if (surfaces_) {
    step.surface = surfaces_at(step.icp.T_map_lidar_linearised);
    stopwatch.lap(kSurfacesStage);
  }
  threshold_.update(T_predicted.inverse() * step.icp.T_map_lidar);
  D_ = core::se3::normalized(T_map_lidar_.inverse() * step.icp.T_map_lidar);
  T_map_lidar_ = step.icp.T_map_lidar;
  update_map();
  stopwatch.lap("map");
  return step;
}

void KissOdometry::gate_range() {
  in_range_.clear();
  for (std::size_t i = 0; i < deskewed_m_.size(); ++i) {
    const double range_m = deskewed_m_[i].norm();
    // Written so that NaN fails.
    if (range_m < options_.max_range_m && range_m > options_.min_range_m) {
      in_range_.push_back(static_cast<std::uint32_t>(i));
    }
  }
}

void KissOdometry::thin_out() {
  sampler_.sample(deskewed_m_, in_range_, 0.5 * options_.voxel_size_m, map_sample_);
  sampler_.sample(deskewed_m_, map_sample_, 1.5 * options_.voxel_size_m, icp_sample_);
  source_m_.clear();
  for (const std::uint32_t i : icp_sample_) source_m_.push_back(deskewed_m_[i]);
}

std::vector<KissOdometry::SurfacePoint> KissOdometry::surfaces_at(const SE3& T_map_lidar) const {
  const double radius_m = options_.voxel_size_m, max_thickness_m = 0.05 * options_.voxel_size_m;
  std::vector<std::optional<LocalPlane>> planes(map_sample_.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, planes.size(), 64), [&](const auto& range) {
    std::vector<Vector3d> near_m;
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const Vector3d p_map = T_map_lidar * deskewed_m_[map_sample_[k]];
      near_m.clear();
      map_.gather(p_map, radius_m, sweeps_ - kSurfaceAge, near_m);
      planes[k] = fit_plane(near_m, max_thickness_m);
    }
  });
  std::vector<SurfacePoint> found;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (planes[k]) found.push_back({map_sample_[k], *planes[k]});
  }
  return found;
}

void KissOdometry::update_map() {
  for (const std::uint32_t i : map_sample_) map_.add(T_map_lidar_ * deskewed_m_[i], sweeps_);
  map_.remove_far(T_map_lidar_.translation(), options_.max_range_m);
  ++sweeps_;
}

}  // namespace tarmac::estimators
