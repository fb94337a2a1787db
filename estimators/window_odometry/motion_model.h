/// From settings to a trajectory, its knots and its priors.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/measurements.h"
#include "core/parametric_trajectory.h"
#include "estimators/window/window.h"
#include "estimators/window_odometry/settings.h"

namespace tarmac::estimators {

/// The motion model's side of a window: how it begins, where its knots go, what ties its sweeps together.
class MotionModel {
 public:
  MotionModel(const MotionSettings& settings, double gravity_m_s2) : settings_(settings), gravity_m_s2_(gravity_m_s2) {}

  /// At rest at T from `begin` on; covers `begin` at least after the first extend_over().
  /// `period`: between sweeps, as far as known.
  std::unique_ptr<core::ParametricTrajectory> at_rest(core::Time begin, const core::SE3& T_map_body,
                                                      core::Duration period) const;
  /// Grows the window's trajectory over a sweep, by the policy of knots. `imu`: what was measured since the last
  /// sweep's end.
  void extend_over(Window& window, core::Time begin, core::Time end, core::Duration period,
                   std::span<const core::ImuSample> imu) const;
  /// The prior of models that have none of their own: smoothness of splines.
  void set_prior(WindowModel& model) const;
  /// What ties a new sweep of a sweepwise model to the motion before it, what extend() made of it being the mean.
  /// Nothing for the others.
  void add_ties(Window& window, core::Time last_end, core::Time begin, core::Time end) const;

 private:
  std::vector<core::Time> knots_over(const core::ParametricTrajectory& trajectory, core::Time end,
                                     core::Duration period, std::span<const core::ImuSample> imu) const;

  MotionSettings settings_;
  double gravity_m_s2_;
};

}  // namespace tarmac::estimators
