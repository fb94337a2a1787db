#include "estimators/kiss_icp_imu/kiss_icp_imu.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimators/kiss_icp/kiss_icp.h"
#include "estimators/kiss_icp/record.h"

namespace tarmac::estimators {

using core::SE3;
using core::Time;
using Eigen::Vector3d;

KissIcpImu::KissIcpImu(const KissIcpImuOptions& options, const EstimatorContext& context)
    : options_(options),
      odometry_(checked(kiss_options(options, true))),
      level_(context.diagnostics),
      T_body_lidar_(context.rig.lidars.at(0).T_body_lidar),
      gravity_m_s2_(context.rig.gravity_m_s2),
      arena_(std::max(1, context.threads)),
      cannot_start_(no_usable_imu(context.rig)) {
  if (level_ == core::DiagnosticsLevel::full) odometry_.look_for_surfaces();
  if (!cannot_start_.empty()) return;
  sheet_ = context.rig.imus[0];
  static_start_.emplace(options.rest, sheet_.T_body_imu.linear(), gravity_m_s2_, sheet_.rate_hz);
}

void KissIcpImu::add(const core::ImuSample& sample) {
  if (!static_start_) return;
  if (path_) {
    path_->add(sample);
    return;
  }
  core::ImuSample centred = sample;
  centred.t = sample.t - sheet_.delay;
  const std::optional<StaticStart::Result> start = static_start_->add(centred);
  if (!start) return;
  const Time end = centred.t + core::duration_from_s(0.5 / sheet_.rate_hz);
  path_.emplace(sheet_, gravity_m_s2_, options_.max_gap_periods, *start, options_.rest.rest_window_s, end);
}

SweepOutcome KissIcpImu::add(const core::LidarSweep& sweep) {
  if (path_ && path_->state().t <= sweep.begin) return register_sweep(sweep, !odometry_.map().empty());
  return initialising_outcome(sweep);
}

SweepOutcome KissIcpImu::register_sweep(const core::LidarSweep& sweep, bool has_map) {
  // Stamps beyond the sweep's span are the sensor's fault. They are followed for up to another span.
  const core::Duration span = sweep.end - sweep.begin;
  core::Duration latest = span;
  for (const std::int32_t t_ns : sweep.t_ns) latest = std::max(latest, core::Duration(t_ns));
  const InertialPath::Path path = path_->over(sweep.begin, sweep.begin + std::min(latest, 2 * span));
  const SweepMotion motion(sweep, path.T_map_body, T_body_lidar_);
  const SE3 T_predicted = motion.path_pose(motion.last_ns()) * T_body_lidar_;

  KissOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep, motion, T_predicted); });
  SweepOutcome outcome = outcome_of(sweep, odometry_, std::move(step), T_body_lidar_.inverse(), level_);
  if (outcome.result.status == core::SweepStatus::ok) {
    correct(path_->state_at(outcome.result.reference), outcome.result.T_map_body, has_map);
  } else {
    path_->correct(path_->state_at(outcome.result.reference), Vector3d::Zero());
  }
  if (path.coasted_s > 0)
    outcome.note = fmt::format("{:.3f} s without IMU samples, crossed at constant velocity", path.coasted_s);
  return outcome;
}

void KissIcpImu::correct(const InertialState& predicted, const SE3& T_map_body, bool has_map) {
  const InertialState& before = path_->state();
  const SE3 T_map_imu = T_map_body * sheet_.T_body_imu;
  const double dt = core::to_s(predicted.t - before.t);
  InertialState state = predicted;
  state.R_map_imu = T_map_imu.linear();
  state.p_map_m = T_map_imu.translation();
  Vector3d omega_rad_s = Vector3d::Zero();
  if (has_map && dt > 0) {
    state.v_map_m_s += options_.velocity_gain / dt * (state.p_map_m - predicted.p_map_m);
    omega_rad_s = core::so3::log(before.R_map_imu.transpose() * state.R_map_imu) / dt;
  }
  path_->correct(state, omega_rad_s);
}

void KissIcpImu::finish(core::Estimate& estimate) {
  estimate.gravity_aligned = true;
  if (path_) return;
  estimate.status = core::RunStatus::not_initialised;
  estimate.message = cannot_start_.empty() ? static_start_->why_not() : cannot_start_;
}

extern const EstimatorEntry kiss_icp_imu;
const EstimatorEntry kiss_icp_imu{
    .name = "kiss-icp-imu",
    .summary = "kiss-icp, deskewed and predicted by the IMU",
    .source = "Vizzo et al., KISS-ICP, RA-L 8(2) 2023; strapdown integration and a fixed-gain velocity correction",
    .needs = Needs::lidar_and_imu,
    .make = make_with<KissIcpImu, KissIcpImuOptions>,
    .describe = describe_with<KissIcpImuOptions>,
    .resolve = resolve_with<KissIcpImuOptions>};

}  // namespace tarmac::estimators
