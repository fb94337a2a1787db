/// The points of a sweep that are registered, and those that enter the map, with their times.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/measurements.h"
#include "core/parametric_trajectory.h"
#include "estimators/window_odometry/surface_map.h"

namespace tarmac::estimators {

/// Points in order of their stamps; a stamp is asked for once, however many points share it.
struct TimedPoints {
  std::vector<Eigen::Vector3d> p_body;
  std::vector<std::uint32_t> point;  ///< index into the sweep
  std::vector<core::Time> stamps;    ///< ascending, each once
  std::vector<std::uint32_t> stamp;  ///< of each point: index into `stamps`
  int clipped = 0;                   ///< stamps outside the sweep, moved to its begin or end

  std::size_t size() const { return p_body.size(); }
};

/// Those of the sweep's points with the given indices, in the body's frame.
TimedPoints timed_points(const core::LidarSweep& sweep, std::span<const std::uint32_t> indices,
                         const core::SE3& T_body_lidar);

/// All points placed by a trajectory, which must cover their stamps; and its poses at the stamps.
void place(const TimedPoints& points, const core::ParametricTrajectory& trajectory, std::vector<core::SE3>& T_map_body,
           std::vector<Eigen::Vector3d>& p_map);

/// The matches that are used, stamp by stamp, as the window takes them. `matches`: one a point.
LidarFactors lidar_factors(const TimedPoints& points, std::span<const SurfaceMatch> matches, bool distributions);

}  // namespace tarmac::estimators
