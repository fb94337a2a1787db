#include "estimators/window_odometry/odometry.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/gp_trajectory.h"
#include "estimators/blocks/stopwatch.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::Time;
using Eigen::Vector3d;

WindowModel model_of(const WindowOdometrySettings& s, const core::Rig& rig) {
  WindowModel model;
  model.gravity_m_s2 = rig.gravity_m_s2;
  model.lidar_sigma_m = s.lidar.sigma_m;
  model.lidar_loss = {.kind = loss_named(s.lidar.loss), .scale = s.lidar.loss_scale};
  model.sum_stamp_residuals = s.lidar.sum_stamp_residuals;
  if (s.imu.gyro() && !rig.imus.empty()) set_imu(s.imu, rig, model);
  return model;
}

Marginalisation rule_named(const std::string& name) {
  if (name == "eigenvalue") return Marginalisation::eigenvalue;
  return name == "fix" ? Marginalisation::fix : Marginalisation::plain;
}

}  // namespace

WindowOdometry::WindowOdometry(const WindowOdometrySettings& settings, const core::Rig& rig)
    : settings_(settings.checked()),
      rig_(rig),
      T_body_lidar_(rig.lidars.at(0).T_body_lidar),
      model_(settings.motion, rig.gravity_m_s2),
      sampler_(settings.sampling.random_seed),
      inertial_(settings.imu, rig),
      map_(settings.map, settings.lidar) {}

void WindowOdometry::add(const core::ImuSample& sample) {
  if (!settings_.imu.gyro() || rig_.imus.empty()) return;
  inertial_.add(sample);
  core::ImuSample centred = sample;
  centred.t = sample.t - rig_.imus[0].delay;
  since_last_.push_back(centred);
}

WindowOdometry::Step WindowOdometry::add(const core::LidarSweep& sweep) {
  Step step;
  Stopwatch stopwatch(step.stages_ms);
  sampler_.thin_out(sweep, {settings_.sampling.min_range_m, settings_.sampling.max_range_m,
                            startup() ? settings_.sampling.startup_sample_cell_m : settings_.sampling.sample_cell_m});
  sampler_.choose_keypoints(startup() ? settings_.sampling.startup_keypoint_cell_m
                                      : settings_.sampling.keypoint_cell_m);
  keypoints_ = timed_points(sweep, sampler_.keypoints(), T_body_lidar_);
  most_keypoints_ = std::max(most_keypoints_, keypoints_.size());
  matches_.clear();
  stopwatch.lap("sampling");
  if (!window_ && !can_start(sweep)) {
    since_last_.clear();
    return step;
  }
  step.started = true;
  step.first = !window_;
  if (step.first) start(sweep);
  grow(sweep);
  predict();
  stopwatch.lap("prediction");
  if (!step.first) register_sweep(sweep, step);
  stopwatch.lap("icp");
  step.motion = window_->trajectory().segment(sweep.begin, sweep.end);
  step.T_map_body_end = window_->trajectory().pose(sweep.end);
  step.clipped_stamps = keypoints_.clipped;
  if (!step.lost) past_.back().sample = timed_points(sweep, sampler_.sample(), T_body_lidar_);
  // A lost sweep's place is a guess: nothing is dropped from the map about it, and it does not enter.
  if (!step.lost) map_.remove_far(step.T_map_body_end.translation());
  update_map();
  stopwatch.lap("map");
  ++sweeps_;
  return step;
}

/// The first sweep starts the map: with fewer points than a registration asks for, or over before a process could have
/// two knots, it is left to the next.
bool WindowOdometry::can_start(const core::LidarSweep& sweep) const {
  return inertial_.ready(sweep.begin) && sweep.end - sweep.begin >= core::kGpMinimumSpacing &&
         keypoints_.size() >= static_cast<std::size_t>(settings_.solver.min_residuals);
}

std::string WindowOdometry::why_not() const {
  if (const std::string why = inertial_.why_not(); !why.empty()) return why;
  return fmt::format(
      "no sweep had what a start needs: {} keypoints (solver.min_residuals; the most were {}) and a "
      "duration of a millisecond",
      settings_.solver.min_residuals, most_keypoints_);
}

void WindowOdometry::start(const core::LidarSweep& sweep) {
  WindowState state;
  period_ = sweep.end - sweep.begin;
  state.trajectory = model_.at_rest(sweep.begin, inertial_.T_map_body(), period_);
  if (settings_.imu.gyro()) state.biases.push_back({sweep.begin, inertial_.biases()});
  WindowModel model = model_of(settings_, rig_);
  model_.set_prior(model);
  window_.emplace(std::move(model), std::move(state));
}

/// The start defines the map: its pose is known, its motion nearly so.
void WindowOdometry::anchor_start(Time begin) {
  core::Kinematics mean;
  mean.T_world_body = inertial_.T_map_body();
  core::StateVector sigma = core::StateVector::Zero();
  sigma.head<6>().setConstant(settings_.start_sigma_m);
  if (settings_.motion.has_velocity()) {
    sigma.segment<3>(core::state_row::velocity).setConstant(settings_.start_velocity_sigma_m_s);
    sigma.segment<3>(core::state_row::omega).setConstant(0.2 * settings_.start_velocity_sigma_m_s);
  }
  window_->add_anchor(begin, mean, sigma);
  if (!settings_.imu.gyro()) return;
  core::Vector6 bias_sigma;
  bias_sigma << Vector3d::Constant(settings_.imu.gyro_bias_sigma_rad_s),
      Vector3d::Constant(settings_.imu.accel_bias_sigma_m_s2);
  window_->add_bias_anchor(0, inertial_.biases(), bias_sigma);
}

