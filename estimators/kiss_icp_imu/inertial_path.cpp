#include "estimators/kiss_icp_imu/inertial_path.h"

#include <algorithm>

namespace tarmac::estimators {

using core::SE3;
using core::Time;
using Eigen::Vector3d;

namespace {

ImuSpan at_rest(const StaticStart::Result& start, double gravity_m_s2, Time begin, Time end) {
  const Vector3d up = start.R_map_imu.transpose() * Vector3d(0, 0, gravity_m_s2);
  return {begin, end, start.gyro_bias_rad_s, up + start.accel_bias_m_s2, false};
}

/// Constant velocity and rate of turn.
InertialState coast(const InertialState& from, const Vector3d& omega_rad_s, Time to) {
  const double dt = core::to_s(to - from.t);
  InertialState state = from;
  state.t = to;
  state.R_map_imu = from.R_map_imu * core::so3::exp(omega_rad_s * dt);
  state.p_map_m = from.p_map_m + dt * from.v_map_m_s;
  return state;
}

}  // namespace

InertialPath::InertialPath(const core::ImuSheet& sheet, double gravity_m_s2, double max_gap_periods,
                           const StaticStart::Result& start, double rest_s, Time end)
    : T_imu_body_(sheet.T_body_imu.inverse()),
      gravity_m_s2_(gravity_m_s2),
      start_(start),
      chain_(sheet, max_gap_periods, at_rest(start, gravity_m_s2, end - core::duration_from_s(rest_s), end)),
      spans_{at_rest(start, gravity_m_s2, end - core::duration_from_s(rest_s), end)} {
  state_.t = spans_.front().begin;
  state_.R_map_imu = start.R_map_imu;
  state_.p_map_m = start.R_map_imu * sheet.T_body_imu.linear().transpose() * sheet.T_body_imu.translation();
}

void InertialPath::add(const core::ImuSample& sample) {
  for (const ImuSpan& span : chain_.add(sample)) spans_.push_back(span);
}

InertialState InertialPath::step(const InertialState& from, const ImuSpan& span, Time to) const {
  if (span.hole) return coast(from, omega_rad_s_, to);
  return propagate(from, span.gyro_rad_s - start_.gyro_bias_rad_s, span.accel_m_s2 - start_.accel_bias_m_s2,
                   gravity_m_s2_, to);
}

template <class Visit>
InertialState InertialPath::walk(Time end, const Visit& visit) const {
  InertialState state = state_;
  const auto go = [&](const ImuSpan& span, Time to) {
    if (to <= state.t) return;
    visit(state, span, to);
    state = step(state, span, to);
  };
  for (const ImuSpan& span : spans_) go(span, std::min(span.end, end));
  // Samples arrive later than what they stand for: the last one is taken to go on, for as long as none is overdue.
  ImuSpan rest = spans_.back();
  go(rest, std::min(end, rest.end + chain_.patience()));
  rest.hole = true;
  go(rest, end);
  return state;
}

InertialState InertialPath::state_at(Time t) const {
  return walk(t, [](const InertialState&, const ImuSpan&, Time) {});
}

InertialPath::Path InertialPath::over(Time begin, Time end) const {
  std::vector<Time> times;
  std::vector<SE3> poses;
  const auto node = [&](const InertialState& state) {
    times.push_back(state.t);
    poses.push_back(state.T_map_imu() * T_imu_body_);
  };
  double coasted_s = 0;
  const InertialState last = walk(end, [&](const InertialState& from, const ImuSpan& span, Time to) {
    if (to <= begin) return;
    node(from.t < begin ? step(from, span, begin) : from);
    if (span.hole) coasted_s += core::to_s(to - times.back());
  });
  node(last);
  return {core::Segment::sampled(core::SegmentModel::sampled_slerp, std::move(times), std::move(poses)), coasted_s};
}

void InertialPath::correct(const InertialState& state, const Vector3d& omega_rad_s) {
  state_ = state;
  omega_rad_s_ = omega_rad_s;
  while (spans_.size() > 1 && spans_.front().end <= state.t) spans_.pop_front();
}

}  // namespace tarmac::estimators
