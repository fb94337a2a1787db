#include "estimators/window_odometry/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace tarmac::estimators {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw core::InputError(why);
}

void check_motion(const WindowOdometrySettings& s) {
  const MotionSettings& m = s.motion;
  if (m.knots == "imu-excitation" && !m.is_spline())
    refuse(fmt::format("motion.knots: imu-excitation places knots of splines; motion.model is {}", m.model));
  if (m.knots == "imu-excitation" && !s.imu.gyro())
    refuse("motion.knots: imu-excitation needs an IMU, but imu.use is none");
  if (m.knots == "per-sweep" && m.is_spline() && m.knots_a_sweep > 1)
    refuse("motion.knots_a_sweep: splines take one knot a sweep with per-sweep; use uniform knots for more");
  if (m.is_sweepwise() && m.knots != "per-sweep")
    refuse(fmt::format("motion.knots: {} has its poses where sweeps begin and end: per-sweep is all it can use, not {}",
                       m.model, m.knots));
  if (m.is_sweepwise() && s.window.sweeps > 1)
    refuse(
        fmt::format("window.sweeps: {} has nothing that ties sweeps together: 1 is all it can use, {} were asked for",
                    m.model, s.window.sweeps));
}

void check_imu(const WindowOdometrySettings& s) {
  const MotionSettings& m = s.motion;
  if (s.imu.use == "auto") refuse("imu.use: auto is batch-spline's; say none, gyro or gyro-accel");
  if (!s.imu.gyro() && (s.imu.free_gravity || s.imu.free_time_offset))
    refuse("imu.free_gravity and imu.free_time_offset are about an IMU, but imu.use is none");
  if (!s.imu.gyro()) return;
  if (!m.has_velocity())
    refuse(fmt::format("imu.use: {} has no velocity inside a sweep that an IMU could tell of; use none", m.model));
  if (s.imu.accel() && !m.has_acceleration() && !s.imu.accel_as_increments)
    refuse(fmt::format("imu.use: {} has no acceleration of its own: use gyro, or imu.accel_as_increments", m.model));
  if (!s.imu.accel() && (s.imu.accel_as_increments || s.imu.omit_transport))
    refuse("imu.accel_as_increments and imu.omit_transport are about the accelerometer, but imu.use is gyro");
  if (s.imu.accel() && m.is_sweepwise()) refuse(fmt::format("imu.use: {} has no acceleration: use gyro", m.model));
}

}  // namespace

void check_lidar(const LidarSettings& lidar, const MapSettings& map) {
  if (lidar.min_neighbours > lidar.max_neighbours)
    refuse(fmt::format("lidar.min_neighbours: {} must not be above lidar.max_neighbours ({}): no plane would be found",
                       lidar.min_neighbours, lidar.max_neighbours));
  if ((lidar.residual == "point-to-distribution") != (map.kind == "distributions"))
    refuse(fmt::format("lidar.residual: {} does not go with map.kind {}", lidar.residual, map.kind));
  if (!lidar.sum_stamp_residuals) return;
  if (lidar.residual != "point-to-plane")
    refuse(fmt::format("lidar.sum_stamp_residuals: of point-to-plane only; lidar.residual is {}", lidar.residual));
  if (lidar.loss != "standard")
    refuse(fmt::format("lidar.sum_stamp_residuals: a sum has no robust loss; use lidar.loss standard, not {}",
                       lidar.loss));
}

const WindowOdometrySettings& WindowOdometrySettings::checked() const {
  check_motion(*this);
  check_imu(*this);
  check_lidar(lidar, map);
  if (sampling.min_range_m >= sampling.max_range_m)
    refuse(fmt::format("sampling.min_range_m: {} must be below sampling.max_range_m ({}): no point would be left",
                       sampling.min_range_m, sampling.max_range_m));
  if (map.delay_sweeps >= window.sweeps)
    refuse(fmt::format(
        "map.delay_sweeps: {} must be below window.sweeps ({}): a sweep enters the map by its window's states",
        map.delay_sweeps, window.sweeps));
  const double smallest_cell_m = std::min({sampling.sample_cell_m, sampling.startup_sample_cell_m, map.voxel_m});
  if (sampling.max_range_m / smallest_cell_m > 1e8)
    refuse(fmt::format("sampling.max_range_m: {} is too large for cells of {} m: cells are counted in 32 bits",
                       sampling.max_range_m, smallest_cell_m));
  return *this;
}

}  // namespace tarmac::estimators
