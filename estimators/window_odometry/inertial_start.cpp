#include "estimators/window_odometry/inertial_start.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "estimators/dead_reckoning/sample_chain.h"

namespace tarmac::estimators {

using core::Time;

void set_imu(const ImuSettings& settings, const core::Rig& rig, WindowModel& model) {
  model.T_body_imu = rig.imus.at(0).T_body_imu;
  model.gravity_m_s2 = rig.gravity_m_s2;
  model.gyro_sigma_rad_s = settings.gyro_sigma_rad_s;
  model.accel_sigma_m_s2 = settings.accel() ? settings.accel_sigma_m_s2 : 0;
  model.accel_as_increments = settings.accel_as_increments;
  model.accel_loss = {.kind = loss_named(settings.accel_loss), .scale = settings.accel_loss_scale};
  model.omit_transport = settings.omit_transport;
  model.gyro_walk_rad_s2_rthz = settings.gyro_walk_rad_s2_rthz;
  model.accel_walk_m_s3_rthz = settings.accel_walk_m_s3_rthz;
  model.free_gravity = settings.free_gravity;
  model.gravity_sigma_rad = settings.gravity_sigma_deg * kRadPerDeg;
  model.free_imu_offset = settings.free_time_offset;
  model.imu_offset_sigma_s = settings.time_offset_sigma_s;
}

std::string offset_message(const Window& window) {
  const int column = window.offset_column();
  if (column < 0) return {};
  const Eigen::MatrixXd covariance = window.border_covariance();
  const double sigma_s =
      covariance.rows() > column ? std::sqrt(covariance(column, column)) : std::numeric_limits<double>::infinity();
  const double prior_s = window.model().imu_offset_sigma_s;
  if (prior_s > 0 && sigma_s > prior_s / 2)
    return fmt::format("IMU time offset unobservable: standard deviation {:.4f} ms after {:.4f} ms before any data",
                       1e3 * sigma_s, 1e3 * prior_s);
  return fmt::format("IMU time offset {:.4f} ms, standard deviation {:.4f} ms", 1e3 * window.state().imu_offset_s,
                     1e3 * sigma_s);
}

InertialStart::InertialStart(const ImuSettings& settings, const core::Rig& rig) : in_use_(settings.gyro()) {
  if (!in_use_) return;
  cannot_start_ = no_usable_imu(rig);
  if (!cannot_start_.empty()) return;
  sheet_ = rig.imus[0];
  static_start_.emplace(settings.rest, sheet_.T_body_imu.linear(), rig.gravity_m_s2, sheet_.rate_hz);
}

void InertialStart::add(const core::ImuSample& sample) {
  if (!static_start_) return;
  core::ImuSample centred = sample;
  centred.t = sample.t - sheet_.delay;
  if (!start_) {
    start_ = static_start_->add(centred);
    started_at_ = centred.t;
  }
  readings_.push_back({centred.t, centred.gyro_rad_s, centred.accel_m_s2});
  // Before the start only the last few matter: those of the sweep that the start falls into.
  while (!start_ && !readings_.empty() && readings_.back().t - readings_.front().t > core::Duration(500'000'000))
    readings_.pop_front();
}

bool InertialStart::ready(Time t) const {
  return !in_use_ || (start_ && started_at_ <= t);
}

std::string InertialStart::why_not() const {
  if (!cannot_start_.empty()) return cannot_start_;
  return static_start_ && !start_ ? static_start_->why_not() : std::string();
}

core::SE3 InertialStart::T_map_body() const {
  core::SE3 T = core::SE3::Identity();
  if (start_) T.linear() = start_->R_map_imu * sheet_.T_body_imu.linear().transpose();
  return T;
}

core::Vector6 InertialStart::biases() const {
  core::Vector6 biases = core::Vector6::Zero();
  if (start_) biases << start_->gyro_bias_rad_s, start_->accel_bias_m_s2;
  return biases;
}

std::vector<ImuReading> InertialStart::take_readings(Time from) {
  std::vector<ImuReading> taken;
  for (const ImuReading& reading : readings_)
    if (reading.t >= from) taken.push_back(reading);
  readings_.clear();
  return taken;
}

}  // namespace tarmac::estimators
