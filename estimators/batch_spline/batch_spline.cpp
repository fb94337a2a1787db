#include "estimators/batch_spline/batch_spline.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/knots.h"
#include "core/shortest_turn.h"
#include "core/spline_fit.h"
#include "estimators/dead_reckoning/sample_chain.h"
#include "estimators/window/ceres_window.h"

namespace tarmac::estimators {
namespace {

using core::SE3;
using core::Time;
using Eigen::Vector3d;

bool wants_imu(const BatchSplineOptions& options, const core::Rig& rig) {
  return options.imu.use == "auto" ? no_usable_imu(rig).empty() : options.imu.use != "none";
}

/// The odometry that the batch starts from.
WindowOdometrySettings first_pass(const BatchSplineOptions& options, const core::Rig& rig) {
  ComposedOptions composed;
  std::string profile = options.odometry;
  if (profile == "auto") profile = wants_imu(options, rig) ? "spline-50ms-imu" : "spline-50ms";
  composed.set_profile(profile);
  composed.sampling = options.sampling;
  composed.imu.rest = options.imu.rest;
  if (options.imu.free_time_offset && composed.imu.gyro()) composed.imu.free_time_offset = true;
  return composed;
}

WindowModel model_of(const BatchSplineOptions& o, const core::Rig& rig, bool with_imu) {
  WindowModel model;
  model.gravity_m_s2 = rig.gravity_m_s2;
  model.lidar_sigma_m = o.lidar.sigma_m;
  model.lidar_loss = {.kind = loss_named(o.lidar.loss), .scale = o.lidar.loss_scale};
  model.smoothness_translation = o.process_translation;
  model.smoothness_rotation = o.process_rotation;
  if (!with_imu) return model;
  set_imu(o.imu, rig, model);
  if (o.imu.use != "gyro") model.accel_sigma_m_s2 = o.imu.accel_sigma_m_s2;
  return model;
}

/// The groups are shared with odometries; what only these can use is not taken in silence.
void check_effect(const BatchSplineOptions& options) {
  const BatchSplineOptions defaults;
  const auto refuse = [](const char* name) {
    throw core::InputError(
        fmt::format("{}: has no effect on the batch, whose map is made of all sweeps at once", name));
  };
  if (options.map.radius_m != defaults.map.radius_m) refuse("map.radius_m");
  if (options.map.delay_sweeps != defaults.map.delay_sweeps) refuse("map.delay_sweeps");
  if (options.lidar.startup_voxel_reach != defaults.lidar.startup_voxel_reach) refuse("lidar.startup_voxel_reach");
  if (options.lidar.sum_stamp_residuals) refuse("lidar.sum_stamp_residuals");
  if (options.imu.accel_as_increments) refuse("imu.accel_as_increments");
}

/// The motion in a map whose z axis is up: turned, about the origin and by the smallest angle, so that gravity points
/// down. A spline whose control points are moved from the left is moved as a whole.
core::SplineTrajectory levelled(const WindowState& state) {
  const auto& spline = dynamic_cast<const core::SplineTrajectory&>(*state.trajectory);
  SE3 T_level_map = SE3::Identity();
  T_level_map.linear() = core::shortest_turn(state.gravity_map, -Vector3d::UnitZ()).toRotationMatrix();
  std::vector<SE3> control_points;
  for (const SE3& T : spline.control_points()) control_points.push_back(core::se3::normalized(T_level_map * T));
  return {spline.kind(), spline.order(), std::move(control_points), spline.knots()};
}

}  // namespace

BatchSpline::BatchSpline(const BatchSplineOptions& options, const EstimatorContext& context)
    : options_(options),
      rig_(context.rig),
      with_imu_(wants_imu(options, context.rig)),
      odometry_(first_pass(options, context.rig), context.rig),
      sampler_(options.sampling.random_seed),
      arena_(std::max(1, context.threads)) {
  if (with_imu_ && !odometry_.settings().imu.gyro())
    throw core::InputError(
        fmt::format("odometry: {} uses no IMU, so that the batch has no attitude to start from; take a profile with "
                    "-imu, or imu.use none",
                    options.odometry));
  if (!with_imu_ && options.imu.free_time_offset)
    throw core::InputError("imu.free_time_offset is about an IMU, but imu.use is none or the rig has no usable one");
  check_effect(options);
  check_lidar(options.lidar, options.map);
}

void BatchSpline::add(const core::ImuSample& sample) {
  odometry_.add(sample);
  if (with_imu_) readings_.push_back({sample.t - rig_.imus[0].delay, sample.gyro_rad_s, sample.accel_m_s2});
}

SweepOutcome BatchSpline::add(const core::LidarSweep& sweep) {
  SweepOutcome outcome = initialising_outcome(sweep);
  WindowOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep); });
  if (!step.started) return outcome;
  outcome.result.status =
      sweep.empty() ? core::SweepStatus::empty : (step.lost ? core::SweepStatus::lost : core::SweepStatus::ok);
  outcome.stages_ms = std::move(step.stages_ms);
  outcome.diagnostics.iterations = step.associations;
  outcome.diagnostics.residuals = step.residuals;
  keep(sweep, step);
  return outcome;
}

