/// The scenario's `faults:` block: what is wrong with the sensors' clocks, stamps, streams and mountings.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/lie.h"
#include "core/options.h"

namespace tarmac::sim::faults {

/// True times since the recording's begin; from_s counts to it, to_s does not.
struct Interval {
  double from_s = 0, to_s = 36000;
  void visit(core::OptionVisitor& v);
  bool holds(double t_s) const { return t_s >= from_s && t_s < to_s; }
};

/// Columns that are lost: azimuth of the head, clockwise seen from above, 0 = sensor +x; 350 to 10 crosses 0.
struct Sector {
  double from_deg = 0, to_deg = 360;
  Interval when;
  void visit(core::OptionVisitor& v);
  bool holds(double azimuth_deg) const;
};

/// Times: recorded = what the faulty clock and driver say, true = when the firing was. See sim/faults/README.md for the
/// order in which the effects act.
struct LidarFaultOptions {
  double clock_offset_ms = 0;
  double clock_drift_ppm = 0;
  double sweep_jitter_ms = 0;
  double packet_jitter_ms = 0;
  std::string stamp = "begin";
  std::string point_time_origin = "begin";
  bool point_time_reversed = false;
  std::string point_time_unit = "ns";
  double point_time_scale = 1;
  bool point_time_per_packet = false;
  double point_time_step_ms = 0;
  bool point_time_float32 = false;
  double float32_epoch_s = 0;
  bool point_time_missing = false;
  int packet_columns = 16;
  double lost_packets = 0;
  double lost_sweeps = 0;
  std::vector<Interval> sweep_gaps;
  std::vector<Sector> lost_sectors;
  core::SE3 extrinsic_error = core::SE3::Identity();
  void visit(core::OptionVisitor& v);
  /// Of point times, by unit and scale.
  double time_factor() const;
};

struct ImuFaultOptions {
  double clock_offset_ms = 0;
  double clock_drift_ppm = 0;
  double jitter_ms = 0;
  double lost_samples = 0;
  std::vector<Interval> gaps;
  core::SE3 extrinsic_error = core::SE3::Identity();
  void visit(core::OptionVisitor& v);
};

struct FaultOptions {
  LidarFaultOptions lidar;                ///< of the first LiDAR, where `lidars` is not given
  bool listed = false;                    ///< `lidars:` was given
  std::vector<LidarFaultOptions> lidars;  ///< of the rig's LiDARs in their order; those beyond its end have none
  ImuFaultOptions imu;
  /// The block of an IMU that the rig has not is left out.
  void visit(core::OptionVisitor& v, bool has_imu = true);
  LidarFaultOptions of_lidar(std::size_t k) const;
};

/// `sweep_rate_hz`: of the rig's LiDARs. Throws InputError (file, line, field) for a wrong option, an interval that
/// ends before it begins, faults of an IMU or a LiDAR that the rig has not, or point times that would not fit the
/// recording's 32 bits at this sweep rate.
FaultOptions read_faults(const core::ConfigNode& faults, bool has_imu, const std::vector<double>& sweep_rate_hz);

}  // namespace tarmac::sim::faults
