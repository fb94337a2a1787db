#include "sim/faults/fault_options.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace tarmac::sim::faults {

using namespace core;

void Interval::visit(OptionVisitor& v) {
  v("from_s", from_s, "true time since the recording's begin", {.at_least = 0});
  v("to_s", to_s, "end of it, which does not count to it", {.above = 0});
}

void Sector::visit(OptionVisitor& v) {
  v("from_deg", from_deg, "azimuth of the head, clockwise from sensor +x", {.at_least = 0, .at_most = 360});
  v("to_deg", to_deg, "where the sector ends, clockwise; 350 to 10 crosses 0", {.at_least = 0, .at_most = 360});
  when.visit(v);
}

bool Sector::holds(double azimuth_deg) const {
  const double width = to_deg > from_deg ? to_deg - from_deg : to_deg - from_deg + 360;
  const double inside = std::fmod(azimuth_deg - from_deg + 720, 360);
  return inside < width;
}

void LidarFaultOptions::visit(OptionVisitor& v) {
  v("clock_offset_ms", clock_offset_ms, "recorded minus true time, beyond the data sheet's",
    {.at_least = -10000, .at_most = 10000});
  v("clock_drift_ppm", clock_drift_ppm, "how much faster the sensor's clock runs, from the recording's begin on",
    {.at_least = -100000, .at_most = 100000});
  v("sweep_jitter_ms", sweep_jitter_ms, "1 sigma of each sweep's stamp", {.at_least = 0, .at_most = 1000});
  v("packet_jitter_ms", packet_jitter_ms, "1 sigma of the stamps of each packet", {.at_least = 0, .at_most = 1000});
  v.choice("stamp", stamp, {"begin", "mid", "end"},
           "instant of the sweep at which its stamp is really taken, while the data sheet says begin: all is late");
  v.choice("point_time_origin", point_time_origin, {"begin", "mid", "end"},
           "instant from which point times really count, while the recording says begin: points are early");
  v("point_time_reversed", point_time_reversed, "point times run from the sweep's end to its begin");
  v.choice("point_time_unit", point_time_unit, {"ns", "us", "ms"},
           "unit that point times really have, while they are taken as ns");
  v("point_time_scale", point_time_scale, "factor on point times", {.above = 0, .at_most = 1000});
  v("point_time_per_packet", point_time_per_packet, "all points of a packet carry the time of its first column");
  v("point_time_step_ms", point_time_step_ms, "point times are cut down to a multiple of this; 0 = exact",
    {.at_least = 0, .at_most = 1000});
  v("point_time_float32", point_time_float32, "point times went through absolute seconds in 32-bit floats");
  v("float32_epoch_s", float32_epoch_s,
    "with point_time_float32: seconds on that clock at the recording's begin; floats of a later one step by seconds",
    {.at_least = 0, .at_most = 1.6e7});
  v("point_time_missing", point_time_missing, "all points of a sweep carry its stamp");
  v("packet_columns", packet_columns, "columns (firing cycles) in a packet", {.at_least = 1, .at_most = 4096});
  v("lost_packets", lost_packets, "probability that a packet is lost", {.at_least = 0, .at_most = 1});
  v("lost_sweeps", lost_sweeps, "probability that a whole sweep is lost", {.at_least = 0, .below = 1});
  v.list("sweep_gaps", sweep_gaps, "sweeps that begin in one of these are lost");
  v.list("lost_sectors", lost_sectors, "columns fired in one of these are lost");
  v("extrinsic_error", extrinsic_error, "true mounting = T_body_lidar of the data sheet * this");
}

double LidarFaultOptions::time_factor() const {
  return point_time_scale * (point_time_unit == "us" ? 1e-3 : point_time_unit == "ms" ? 1e-6 : 1);
}

void ImuFaultOptions::visit(OptionVisitor& v) {
  v("clock_offset_ms", clock_offset_ms, "recorded minus true time, beyond the data sheet's delay",
    {.at_least = -10000, .at_most = 10000});
  v("clock_drift_ppm", clock_drift_ppm, "how much faster the sensor's clock runs, from the recording's begin on",
    {.at_least = -100000, .at_most = 100000});
  v("jitter_ms", jitter_ms, "1 sigma of each stamp; stamps stay in order", {.at_least = 0, .at_most = 1000});
  v("lost_samples", lost_samples, "probability that a sample is lost", {.at_least = 0, .below = 1});
  v.list("gaps", gaps, "samples with true stamps in one of these are lost");
  v("extrinsic_error", extrinsic_error, "true mounting = T_body_imu of the data sheet * this");
}

