/// A drive through the furnished room with an IMU: sweeps and samples of one smooth motion.
#pragma once

#include <vector>

#include "core/rig.h"
#include "tests/estimators/room_world.h"

namespace tarmac::tests {

/// At rest for 1.5 s, then sway, surge and turns that change within every sweep, smooth from the first moment on.
inline core::SE3 room_motion(double t_s, double strength = 1) {
  const double u = std::max(0.0, t_s - 1.5);
  const double in = u * u * u * u / (0.02 + u * u * u * u);
  core::SE3 T = core::SE3::Identity();
  T.linear() = core::so3::exp(
      strength * in * Eigen::Vector3d(0.05 * std::sin(9 * u), 0.06 * std::sin(7 * u + 1), 0.5 * std::sin(2.4 * u)));
  T.translation() =
      strength * in * Eigen::Vector3d(1.1 * std::sin(2.1 * u), 0.7 * std::sin(1.3 * u), 0.05 * std::sin(8 * u));
  return T;
}

inline core::Rig room_rig() {
  core::Rig rig;
  rig.lidars.resize(1);
  rig.lidars[0].model = "test";
  rig.lidars[0].T_body_lidar.translation() << 0.3, -0.1, 0.4;
  rig.imus.resize(1);
  rig.imus[0].model = "test";
  rig.imus[0].rate_hz = 200;
  rig.imus[0].delay = core::duration_from_s(0.0025);
  rig.imus[0].T_body_imu.translation() << -0.2, 0.1, 0.1;
  rig.imus[0].T_body_imu.linear() = core::so3::exp({0.1, -0.2, 0.4});
  return rig;
}

/// Means over 5 ms, stamped at their end, by a clock that is `offset_s` ahead.
inline std::vector<core::ImuSample> room_imu(const core::Rig& rig, const Motion& T_world_body, double seconds,
                                             double offset_s = 0) {
  std::vector<core::ImuSample> samples;
  const core::SE3 T_body_imu = rig.imus[0].T_body_imu;
  const double h = 1e-4;
  const auto position = [&](double t) -> Eigen::Vector3d { return (T_world_body(t) * T_body_imu).translation(); };
  const auto velocity = [&](double t) -> Eigen::Vector3d { return (position(t + h) - position(t - h)) / (2 * h); };
  for (int k = 1; k <= static_cast<int>(seconds * 200); ++k) {
    const double t1 = 0.005 * k - offset_s, t0 = t1 - 0.005;
    const core::SE3 middle = T_world_body(0.5 * (t0 + t1)) * T_body_imu;
    core::ImuSample& sample = samples.emplace_back();
    sample.t = core::time_from_ns(std::int64_t{k} * 5'000'000);
    sample.gyro_rad_s =
        core::so3::log(((T_world_body(t0) * T_body_imu).inverse() * (T_world_body(t1) * T_body_imu)).linear()) / 0.005;
    sample.accel_m_s2 =
        middle.linear().transpose() * ((velocity(t1) - velocity(t0)) / 0.005 + Eigen::Vector3d(0, 0, rig.gravity_m_s2));
  }
  return samples;
}

}  // namespace tarmac::tests