void BatchSpline::keep(const core::LidarSweep& sweep, const WindowOdometry::Step& step) {
  const SamplingSettings& s = options_.sampling;
  const SE3& T_body_lidar = rig_.lidars.at(0).T_body_lidar;
  sampler_.thin_out(sweep, {s.min_range_m, s.max_range_m, s.sample_cell_m});
  sampler_.choose_keypoints(s.keypoint_cell_m);
  kept_.push_back({sweep.index, sweep.begin, sweep.end, timed_points(sweep, sampler_.keypoints(), T_body_lidar),
                   timed_points(sweep, sampler_.sample(), T_body_lidar)});
  // A lost sweep's place is a guess: its points say nothing of the map.
  if (step.lost) kept_.back().keypoints = kept_.back().sample = {};
  first_guess_.append(step.motion);
}

void BatchSpline::start_window() {
  const Time begin = kept_.front().begin, end = kept_.back().end;
  std::vector<Time> times;
  std::vector<SE3> poses;
  const core::Duration spacing = core::duration_from_s(options_.knot_spacing_s);
  for (const core::Segment& segment : first_guess_.segments()) {
    // At least two samples a knot, so that the fit is determined by them and not by its smoothness.
    for (Time t = segment.t0; t < segment.t1; t += spacing / 2) {
      times.push_back(t);
      poses.push_back(segment.pose(t));
    }
  }
  times.push_back(end);
  poses.push_back(first_guess_.pose(end));
  WindowState state;
  state.trajectory = std::make_unique<core::SplineTrajectory>(core::fit_spline(
      core::SplineKind::split, options_.order, core::uniform_knots(begin, end, spacing, options_.order), times, poses));
  if (with_imu_) {
    const core::Vector6 biases = odometry_.inertial().biases();
    const core::Duration step = core::duration_from_s(options_.bias_spacing_s);
    for (Time t = begin; t < end + step; t += step) state.biases.push_back({t, biases});
    state.imu_offset_s = options_.imu.free_time_offset ? odometry_.window().state().imu_offset_s : 0;
  }
  window_.emplace(model_of(options_, rig_, with_imu_), std::move(state));
  core::Kinematics mean;
  mean.T_world_body = window_->trajectory().pose(begin);
  core::StateVector sigma = core::StateVector::Zero();
  sigma.head<6>().setConstant(1e-4);
  window_->add_anchor(begin, mean, sigma);
  if (!with_imu_) return;
  core::Vector6 bias_sigma;
  bias_sigma << Vector3d::Constant(options_.imu.gyro_bias_sigma_rad_s),
      Vector3d::Constant(options_.imu.accel_bias_sigma_m_s2);
  window_->add_bias_anchor(0, window_->state().biases.front().gyro_accel, bias_sigma);
  for (const ImuReading& reading : readings_)
    if (reading.t >= begin && reading.t <= end) window_->add(reading);
}