void FaultOptions::visit(OptionVisitor& v, bool has_imu) {
  if (listed)
    v.list("lidars", lidars, "faults of each LiDAR, in the rig's order; {} = none");
  else
    v.group("lidar", lidar, "faults of the first LiDAR");
  if (has_imu) v.group("imu", imu, "faults of the IMU");
}

namespace {

void check_intervals(const ConfigNode& list) {
  for (const ConfigNode& item : list.items()) {
    const auto s = [&](const char* key, double otherwise) {
      const ConfigNode node = item.child(key);
      return node.present() ? std::stod(node.scalar(key)) : otherwise;
    };
    const Interval defaults;
    const double from_s = s("from_s", defaults.from_s), to_s = s("to_s", defaults.to_s);
    if (!(to_s > from_s)) item.fail(fmt::format("to_s ({}) must be above from_s ({})", to_s, from_s));
  }
}

/// Options that the others leave without effect.
void refuse_idle(const ConfigNode& node, const LidarFaultOptions& o) {
  const LidarFaultOptions usual;
  const auto idle = [&](bool given, const char* name, const char* why) {
    if (given) node.fail_at(name, fmt::format("has no effect here: {}; take it away or add that", why));
  };
  idle(!o.point_time_float32 && o.float32_epoch_s != usual.float32_epoch_s, "float32_epoch_s",
       "only with point_time_float32");
  const bool packets = o.packet_jitter_ms > 0 || o.point_time_per_packet || o.lost_packets > 0;
  idle(!packets && o.packet_columns != usual.packet_columns, "packet_columns",
       "only with packet_jitter_ms, point_time_per_packet or lost_packets");
  const bool other_times = o.packet_jitter_ms > 0 || o.point_time_per_packet || o.point_time_reversed ||
                           o.point_time_float32 || o.point_time_step_ms > 0 || o.point_time_scale != 1 ||
                           o.point_time_unit != usual.point_time_unit || o.point_time_origin != usual.point_time_origin;
  if (o.point_time_missing && other_times)
    node.fail_at("point_time_missing",
                 "stands beside other faults of point times, and there are none then: give one of them");
}

void check_lidar(const ConfigNode& node, const LidarFaultOptions& options, double sweep_rate_hz) {
  check_intervals(node.child("sweep_gaps"));
  check_intervals(node.child("lost_sectors"));
  refuse_idle(node, options);
  const double most = std::numeric_limits<std::int32_t>::max() * 1e-9 * sweep_rate_hz / 2;
  if (options.time_factor() > most)
    node.fail_at("point_time_scale", fmt::format("{} stretches a sweep at {} Hz beyond the 2.1 s that a recording's "
                                                 "point times can hold: at most {:.3g}",
                                                 options.point_time_scale, sweep_rate_hz, most));
}

}  // namespace

LidarFaultOptions FaultOptions::of_lidar(std::size_t k) const {
  if (listed) return k < lidars.size() ? lidars[k] : LidarFaultOptions();
  return k == 0 ? lidar : LidarFaultOptions();
}

FaultOptions read_faults(const ConfigNode& faults, bool has_imu, const std::vector<double>& sweep_rate_hz) {
  FaultOptions options;
  const ConfigNode listed = faults.child("lidars"), imu = faults.child("imu");
  options.listed = listed.present();
  if (options.listed && faults.child("lidar").present())
    listed.fail("stands beside lidar; give the faults of all LiDARs in one of them");
  faults.read(options);
  if (imu.present() && !has_imu) imu.fail("the rig has no IMU: add rig.imu or take these faults away");
  check_intervals(imu.child("gaps"));
  if (!options.listed) check_lidar(faults.child("lidar"), options.lidar, sweep_rate_hz.at(0));
  const std::vector<ConfigNode> items = options.listed ? listed.items() : std::vector<ConfigNode>();
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (k >= sweep_rate_hz.size())
      items[k].fail(fmt::format("the rig has {} LiDAR{}; take these faults away", sweep_rate_hz.size(),
                                sweep_rate_hz.size() == 1 ? "" : "s"));
    check_lidar(items[k], options.lidars[k], sweep_rate_hz[k]);
  }
  return options;
}

}  // namespace tarmac::sim::faults
