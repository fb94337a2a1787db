#include "estimators/dead_reckoning/static_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/lie.h"

namespace tarmac::estimators {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {
constexpr double kMaxHolePeriods = 4;  ///< a longer hole in the samples hides what happened in it
}

StaticStart::StaticStart(const RestOptions& options, const Matrix3d& R_body_imu, double gravity_m_s2, double rate_hz)
    : options_(options),
      R_body_imu_(R_body_imu),
      gravity_m_s2_(gravity_m_s2),
      period_s_(1 / rate_hz),
      least_spread_m_s2_(std::numeric_limits<double>::infinity()) {}

std::optional<StaticStart::Result> StaticStart::add(const core::ImuSample& sample) {
  if (!first_) first_ = sample.t;
  // Each sample stands for one period, the first one's included. Half a period absorbs the rounding of stamps.
  const double elapsed_s = core::to_s(sample.t - *first_) + period_s_;
  gave_up_ = gave_up_ || elapsed_s > std::max(options_.rest_within_s, options_.rest_window_s) + 0.5 * period_s_;
  if (gave_up_) return std::nullopt;

  if (!window_.empty() && core::to_s(sample.t - window_.back().t) > kMaxHolePeriods * period_s_) window_.clear();
  window_.push_back(sample);
  const auto span_s = [&] { return core::to_s(window_.back().t - window_.front().t) + period_s_; };
  if (span_s() < options_.rest_window_s - 0.5 * period_s_) return std::nullopt;
  while (span_s() > options_.rest_window_s + 0.5 * period_s_) window_.pop_front();
  return evaluate();
}

std::optional<StaticStart::Result> StaticStart::evaluate() {
  const auto n = static_cast<double>(window_.size());
  Vector3d gyro = Vector3d::Zero(), accel = Vector3d::Zero();
  for (const core::ImuSample& s : window_) {
    gyro += s.gyro_rad_s / n;
    accel += s.accel_m_s2 / n;
  }
  double variance = 0;
  for (const core::ImuSample& s : window_) variance += (s.accel_m_s2 - accel).squaredNorm() / n;
  const double spread = std::sqrt(variance);
  least_spread_m_s2_ = std::min(least_spread_m_s2_, spread);
  if (spread > options_.rest_accel_spread_m_s2 || gyro.norm() > options_.rest_gyro_rad_s || !(accel.norm() > 0)) {
    return std::nullopt;
  }
  // Rows of R_map_body are the map's axes in the body: z along the specific force, x the body's x, made level.
  const Vector3d up = (R_body_imu_ * accel).normalized();
  // A rig mounted nose up has no level x: its z axis then gives the heading.
  const Vector3d ahead = std::abs(up.x()) < 0.99 ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d x = (ahead - ahead.dot(up) * up).normalized();
  Matrix3d R_map_body;
  R_map_body << x.transpose(), up.cross(x).transpose(), up.transpose();
  return Result{.R_map_imu = R_map_body * R_body_imu_,
                .gyro_bias_rad_s = gyro,
                .accel_bias_m_s2 = accel * (1 - gravity_m_s2_ / accel.norm())};
}

std::string StaticStart::why_not() const {
  if (!std::isfinite(least_spread_m_s2_)) {
    return fmt::format("no {} s of IMU samples without a hole in the first {} s", options_.rest_window_s,
                       options_.rest_within_s);
  }
  return fmt::format(
      "no rest in the first {} s: the calmest {} s of specific force spread {:.3g} m/s^2 (at most {} is rest), or the "
      "rig turned faster than {} rad/s",
      options_.rest_within_s, options_.rest_window_s, least_spread_m_s2_, options_.rest_accel_spread_m_s2,
      options_.rest_gyro_rad_s);
}

}  // namespace tarmac::estimators
