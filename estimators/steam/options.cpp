#include "estimators/steam/options.h"

#include <cmath>

namespace tarmac::estimators {
namespace {

/// What all configurations share.
WindowOdometrySettings common() {
  WindowOdometrySettings s;
  s.motion.model = "wnoa";
  s.motion.knots = "per-sweep";
  s.motion.process_translation = 50;
  s.motion.process_rotation = 5;
  s.map.delay_sweeps = 1;
  s.window.sweeps = 2;
  // The published residuals have unit covariance in metres: the prior is strong against them.
  s.lidar.sigma_m = 1;
  s.lidar.loss = "standard";
  s.lidar.min_neighbours = 20;
  s.solver.associations = s.solver.startup_associations = 10;
  s.solver.iterations = 5;
  s.solver.convergence_m = 0.001;
  s.solver.convergence_deg = 0.0001;
  s.start_sigma_m = 0.01;
  s.start_velocity_sigma_m_s = 0.01;
  return s;
}

void set_driving(WindowOdometrySettings& s) {
  s.sampling.min_range_m = 5;
  s.lidar.max_plane_distance_m = 0.5;
  s.solver.min_residuals = 100;
}

void set_handheld(WindowOdometrySettings& s) {
  s.sampling.min_range_m = 0.1;
  s.sampling.keypoint_cell_m = 1.0;
  s.lidar.min_neighbours = 10;
  s.lidar.max_plane_distance_m = 1.0;
  s.map.radius_m = 400;
  s.solver.line_search_from = 2;
  s.solver.min_residuals = 6;
}

/// A bias walk given as variance an interval of 0.1 s, as a density.
double walk_of(double variance_a_sweep) {
  return std::sqrt(variance_a_sweep / 0.1);
}

}  // namespace

void SteamLoOptions::set_profile(const std::string& name) {
  static_cast<WindowOdometrySettings&>(*this) = common();
  profile = name;
  if (name == "newer-college") {
    set_handheld(*this);
  } else {
    set_driving(*this);
    solver.line_search_from = 2;
  }
}

void SteamLoOptions::visit(core::OptionVisitor& v) {
  const std::string before = profile;
  v.choice("profile", profile, {"kitti", "newer-college"},
           "whose defaults: the published configuration for a car or for a handheld sensor; changes all below");
  if (profile != before) set_profile(std::string(profile));
  visit_groups(v);
}

void SteamLioOptions::set_profile(const std::string& name) {
  static_cast<WindowOdometrySettings&>(*this) = common();
  profile = name;
  imu.use = "gyro-accel";
  imu.accel_as_increments = true;
  imu.accel_loss = "standard";
  if (name == "boreas") {
    set_driving(*this);
    solver.stop_early = false;
    sampling.keypoint_cell_m = 1.7;
    map.max_points_per_voxel = lidar.max_neighbours = lidar.min_neighbours = 18;
    imu.gyro_sigma_rad_s = std::sqrt(3.34e-2);
    imu.accel_sigma_m_s2 = 1;
    imu.gyro_walk_rad_s2_rthz = walk_of(1e-4);
    imu.accel_walk_m_s3_rthz = walk_of(0.1);
    imu.gyro_bias_sigma_rad_s = imu.accel_bias_sigma_m_s2 = 0.1;
    return;
  }
  set_handheld(*this);
  imu.gyro_walk_rad_s2_rthz = walk_of(1.6e-4);
  imu.accel_walk_m_s3_rthz = walk_of(0.11236);
  imu.gyro_bias_sigma_rad_s = 0.1;
  if (name == "newer-college") {
    imu.gyro_sigma_rad_s = std::sqrt(4.326e-3);
    imu.accel_sigma_m_s2 = std::sqrt(5e-2);
    imu.accel_bias_sigma_m_s2 = std::sqrt(1e-3);
    return;
  }
  motion.model = "singer";
  motion.process_translation = 5000;
  motion.process_rotation = 500;
  motion.singer_rate_translation_hz = 0;
  motion.singer_rate_rotation_hz = 100;
  imu.accel_as_increments = false;
  imu.accel_loss = "cauchy";
  imu.accel_loss_scale = 1;
  imu.gyro_sigma_rad_s = std::sqrt(4.326e-4);
  imu.accel_sigma_m_s2 = std::sqrt(0.156);
  imu.accel_bias_sigma_m_s2 = std::sqrt(0.1);
  solver.iterations = 10;
}

void SteamLioOptions::visit(core::OptionVisitor& v) {
  const std::string before = profile;
  v.choice(
      "profile", profile, {"boreas", "newer-college", "newer-college-singer"},
      "whose defaults: the published configuration for a car or for a handheld sensor, the latter with white noise on "
      "acceleration or with Singer's prior; changes all below");
  if (profile != before) set_profile(std::string(profile));
  visit_groups(v);
}

}  // namespace tarmac::estimators
