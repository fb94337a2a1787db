/// What an odometry on a window of continuous-time motion can be told, group by group.
#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "estimators/blocks/elastic_options.h"
#include "estimators/dead_reckoning/options.h"

namespace tarmac::estimators {

inline constexpr double kRadPerDeg = 0.017453292519943295;

/// How the motion is parametrised, and what is expected of it before any measurement.
struct MotionSettings {
  std::string model = "wnoa";
  int order = 4;
  std::string knots = "uniform";
  double knot_spacing_s = 0.1;
  int knots_a_sweep = 1;
  double process_translation = 4;
  double process_rotation = 0.5;
  double singer_rate_translation_hz = 100;
  double singer_rate_rotation_hz = 100;
  double continuity_sigma_m = 0.04;
  double continuity_sigma_deg = 0.5;

  bool is_spline() const { return model == "spline" || model == "spline-se3"; }
  bool is_gp() const { return model == "wnoa" || model == "wnoj" || model == "singer"; }
  bool is_sweepwise() const { return !is_spline() && !is_gp(); }
  bool has_velocity() const { return model != "rigid" && model != "constant-velocity"; }
  bool has_acceleration() const { return is_spline() || model == "wnoj" || model == "singer"; }

  void visit(core::OptionVisitor& v) {
    v.choice("model", model,
             {"rigid", "constant-velocity", "two-pose-slerp", "two-pose-screw", "spline", "spline-se3", "wnoa", "wnoj",
              "singer"},
             "the trajectory: one pose a sweep; the same with the last twist inside; two poses; cumulative B-spline on "
             "SO(3) x R^3 or on SE(3); Gaussian process with white noise on acceleration, on jerk, or Singer's");
    v("order", order, "of a spline: 4 is cubic", {.at_least = 4, .at_most = 6});
    v.choice("knots", knots, {"uniform", "per-sweep", "imu-excitation"},
             "where knots go: evenly, at sweep ends, or the more the IMU is excited (splines)");
    v("knot_spacing_s", knot_spacing_s, "of uniform knots", {.at_least = 0.002, .at_most = 10});
    v("knots_a_sweep", knots_a_sweep, "of per-sweep knots: the last at the sweep's end, the others evenly before",
      {.at_least = 1, .at_most = 50});
    v("process_translation", process_translation,
      "spectral density of the prior: of acceleration [m^2/s^3] (wnoa, and all models without an own prior), jerk "
      "[m^2/s^5] (wnoj), or what drives the acceleration (singer)",
      {.above = 0});
    v("process_rotation", process_rotation, "the same of rotation, rad for m", {.above = 0});
    v("singer_rate_translation_hz", singer_rate_translation_hz, "singer: rate at which acceleration is forgotten [1/s]",
      {.at_least = 0});
    v("singer_rate_rotation_hz", singer_rate_rotation_hz, "the same of rotation", {.at_least = 0});
    v("continuity_sigma_m", continuity_sigma_m, "two-pose models: how far a begin lies from the last end",
      {.above = 0});
    v("continuity_sigma_deg", continuity_sigma_deg, "the same of rotation", {.above = 0});
  }
};

using SamplingSettings = ElasticSamplingOptions;

struct MapSettings {
  std::string kind = "points";
  double voxel_m = 1.0;
  int max_points_per_voxel = 20;
  double min_distance_m = 0.1;
  double radius_m = 100;
  int delay_sweeps = 0;

