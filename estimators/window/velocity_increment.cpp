#include "estimators/window/velocity_increment.h"

#include <algorithm>

namespace tarmac::estimators {

using core::so3::hat;
using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<IncrementSample> increment_samples(const std::vector<ImuReading>& readings, double offset_s, core::Time t1,
                                               core::Time t2, core::Duration reach) {
  const core::Duration offset = core::duration_from_s(offset_s);
  const auto time = [&](std::size_t i) { return readings[i].t - offset; };
  const auto begin = std::lower_bound(readings.begin(), readings.end(), t1 + offset,
                                      [](const ImuReading& r, core::Time t) { return r.t < t; });
  auto i = static_cast<std::size_t>(begin - readings.begin());
  if (i > 0) --i;  // the one before may own the stretch's first part
  std::vector<IncrementSample> samples;
  for (; i < readings.size(); ++i) {
    // Middles in seconds from t1, so that nothing is rounded as the offset moves.
    const double here = core::to_s(readings[i].t - t1) - offset_s;
    const bool has_before = i > 0 && time(i) - time(i - 1) <= 2 * reach;
    const bool has_after = i + 1 < readings.size() && time(i + 1) - time(i) <= 2 * reach;
    const double low = has_before ? here - core::to_s(readings[i].t - readings[i - 1].t) / 2 : here - core::to_s(reach);
    const double high = has_after ? here + core::to_s(readings[i + 1].t - readings[i].t) / 2 : here + core::to_s(reach);
    const double length = core::to_s(t2 - t1);
    if (low >= length) break;
    if (high <= 0) continue;
    IncrementSample sample;
    sample.at = std::clamp(time(i), t1, t2);
    sample.kept_at_end = sample.at != time(i);
    sample.accel_m_s2 = readings[i].accel_m_s2;
    sample.dt_s = std::min(high, length) - std::max(low, 0.0);
    sample.dt_by_offset = (high < length ? -1.0 : 0.0) + (low > 0 ? 1.0 : 0.0);
    samples.push_back(sample);
  }
  double covered = 0;
  for (const IncrementSample& sample : samples) covered += sample.dt_s;
  if (covered < core::to_s(t2 - t1) * (1 - 1e-9)) samples.clear();
  return samples;
}

Vector3d VelocityIncrement::velocity(const core::Kinematics& state, StateJacobian<3>& J) const {
  namespace row = core::state_row;
  const Matrix3d R = state.T_world_body.linear();
  const Vector3d& lever = T_body_imu.translation();
  const Vector3d turning = state.omega_body.cross(lever);
  J.setZero();
  if (omit_transport) {
    const Vector3d nu = R.transpose() * state.v_world;
    J.middleCols<3>(row::pose + 3) = hat(nu);
    J.middleCols<3>(row::velocity) = R.transpose();
    J.middleCols<3>(row::omega) = -hat(lever);
    return nu + turning;
  }
  J.middleCols<3>(row::pose + 3) = -R * hat(turning);
  J.middleCols<3>(row::velocity).setIdentity();
  J.middleCols<3>(row::omega) = -R * hat(lever);
  return state.v_world + R * turning;
}

VelocityIncrement::Rate VelocityIncrement::rate(const core::Kinematics& state, const Vector3d& f,
                                                const Vector3d& bias) const {
  const Matrix3d R = state.T_world_body.linear();
  const Vector3d f_body = T_body_imu.linear() * (f - bias);
  if (omit_transport) {
    const Vector3d gravity_body = R.transpose() * gravity_map_m_s2;
    return {f_body + gravity_body, hat(gravity_body), -T_body_imu.linear(), R.transpose()};
  }
  return {R * f_body + gravity_map_m_s2, -R * hat(f_body), -R * T_body_imu.linear(), Matrix3d::Identity()};
}

}  // namespace tarmac::estimators