void BatchSpline::match_all(const SurfaceMap& map) {
  std::vector<SE3> T_map_body;
  std::vector<Vector3d> p_map, sensor_map;
  const Vector3d p_body_lidar = rig_.lidars.at(0).T_body_lidar.translation();
  const bool distributions = options_.lidar.residual == "point-to-distribution";
  for (const Kept& sweep : kept_) {
    place(sweep.keypoints, window_->trajectory(), T_map_body, p_map);
    sensor_map.resize(p_map.size());
    for (std::size_t k = 0; k < p_map.size(); ++k) sensor_map[k] = T_map_body[sweep.keypoints.stamp[k]] * p_body_lidar;
    std::vector<SurfaceMatch> matches;
    map.match(sweep.keypoints.p_body, p_map, sensor_map, false, matches);
    window_->set_lidar(sweep.index, lidar_factors(sweep.keypoints, matches, distributions));
  }
}

double BatchSpline::solve_round() {
  ++rounds_;
  SurfaceMap map(options_.map, options_.lidar);
  std::vector<SE3> T_map_body, ends;
  std::vector<Vector3d> p_map;
  for (const Kept& sweep : kept_) {
    place(sweep.sample, window_->trajectory(), T_map_body, p_map);
    map.add(p_map);
    ends.push_back(window_->trajectory().pose(sweep.end));
  }
  match_all(map);
  SolveSettings settings;
  settings.levenberg_marquardt = true;
  settings.max_iterations = options_.solver_iterations;
  const SolveReport report = options_.solver == "ceres"
                                 ? solve_with_ceres(*window_, {.max_iterations = options_.solver_iterations})
                                 : window_->solve(settings);
  if (!report.ok)
    throw std::runtime_error("the batch's normal equations are singular: too little data for its unknowns");
  double moved_m = 0;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const SE3 end = window_->trajectory().pose(kept_[k].end);
    moved_m = std::max(moved_m, (end.translation() - ends[k].translation()).norm());
  }
  return moved_m;
}

void BatchSpline::finish(core::Estimate& estimate) {
  estimate.has_causal = false;
  estimate.gravity_aligned = with_imu_;  // levelled()
  if (kept_.empty()) {
    estimate.status = core::RunStatus::not_initialised;
    estimate.message = odometry_.why_not();
    return;
  }
  arena_.execute([&] {
    start_window();
    while (rounds_ < options_.rounds && solve_round() > options_.convergence_m) {
    }
  });
  estimate.has_final = true;
  estimate.message = arena_.execute([&] { return offset_message(*window_); });
  const core::SplineTrajectory trajectory = levelled(window_->state());
  for (const Kept& sweep : kept_) estimate.final.append(trajectory.segment(sweep.begin, sweep.end));
  for (core::SweepResult& result : estimate.sweeps)
    if (trajectory.covers(result.reference) && result.status != core::SweepStatus::initialising)
      result.T_map_body = trajectory.pose(result.reference);
}

extern const EstimatorEntry batch_spline;
const EstimatorEntry batch_spline{
    .name = "batch-spline",
    .summary = "all data at once on one B-spline: the reference trajectory of a survey; offline",
    .source = "Furgale, Rehder, Siegwart, Unified Temporal and Spatial Calibration, IROS 2013; surfaces for a target",
    .needs = Needs::lidar,
    .make = make_with<BatchSpline, BatchSplineOptions>,
    .describe = describe_with<BatchSplineOptions>,
    .resolve = resolve_with<BatchSplineOptions>};

}  // namespace tarmac::estimators