  void visit(core::OptionVisitor& v) {
    v.choice("kind", kind, {"points", "distributions"},
             "points in voxels, planes fitted to neighbours; or a normal distribution a voxel");
    v("voxel_m", voxel_m, "edge of a map voxel", {.at_least = 0.01});
    v("max_points_per_voxel", max_points_per_voxel, "points that a voxel takes at most",
      {.at_least = 1, .at_most = 1000});
    v("min_distance_m", min_distance_m, "points nearer than this to another of their voxel are not added (points)",
      {.at_least = 0});
    v("radius_m", radius_m, "voxels farther than this are dropped", {.above = 0});
    v("delay_sweeps", delay_sweeps, "a sweep enters the map so many sweeps later, placed by what is known then",
      {.at_least = 0, .at_most = 20});
  }
};

struct LidarSettings : NeighbourOptions {
  std::string residual = "point-to-plane";
  double sigma_m = 0.05;
  std::string loss = "cauchy";
  double loss_scale = 2;
  double planarity_power = 2;
  double max_plane_distance_m = 0.5;
  int min_distribution_points = 6;
  bool sum_stamp_residuals = false;

  LidarSettings() { min_neighbours = 10; }

  void visit(core::OptionVisitor& v) {
    v.choice("residual", residual, {"point-to-plane", "point-to-distribution"},
             "distance from a plane fitted to map points; or whitened offset from a voxel's distribution");
    v("sigma_m", sigma_m, "standard deviation of a residual of full weight", {.above = 0});
    v.choice("loss", loss, {"standard", "cauchy", "huber"}, "robust loss");
    v("loss_scale", loss_scale, "its scale, in standard deviations", {.above = 0});
    NeighbourOptions::visit(v);
    v("planarity_power", planarity_power, "a residual's weight is its neighbourhood's planarity to this power",
      {.at_least = 0});
    v("max_plane_distance_m", max_plane_distance_m, "keypoints farther off their plane are left out; 0: no limit",
      {.at_least = 0});
    v("min_distribution_points", min_distribution_points, "distributions of fewer points are not used",
      {.at_least = 4, .at_most = 1000});
    v("sum_stamp_residuals", sum_stamp_residuals,
      "for comparison only: residuals of one stamp are summed before they are squared (upstream STEAM's form)");
  }
};

struct ImuSettings {
  std::string use = "none";
  double gyro_sigma_rad_s = 0.02, accel_sigma_m_s2 = 0.3;
  bool accel_as_increments = false;
  std::string accel_loss = "cauchy";
  double accel_loss_scale = 2;
  double gyro_walk_rad_s2_rthz = 1e-4, accel_walk_m_s3_rthz = 1e-3;
  double gyro_bias_sigma_rad_s = 2e-3, accel_bias_sigma_m_s2 = 0.05;
  bool free_gravity = false;
  double gravity_sigma_deg = 1;
  bool free_time_offset = false;
  double time_offset_sigma_s = 0.02;
  bool omit_transport = false;
  RestOptions rest;

  bool gyro() const { return use != "none"; }
  bool accel() const { return use == "gyro-accel"; }

  void visit(core::OptionVisitor& v) {
    v.choice("use", use, {"none", "gyro", "gyro-accel", "auto"},
             "which residuals the IMU gives; auto (batch-spline only): all, where the rig has an IMU");
    v("gyro_sigma_rad_s", gyro_sigma_rad_s,
      "standard deviation of one reading, with what the trajectory cannot follow (vibration)", {.above = 0});
    v("accel_sigma_m_s2", accel_sigma_m_s2, "the same of the accelerometer", {.above = 0});
    v("accel_as_increments", accel_as_increments,
      "accelerometer as the change of velocity between knots; for models without a meaningful acceleration");
    v.choice("accel_loss", accel_loss, {"standard", "cauchy", "huber"}, "robust loss of accelerometer readings");
    v("accel_loss_scale", accel_loss_scale, "its scale, in standard deviations", {.above = 0});
    v("gyro_walk_rad_s2_rthz", gyro_walk_rad_s2_rthz, "random walk of the gyro bias", {.above = 0});
    v("accel_walk_m_s3_rthz", accel_walk_m_s3_rthz, "random walk of the accelerometer bias", {.above = 0});
    v("gyro_bias_sigma_rad_s", gyro_bias_sigma_rad_s, "of the bias found at rest", {.above = 0});
    v("accel_bias_sigma_m_s2", accel_bias_sigma_m_s2, "of the bias found at rest", {.above = 0});
    v("free_gravity", free_gravity, "gravity's direction in the map is an unknown");
    v("gravity_sigma_deg", gravity_sigma_deg, "of the direction found at rest", {.above = 0});
    v("free_time_offset", free_time_offset, "the IMU's time offset is an unknown");
    v("time_offset_sigma_s", time_offset_sigma_s, "of the offset about what the data sheet says", {.above = 0});
    v("omit_transport", omit_transport,
      "for comparison only: the accelerometer without omega x v (upstream STEAM's form)");
    v.group("rest", rest, "the rest from which attitude and biases are taken");
  }
};

struct WindowSettings {
  int sweeps = 2;
  std::string marginalisation = "plain";
  double eigenvalue_threshold = 1e-8;

