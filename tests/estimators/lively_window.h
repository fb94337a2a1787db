/// Windows over the project's own trajectories, moving about in all directions.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/gp_trajectory.h"
#include "core/random.h"
#include "core/spline_trajectory.h"
#include "estimators/window/window.h"

namespace tarmac::estimators {

enum class Lively { spline_split, spline_se3, spline_split_6, gp_wnoa, gp_wnoj, gp_singer };

inline void PrintTo(Lively model, std::ostream* out) {
  const char* names[] = {"spline_split", "spline_se3", "spline_split_6", "gp_wnoa", "gp_wnoj", "gp_singer"};
  *out << names[static_cast<int>(model)];
}

inline const core::Time kLivelyBegin = core::time_from_ns(1'700'000'000'000'000'123);

/// About 1 m/s and 1 rad/s, changing all the time; 0.1 s between knots. Processes have the splines' kinds of motion at
/// their knots, so that their priors are not taken by surprise.
inline std::unique_ptr<core::ParametricTrajectory> lively(Lively model, int knots, std::uint64_t seed) {
  const core::RandomStream stream(seed, "test/lively");
  const auto vector = [&](int i, std::uint32_t j) {
    const auto k = static_cast<std::uint64_t>(i);
    return Eigen::Vector3d(stream.normal(k, 3 * j), stream.normal(k, 3 * j + 1), stream.normal(k, 3 * j + 2));
  };
  const core::Duration spacing = std::chrono::milliseconds(100);
  const bool process = model >= Lively::gp_wnoa;
  const bool split = model == Lively::spline_split || model == Lively::spline_split_6;
  const int order = model == Lively::spline_split_6 ? 6
                    : split                         ? 4
                                                    : 5,
            control_points = process ? knots + order : knots;
  const core::Vector6 mean = (core::Vector6() << 0.1, 0, 0, 0, 0, 0.05).finished();
  core::SE3 T = core::SE3::Identity();
  T.translation() = Eigen::Vector3d(3, -2, 1);
  std::vector<core::SE3> poses;
  std::vector<core::Time> times;  // the span begins at kLivelyBegin
  for (int i = 0; i < control_points + order; ++i) times.push_back(kLivelyBegin + (i - order + 1) * spacing);
  for (int i = 0; i < control_points; ++i) {
    poses.push_back(T);
    core::Vector6 step = mean;
    step.head<3>() += 0.03 * vector(i, 0);
    step.tail<3>() += 0.06 * vector(i, 1);
    T = core::se3::normalized(T * core::se3::exp(step));
  }
  auto spline = std::make_unique<core::SplineTrajectory>(split ? core::SplineKind::split : core::SplineKind::se3, order,
                                                         poses, times);
  if (!process) return spline;
  std::vector<core::GpKnot> gp_knots;
  for (int i = 0; i < knots; ++i) {
    const core::Time t = kLivelyBegin + i * spacing;
    gp_knots.push_back(core::gp_knot(t, spline->at(t)));
  }
  core::GpPrior prior;
  const auto which = static_cast<std::size_t>(model) - static_cast<std::size_t>(Lively::gp_wnoa);
  prior.model = std::array{core::GpModel::wnoa, core::GpModel::wnoj, core::GpModel::singer}[which];
  prior.qc.setConstant(std::array{5.0, 1000.0, 1e5}[which]);
  if (model == Lively::gp_singer) prior.rate.setConstant(10);
  return std::make_unique<core::GpTrajectory>(prior, gp_knots);
}

/// The IMU turned and away from the body's origin.
inline core::SE3 lively_mounting() {
  core::Vector6 xi;
  xi << 0.4, -0.2, 0.3, 0.2, -0.5, 1.0;
  return core::se3::exp(xi);
}

/// What an ideal IMU reads of a motion, stamped with an offset: it holds at stamp - offset.
inline ImuReading ideal_reading(const core::SmoothTrajectory& truth, core::Time stamp, double offset_s,
                                const core::SE3& T_body_imu, const Eigen::Vector3d& gravity_m_s2,
                                const core::Vector6& bias) {
  const core::Kinematics k = truth.at(stamp - core::duration_from_s(offset_s));
  const Eigen::Vector3d &w = k.omega_body, &lever = T_body_imu.translation();
  const Eigen::Vector3d f = k.T_world_body.linear().transpose() * (k.a_world - gravity_m_s2) +
                            k.alpha_body.cross(lever) + w.cross(w.cross(lever));
  ImuReading reading;
  reading.t = stamp;
  reading.gyro_rad_s = T_body_imu.linear().transpose() * w + bias.head<3>();
  reading.accel_m_s2 = T_body_imu.linear().transpose() * f + bias.tail<3>();
  return reading;
}

/// Points on planes all around, seen exactly from a motion, then moved along the normal by noise.
inline LidarFactors lively_factors(const core::Trajectory& truth, core::Time begin, core::Time end, int stamps,
                                   int points, double noise_m, bool distributions, std::uint64_t seed) {
  const core::RandomStream stream(seed, "test/factors");
  LidarFactors factors;
  factors.distributions = distributions;
  std::uint64_t draw = 0;
  const auto vector = [&](std::uint32_t j) {
    return Eigen::Vector3d(stream.normal(draw, 3 * j), stream.normal(draw, 3 * j + 1), stream.normal(draw, 3 * j + 2));
  };
  for (int i = 0; i < stamps; ++i) {
    const core::Time t = begin + (end - begin) * i / stamps;
    factors.stamps.push_back(t);
    for (int k = 0; k < points; ++k, ++draw) {
      LidarFactor f;
      f.p_body = 4 * vector(0);
      f.n_map = vector(1).normalized();
      f.q_map = truth.pose(t) * f.p_body + noise_m * stream.normal(draw, 30) * f.n_map;
      f.weight = 0.5 + stream.uniform(draw, 31);
      f.sqrt_information << 1, 0.2, 0.1, 0, 0.8, -0.3, 0, 0, 2;
      factors.factors.push_back(f);
    }
    factors.first.push_back(static_cast<std::uint32_t>(factors.factors.size()));
  }
  return factors;
}

}  // namespace tarmac::estimators
