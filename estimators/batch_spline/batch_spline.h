/// All data of a survey at once, on one spline: its reference trajectory.
#pragma once

#include <tbb/task_arena.h>

#include <optional>
#include <vector>

#include "core/spline_trajectory.h"
#include "estimators/batch_spline/options.h"
#include "estimators/estimator.h"
#include "estimators/window_odometry/odometry.h"

namespace tarmac::estimators {

/// While sweeps come in, an odometry places them. At the end a cubic B-spline is fitted to its motion, and then in
/// rounds: a map is made of all sweeps, every keypoint is matched to it, and all control points, biases, gravity's
/// direction and (on request) the IMU's time offset are solved for together. `final` only; all sweeps' points are kept
/// in memory. Source: Furgale, Rehder, Siegwart, IROS 2013, with points on surfaces of the map instead of a known
/// target.
class BatchSpline final : public Estimator {
 public:
  BatchSpline(const BatchSplineOptions& options, const EstimatorContext& context);
  void add(const core::ImuSample& sample) override;
  SweepOutcome add(const core::LidarSweep& sweep) override;
  void finish(core::Estimate& estimate) override;

  /// After finish(): the solved problem; none where the odometry never started.
  const std::optional<Window>& window() const { return window_; }
  int rounds() const { return rounds_; }

 private:
  struct Kept {
    std::int64_t index = 0;
    core::Time begin, end;
    TimedPoints keypoints, sample;
  };
  void keep(const core::LidarSweep& sweep, const WindowOdometry::Step& step);
  void start_window();
  /// One round. @returns how far the sweep's end that moved most has moved [m]
  double solve_round();
  void match_all(const SurfaceMap& map);

  BatchSplineOptions options_;
  core::Rig rig_;
  bool with_imu_;
  WindowOdometry odometry_;
  ElasticSampler sampler_;
  tbb::task_arena arena_;
  std::vector<Kept> kept_;
  core::PiecewiseTrajectory first_guess_;
  std::vector<ImuReading> readings_;
  std::optional<Window> window_;
  int rounds_ = 0;
};

}  // namespace tarmac::estimators
