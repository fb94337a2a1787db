#include "estimators/window_odometry/motion_model.h"

#include <algorithm>
#include <cmath>

#include "core/gp_trajectory.h"
#include "core/knots.h"
#include "core/spline_trajectory.h"
#include "core/sweepwise_trajectory.h"

namespace tarmac::estimators {
namespace {

using core::Duration;
using core::SE3;
using core::Time;

core::Vector6 both(double translation, double rotation) {
  core::Vector6 v;
  v << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return v;
}

core::SweepwiseModel sweepwise_named(const std::string& name) {
  if (name == "rigid") return core::SweepwiseModel::rigid;
  if (name == "constant-velocity") return core::SweepwiseModel::constant_velocity;
  return name == "two-pose-slerp" ? core::SweepwiseModel::two_pose_slerp : core::SweepwiseModel::two_pose_screw;
}

core::GpModel gp_named(const std::string& name) {
  if (name == "wnoa") return core::GpModel::wnoa;
  return name == "wnoj" ? core::GpModel::wnoj : core::GpModel::singer;
}

}  // namespace

std::unique_ptr<core::ParametricTrajectory> MotionModel::at_rest(Time begin, const SE3& T_map_body,
                                                                 Duration period) const {
  if (settings_.is_spline()) {
    const auto kind = settings_.model == "spline" ? core::SplineKind::split : core::SplineKind::se3;
    Duration spacing = period;
    if (settings_.knots == "uniform") spacing = core::duration_from_s(settings_.knot_spacing_s);
    if (settings_.knots == "imu-excitation") spacing = core::ExcitationRule().slot;
    return std::make_unique<core::SplineTrajectory>(core::SplineTrajectory::at_rest(
        kind, settings_.order, T_map_body, core::uniform_knots(begin, begin, spacing, settings_.order)));
  }
  if (settings_.is_gp()) {
    core::GpPrior prior{gp_named(settings_.model), both(settings_.process_translation, settings_.process_rotation),
                        both(settings_.singer_rate_translation_hz, settings_.singer_rate_rotation_hz)};
    std::vector<core::GpKnot> knots(1);
    knots[0].t = begin;
    knots[0].T_world_body = T_map_body;
    return std::make_unique<core::GpTrajectory>(prior, std::move(knots));
  }
  return std::make_unique<core::SweepwiseTrajectory>(sweepwise_named(settings_.model), T_map_body);
}

std::vector<Time> MotionModel::knots_over(const core::ParametricTrajectory& trajectory, Time end, Duration period,
                                          std::span<const core::ImuSample> imu) const {
  if (settings_.is_sweepwise()) return {};
  const auto* spline = dynamic_cast<const core::SplineTrajectory*>(&trajectory);
  const Time last = trajectory.end();
  const std::span<const Time> have = spline != nullptr ? std::span(spline->knots()) : std::span(&last, 1);
  // A spline is settled by knots beyond its end.
  const int beyond = spline != nullptr ? spline->order() : 0;
  if (settings_.knots == "uniform")
    return core::uniform_knots_after(have, end, core::duration_from_s(settings_.knot_spacing_s), beyond);
  if (settings_.knots == "imu-excitation") {
    core::ExcitationRule rule;
    rule.gravity_m_s2 = gravity_m_s2_;
    return core::excitation_knots_after(have, end, imu, rule, beyond);
  }
  if (spline != nullptr) return core::sweep_knots_after(have, end, period, beyond);
  std::vector<Time> knots;
  if (end <= last) return knots;
  // A sweep of one packet may be over before two knots are apart.
  const Duration span = std::max(end - last, core::kGpMinimumSpacing);
  const auto count = std::clamp<std::int64_t>(span / core::kGpMinimumSpacing, 1, settings_.knots_a_sweep);
  for (std::int64_t i = 1; i <= count; ++i) knots.push_back(last + Duration(span.count() * i / count));
  return knots;
}

void MotionModel::extend_over(Window& window, Time begin, Time end, Duration period,
                              std::span<const core::ImuSample> imu) const {
  core::ParametricTrajectory& trajectory = window.trajectory();
  trajectory.extend(begin, end, knots_over(trajectory, end, period, imu));
}

void MotionModel::set_prior(WindowModel& model) const {
  if (!settings_.is_spline()) return;
  model.smoothness_translation = settings_.process_translation;
  model.smoothness_rotation = settings_.process_rotation;
}

void MotionModel::add_ties(Window& window, Time last_end, Time begin, Time end) const {
  if (!settings_.is_sweepwise()) return;
  // White noise on acceleration, as other models have it: over a time d velocity strays by sqrt(q d), position by
  // sqrt(q d^3/3). What extend() predicted is the mean.
  const double d = std::max(core::to_s(end - last_end), 1e-3), gap = core::to_s(begin - last_end);
  core::StateVector sigma = core::StateVector::Zero();
  if (!settings_.has_velocity()) {
    sigma.head<6>() = (both(settings_.process_translation, settings_.process_rotation) * (d * d * d / 3)).cwiseSqrt();
    window.add_anchor(end, window.trajectory().at(end), sigma);
    return;
  }
  const double rad = settings_.continuity_sigma_deg * kRadPerDeg;
  const core::Vector6 drift = both(settings_.process_translation, settings_.process_rotation) * (gap * gap * gap / 3);
  sigma.head<6>() = (both(settings_.continuity_sigma_m, rad).cwiseAbs2() + drift).cwiseSqrt();
  sigma.segment<3>(core::state_row::velocity).setConstant(std::sqrt(settings_.process_translation * d));
  sigma.segment<3>(core::state_row::omega).setConstant(std::sqrt(settings_.process_rotation * d));
  window.add_anchor(begin, window.trajectory().at(begin), sigma);
}

}  // namespace tarmac::estimators
