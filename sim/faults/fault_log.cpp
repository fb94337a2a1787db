#include "sim/faults/fault_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace tarmac::sim::faults {

using namespace core;

namespace {

using Parameters = std::map<std::string, double>;

class Log {
 public:
  explicit Log(std::string sensor) : sensor_(std::move(sensor)) {}
  void add(const char* kind, const std::string& detail, const Parameters& parameters = {}) {
    faults.push_back({kind, sensor_, detail, parameters});
  }
  void add_if(double value, const char* kind, const char* parameter, const char* detail) {
    if (value != 0) add(kind, fmt::format(fmt::runtime(detail), value), {{parameter, value}});
  }
  std::vector<truth::Fault> faults;

 private:
  std::string sensor_;
};

std::string text(const Interval& gap) {
  return fmt::format("true time {} to {} s", gap.from_s, gap.to_s);
}

void add_extrinsic(const SE3& error, Log& log) {
  if (error.matrix() == SE3::Identity().matrix()) return;
  const Eigen::Vector3d p = error.translation(), r = so3::log(error.linear());
  log.add("wrong-extrinsic",
          fmt::format("true mounting = the data sheet's * this: {:.4g} m, {:.4g} rad", p.norm(), r.norm()),
          {{"x_m", p.x()},
           {"y_m", p.y()},
           {"z_m", p.z()},
           {"rotation_x_rad", r.x()},
           {"rotation_y_rad", r.y()},
           {"rotation_z_rad", r.z()}});
}

void add_point_times(const LidarFaultOptions& o, Log& log) {
  if (o.point_time_reversed) log.add("point-times-reversed", "point times run from the sweep's end to its begin");
  if (o.point_time_unit != "ns")
    log.add("point-time-unit", fmt::format("point times are {}, taken as ns", o.point_time_unit),
            {{"factor", o.point_time_unit == "us" ? 1e-3 : 1e-6}});
  if (o.point_time_scale != 1)
    log.add("point-time-scale", fmt::format("point times are multiplied by {}", o.point_time_scale),
            {{"factor", o.point_time_scale}});
  if (o.point_time_origin != "begin")
    log.add("point-time-origin", fmt::format("point times count from the sweep's {}", o.point_time_origin),
            {{"fraction_of_sweep", o.point_time_origin == "mid" ? 0.5 : 1}});
  if (o.point_time_per_packet)
    log.add("stamps-per-packet", fmt::format("one time for the {} columns of a packet", o.packet_columns),
            {{"packet_columns", o.packet_columns}});
  log.add_if(o.point_time_step_ms, "quantised-stamps", "step_ms", "point times are multiples of {} ms, cut down");
  if (o.point_time_float32)
    log.add("float32-stamps", fmt::format("absolute seconds in 32-bit floats, {} s at the begin", o.float32_epoch_s),
            {{"epoch_s", o.float32_epoch_s}});
  if (o.point_time_missing) log.add("missing-stamps", "all points of a sweep carry its stamp");
}

void add_losses(const LidarFaultOptions& o, const LidarFaults& realised, const std::vector<std::size_t>& columns,
                Log& log) {
  std::vector<std::size_t> lost;
  double packets = 0, lost_packets = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto index = static_cast<std::int64_t>(k);
    if (realised.lost(index)) {
      lost.push_back(k);
      continue;
    }
    const auto size = static_cast<std::size_t>(o.packet_columns);
    packets += static_cast<double>((columns[k] + size - 1) / size);
    lost_packets += static_cast<double>(realised.lost_packets(index, columns[k]));
  }
  if (o.lost_packets > 0)
    log.add("lost-packets", fmt::format("{} of {} packets of {} columns", lost_packets, packets, o.packet_columns),
            {{"probability", o.lost_packets},
             {"lost", lost_packets},
             {"packets", packets},
             {"packet_columns", o.packet_columns}});
  for (const Sector& sector : o.lost_sectors)
    log.add("lost-sector", fmt::format("azimuth {} to {} deg, {}", sector.from_deg, sector.to_deg, text(sector.when)),
            {{"from_deg", sector.from_deg},
             {"to_deg", sector.to_deg},
             {"from_s", sector.when.from_s},
             {"to_s", sector.when.to_s}});
  for (const Interval& gap : o.sweep_gaps)
    log.add("sweep-gap", text(gap), {{"from_s", gap.from_s}, {"to_s", gap.to_s}});
  if (o.lost_sweeps > 0 || !o.sweep_gaps.empty())
    log.add("lost-sweeps", fmt::format("sweeps [{}] of {}", fmt::join(lost, ", "), columns.size()),
            {{"probability", o.lost_sweeps},
             {"lost", static_cast<double>(lost.size())},
             {"sweeps", static_cast<double>(columns.size())}});
}

}  // namespace

std::vector<truth::Fault> lidar_log(const LidarFaultOptions& o, const LidarFaults& realised,
                                    const std::vector<std::size_t>& columns, const std::string& sensor) {
  Log log(sensor);
  log.add_if(o.clock_offset_ms, "clock-offset", "offset_ms", "recorded minus true time: {} ms");
  log.add_if(o.clock_drift_ppm, "clock-drift", "drift_ppm", "{} ppm from the recording's begin");
  log.add_if(o.sweep_jitter_ms, "sweep-jitter", "sigma_ms", "{} ms (1 sigma) a sweep");
  log.add_if(o.packet_jitter_ms, "packet-jitter", "sigma_ms", "{} ms (1 sigma) a packet");
  if (o.stamp != "begin")
    log.add("stamp-convention", fmt::format("sweeps are stamped at their {}, the data sheet says begin", o.stamp),
            {{"fraction_of_sweep", o.stamp == "mid" ? 0.5 : 1}});
  add_point_times(o, log);
  add_losses(o, realised, columns, log);
  add_extrinsic(o.extrinsic_error, log);
  return std::move(log.faults);
}

std::vector<truth::Fault> imu_log(const ImuFaultOptions& o, std::size_t lost, std::size_t samples,
                                  const std::string& sensor) {
  Log log(sensor);
  log.add_if(o.clock_offset_ms, "clock-offset", "offset_ms", "recorded minus true time: {} ms");
  log.add_if(o.clock_drift_ppm, "clock-drift", "drift_ppm", "{} ppm from the recording's begin");
  log.add_if(o.jitter_ms, "stamp-jitter", "sigma_ms", "{} ms (1 sigma) a sample");
  if (o.lost_samples > 0)
    log.add("lost-samples", fmt::format("{} of {} samples", lost, samples),
            {{"probability", o.lost_samples},
             {"lost", static_cast<double>(lost)},
             {"samples", static_cast<double>(samples)}});
  for (const Interval& gap : o.gaps) log.add("gap", text(gap), {{"from_s", gap.from_s}, {"to_s", gap.to_s}});
  add_extrinsic(o.extrinsic_error, log);
  return std::move(log.faults);
}

}  // namespace tarmac::sim::faults