void WindowOdometry::grow(const core::LidarSweep& sweep) {
  // From end to end where no sweep is missing between.
  if (const core::Duration step = sweep.end - last_end_; sweeps_ > 0 && 2 * step > period_ && 2 * step < 3 * period_)
    period_ = step;
  model_.extend_over(*window_, sweep.begin, sweep.end, period_, since_last_);
  since_last_.clear();
  past_.push_back({sweep.index, sweep.begin, sweep.end, {}});
  if (past_.size() > static_cast<std::size_t>(settings_.window.sweeps)) {
    past_.pop_front();
    forget_before(past_.front().begin);
  }
  if (sweeps_ == 0) {
    anchor_start(sweep.begin);
  } else {
    model_.add_ties(*window_, last_end_, sweep.begin, sweep.end);
  }
  last_end_ = sweep.end;
  if (!settings_.imu.gyro()) return;
  window_->add_bias_knot(sweep.end);
  for (const ImuReading& reading : inertial_.take_readings(past_.front().begin)) window_->add(reading);
}

void WindowOdometry::forget_before(Time t) {
  const Marginalisation rule = rule_named(settings_.window.marginalisation);
  // In steps: after a hole in the data there may be a thousand knots to eliminate, and what goes at once is dense.
  constexpr core::Duration kStep(500'000'000);
  if (!settings_.motion.is_sweepwise()) {
    for (Time step = window_->trajectory().begin() + kStep; step < t; step += kStep)
      window_->marginalise_before(step, rule, settings_.window.eigenvalue_threshold);
  }
  window_->marginalise_before(t, rule, settings_.window.eigenvalue_threshold);
}

void WindowOdometry::predict() {
  if (!settings_.imu.gyro()) return;
  SolveSettings solve;
  solve.max_iterations = 3;
  solve.lidar = sweeps_ > 0;  // the sweeps before keep theirs; this one has none yet
  window_->solve(solve);
}

int WindowOdometry::match_keypoints() {
  place(keypoints_, window_->trajectory(), T_map_body_, p_map_);
  sensor_map_.resize(keypoints_.size());
  for (std::size_t k = 0; k < keypoints_.size(); ++k)
    sensor_map_[k] = T_map_body_[keypoints_.stamp[k]] * T_body_lidar_.translation();
  return map_.match(keypoints_.p_body, p_map_, sensor_map_, startup(), matches_);
}

bool WindowOdometry::has_settled(const SweepEnds& before, const SweepEnds& now) const {
  const auto moved_m = [](const SE3& a, const SE3& b) { return (a.translation() - b.translation()).norm(); };
  const auto turned_rad = [](const SE3& a, const SE3& b) {
    return core::so3::angle_rad(a.linear().transpose() * b.linear());
  };
  const SolverSettings& s = settings_.solver;
  return s.stop_early && moved_m(before.begin, now.begin) + moved_m(before.end, now.end) < s.convergence_m &&
         turned_rad(before.begin, now.begin) + turned_rad(before.end, now.end) < s.convergence_deg * kRadPerDeg;
}

void WindowOdometry::register_sweep(const core::LidarSweep& sweep, Step& step) {
  const SolverSettings& settings = settings_.solver;
  const int allowed = startup() ? settings.startup_associations : settings.associations;
  const bool distributions = settings_.lidar.residual == "point-to-distribution";
  const WindowState predicted = window_->state();
  const auto ends = [&] {
    return SweepEnds{window_->trajectory().pose(sweep.begin), window_->trajectory().pose(sweep.end)};
  };
  SweepEnds before = ends();
  while (step.associations < allowed && !step.converged && !step.lost) {
    step.residuals = match_keypoints();
    step.lost = step.residuals < settings.min_residuals;
    if (step.lost) break;
    window_->set_lidar(sweep.index, lidar_factors(keypoints_, matches_, distributions));
    SolveSettings solve;
    solve.levenberg_marquardt = settings.levenberg_marquardt;
    solve.max_iterations = settings.iterations;
    solve.line_search = settings.line_search_from >= 0 && step.associations >= settings.line_search_from;
    const SolveReport report = window_->solve(solve);
    ++step.associations;
    step.solver_steps += report.iterations;
    step.lost = !report.ok;
    const SweepEnds now = ends();
    step.converged = has_settled(before, now);
    before = now;
  }
  if (!step.lost) return;
  window_->set_lidar(sweep.index, {});
  window_->state() = predicted;
}

core::Matrix6 WindowOdometry::prior_information(const core::LidarSweep& sweep) const {
  Window without = *window_;
  without.set_lidar(sweep.index, {});
  const Eigen::MatrixXd covariance = without.covariance(sweep.end, core::Derivative::pose);
  if (covariance.rows() != 6) return core::Matrix6::Zero();
  const Eigen::LDLT<core::Matrix6> ldlt(covariance);
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return core::Matrix6::Zero();
  return ldlt.solve(core::Matrix6::Identity());
}

void WindowOdometry::update_map() {
  // The first sweep starts the map at once.
  const std::size_t delay = sweeps_ == 0 ? 0 : static_cast<std::size_t>(settings_.map.delay_sweeps);
  for (std::size_t i = 0; i + delay < past_.size(); ++i) {
    TimedPoints& sample = past_[i].sample;
    if (sample.size() == 0) continue;
    place(sample, window_->trajectory(), T_map_body_, p_map_);
    map_.add(p_map_);
    sample = {};
  }
}

}  // namespace tarmac::estimators
