/// LiDAR odometry on a sliding window of continuous-time motion: one front end for every motion model.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/measurements.h"
#include "core/rig.h"
#include "estimators/blocks/elastic_sampler.h"
#include "estimators/window/window.h"
#include "estimators/window_odometry/inertial_start.h"
#include "estimators/window_odometry/keypoints.h"
#include "estimators/window_odometry/motion_model.h"
#include "estimators/window_odometry/surface_map.h"

namespace tarmac::estimators {

/// Sweep by sweep: thin out; let the trajectory grow over the sweep and, with an IMU, fit it to the readings (the
/// prediction); then in turn look for the surfaces that the placed points belong to and solve the window; put a sweep
/// into the map; let what is old leave the window.
class WindowOdometry {
 public:
  /// Throws InputError where settings contradict each other.
  WindowOdometry(const WindowOdometrySettings& settings, const core::Rig& rig);

  struct Step {
    bool started = false;  ///< false: not initialised yet, nothing else is set
    bool lost = false;     ///< too few surfaces, or no solution: the prediction was kept
    bool first = false;
    core::Segment motion;
    core::SE3 T_map_body_end = core::SE3::Identity();
    int associations = 0, solver_steps = 0, residuals = 0;
    bool converged = false;
    int clipped_stamps = 0;
    std::vector<std::pair<std::string, double>> stages_ms;
  };
  void add(const core::ImuSample& sample);
  /// Parallel inside the calling task arena.
  Step add(const core::LidarSweep& sweep);

  const WindowOdometrySettings& settings() const { return settings_; }
  const Window& window() const { return *window_; }
  const InertialStart& inertial() const { return inertial_; }
  /// Why it has not started, for the run's message.
  std::string why_not() const;
  /// Of the last sweep: keypoints and what they were matched to (last association).
  const TimedPoints& keypoints() const { return keypoints_; }
  const std::vector<SurfaceMatch>& matches() const { return matches_; }
  /// Information on the pose at the last sweep's end that the window has from all but that sweep's points; zero where a
  /// direction is left free.
  core::Matrix6 prior_information(const core::LidarSweep& sweep) const;

 private:
  struct PastSweep {
    std::int64_t index = 0;
    core::Time begin, end;
    TimedPoints sample;  ///< emptied once in the map
  };
  bool startup() const { return sweeps_ < settings_.sampling.startup_sweeps; }
  bool can_start(const core::LidarSweep& sweep) const;
  void start(const core::LidarSweep& sweep);
  void anchor_start(core::Time begin);
  void grow(const core::LidarSweep& sweep);
  void forget_before(core::Time t);
  void predict();
  struct SweepEnds {
    core::SE3 begin, end;
  };
  /// @returns how many keypoints found a surface
  int match_keypoints();
  bool has_settled(const SweepEnds& before, const SweepEnds& now) const;
  void register_sweep(const core::LidarSweep& sweep, Step& step);
  void update_map();

  WindowOdometrySettings settings_;
  core::Rig rig_;
  core::SE3 T_body_lidar_;
  MotionModel model_;
  ElasticSampler sampler_;
  InertialStart inertial_;
  SurfaceMap map_;
  std::optional<Window> window_;
  int sweeps_ = 0;
  core::Time last_end_;       ///< of the sweep before
  core::Duration period_{0};  ///< between sweeps
  std::size_t most_keypoints_ = 0;
  std::deque<PastSweep> past_;  ///< of the window, the last one being the present
  std::vector<core::ImuSample> since_last_;
  TimedPoints keypoints_;
  std::vector<SurfaceMatch> matches_;
  std::vector<core::SE3> T_map_body_;
  std::vector<Eigen::Vector3d> p_map_, sensor_map_;
};

}  // namespace tarmac::estimators
