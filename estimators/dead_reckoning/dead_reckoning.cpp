#include "estimators/dead_reckoning/dead_reckoning.h"

#include <algorithm>

namespace tarmac::estimators {

using core::Duration;
using core::SE3;
using core::Time;
using Eigen::Vector3d;

DeadReckoning::DeadReckoning(const DeadReckoningOptions& options, const EstimatorContext& context)
    : options_(options), gravity_m_s2_(context.rig.gravity_m_s2), cannot_start_(no_usable_imu(context.rig)) {
  if (!cannot_start_.empty()) return;
  sheet_ = context.rig.imus[0];
  static_start_.emplace(options, sheet_.T_body_imu.linear(), gravity_m_s2_, sheet_.rate_hz);
}

void DeadReckoning::add(const core::ImuSample& sample) {
  if (!static_start_) return;
  if (!start_) {
    core::ImuSample centred = sample;
    centred.t = sample.t - sheet_.delay;
    start_ = static_start_->add(centred);
    if (start_) begin_at(*start_, centred.t + core::duration_from_s(0.5 / sheet_.rate_hz));
    return;
  }
  for (const ImuSpan& span : chain_->add(sample)) {
    const InertialState start = state_at(intervals_.back(), intervals_.back().end);
    intervals_.push_back({start, span.end, span.gyro_rad_s - start_->gyro_bias_rad_s,
                          span.accel_m_s2 - start_->accel_bias_m_s2, span.hole});
  }
}

void DeadReckoning::begin_at(const StaticStart::Result& start, Time end) {
  // The body's origin rests at the map's, and has done so all through the window.
  Interval rest;
  rest.start.t = end - core::duration_from_s(options_.rest_window_s);
  rest.start.R_map_imu = start.R_map_imu;
  const Eigen::Matrix3d R_map_body = start.R_map_imu * sheet_.T_body_imu.linear().transpose();
  rest.start.p_map_m = R_map_body * sheet_.T_body_imu.translation();
  rest.end = end;
  rest.omega_rad_s.setZero();
  rest.f_m_s2 = start.R_map_imu.transpose() * Vector3d(0, 0, gravity_m_s2_);
  intervals_.push_back(rest);
  chain_.emplace(
      sheet_, options_.max_gap_periods,
      ImuSpan{rest.start.t, end, start.gyro_bias_rad_s, Vector3d(rest.f_m_s2 + start.accel_bias_m_s2), false});
}

InertialState DeadReckoning::state_at(const Interval& interval, Time t) const {
  return propagate(interval.start, interval.omega_rad_s, interval.f_m_s2, gravity_m_s2_, t);
}

core::Segment DeadReckoning::motion_over(const core::LidarSweep& sweep) const {
  const SE3 T_imu_body = sheet_.T_body_imu.inverse();
  std::vector<Time> times;
  std::vector<SE3> poses;
  const auto node = [&](const Interval& interval, Time t) {
    times.push_back(t);
    poses.push_back(state_at(interval, t).T_map_imu() * T_imu_body);
  };
  for (const Interval& interval : intervals_) {
    const bool last = &interval == &intervals_.back();
    if (interval.end <= sweep.begin && !last) continue;
    if (times.empty()) node(interval, sweep.begin);
    if (last || interval.end >= sweep.end) {
      // Samples arrive later than what they stand for: the last one's rate and force are taken to go on.
      if (sweep.end > times.back()) node(interval, sweep.end);
      break;
    }
    node(interval, interval.end);
  }
  return core::Segment::sampled(core::SegmentModel::sampled_slerp, std::move(times), std::move(poses));
}

bool DeadReckoning::in_hole(const core::LidarSweep& sweep) const {
  if (sweep.end - intervals_.back().end > chain_->patience()) return true;
  return std::any_of(intervals_.begin(), intervals_.end(), [&](const Interval& interval) {
    return interval.hole && interval.start.t < sweep.end && interval.end > sweep.begin;
  });
}

SweepOutcome DeadReckoning::add(const core::LidarSweep& sweep) {
  SweepOutcome outcome = initialising_outcome(sweep);
  if (!covers(sweep)) return outcome;
  outcome.result.status = in_hole(sweep) ? core::SweepStatus::lost : core::SweepStatus::ok;
  outcome.motion.push_back(motion_over(sweep));
  outcome.result.T_map_body = outcome.motion.back().poses.back();
  outcome.diagnostics.converged = true;
  while (intervals_.size() > 1 && intervals_.front().end <= sweep.end) intervals_.pop_front();
  return outcome;
}

void DeadReckoning::finish(core::Estimate& estimate) {
  estimate.gravity_aligned = true;
  if (start_) return;
  estimate.status = core::RunStatus::not_initialised;
  estimate.message = cannot_start_.empty() ? static_start_->why_not() : cannot_start_;
}

extern const EstimatorEntry dead_reckoning;
const EstimatorEntry dead_reckoning{.name = "dead-reckoning",
                                    .summary = "the IMU integrated from a rest; no LiDAR",
                                    .source = "strapdown integration; start as in VINS- and LIO-type systems",
                                    .needs = Needs::imu,
                                    .make = make_with<DeadReckoning, DeadReckoningOptions>,
                                    .describe = describe_with<DeadReckoningOptions>,
                                    .resolve = resolve_with<DeadReckoningOptions>};

}  // namespace tarmac::estimators