  void visit(core::OptionVisitor& v) {
    v("sweeps", sweeps, "whose states are free while the last one is registered; more than delay_sweeps",
      {.at_least = 1, .at_most = 100});
    v.choice("marginalisation", marginalisation, {"plain", "eigenvalue", "fix"},
             "what becomes of states that leave: Schur complement; the same without its weakest directions; held");
    v("eigenvalue_threshold", eigenvalue_threshold, "of eigenvalue: below this share of the largest",
      {.above = 0, .below = 1});
  }
};

struct SolverSettings {
  int associations = 10, startup_associations = 15;
  int iterations = 3;
  bool levenberg_marquardt = false;
  int line_search_from = -1;
  double convergence_m = 0.005, convergence_deg = 0.01;
  int min_residuals = 100;
  bool stop_early = true;

  void visit(core::OptionVisitor& v) {
    v("associations", associations, "searches of surfaces a sweep, at most", {.at_least = 1});
    v("startup_associations", startup_associations, "the same during start-up", {.at_least = 1});
    v("iterations", iterations, "steps of the solver an association, at most", {.at_least = 1});
    v("levenberg_marquardt", levenberg_marquardt, "damped steps; else Gauss-Newton");
    v("line_search_from", line_search_from,
      "association (from 0) from which steps are halved while the cost rises; -1: never", {.at_least = -1});
    v("convergence_m", convergence_m, "an association that moves begin and end by less than this together...",
      {.above = 0});
    v("convergence_deg", convergence_deg, "...and turns them by less than this together is the last", {.above = 0});
    v("stop_early", stop_early, "whether it is");
    v("min_residuals", min_residuals, "with fewer a sweep is lost: its prediction is kept", {.at_least = 6});
  }
};

/// All groups.
struct WindowOdometrySettings {
  MotionSettings motion;
  SamplingSettings sampling;
  MapSettings map;
  LidarSettings lidar;
  ImuSettings imu;
  WindowSettings window;
  SolverSettings solver;
  double start_sigma_m = 1e-3;
  double start_velocity_sigma_m_s = 0.5;

  void visit_groups(core::OptionVisitor& v) {
    v.group("motion", motion, "the trajectory model and its prior");
    v.group("sampling", sampling, "which points are used");
    v.group("map", map, "what sweeps are registered against");
    v.group("lidar", lidar, "residuals of points");
    v.group("imu", imu, "residuals of the IMU");
    v.group("window", window, "how long states stay free");
    v.group("solver", solver, "how hard it tries");
    v("start_sigma_m", start_sigma_m, "how well the start's pose is known (rotation: the same number in rad)",
      {.above = 0});
    v("start_velocity_sigma_m_s", start_velocity_sigma_m_s,
      "how far from rest the start may be (rotation: a fifth of it in rad/s)", {.above = 0});
  }

  /// Themselves. Throws InputError where they contradict each other, naming what. A number that the chosen model, map
  /// or loss does not look at (order without a spline, loss_scale of loss standard) is no contradiction.
  const WindowOdometrySettings& checked() const;
};

/// Throws InputError where the two contradict each other.
void check_lidar(const LidarSettings& lidar, const MapSettings& map);

}  // namespace tarmac::estimators
