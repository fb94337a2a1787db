#include "sim/faults/point_times.h"

#include <cmath>
#include <limits>

namespace tarmac::sim::faults {

using namespace core;

namespace {

std::int32_t held(double t_ns) {
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::llround(std::clamp(t_ns, -most, most)));
}

/// As a driver does that keeps seconds since its epoch in a 32-bit float and a reader that takes the sweep's begin off.
double through_float32(double t_ns, Time recorded_begin, double epoch_s) {
  const double begin_s = epoch_s + to_s(recorded_begin);
  const float stamp_s = static_cast<float>(begin_s + 1e-9 * t_ns);
  return (static_cast<double>(stamp_s) - begin_s) * 1e9;
}

}  // namespace

PointTimes::PointTimes(const LidarFaultOptions& options, std::uint64_t seed, const std::string& sensor)
    : options_(options),
      clock_(options.clock_offset_ms, options.clock_drift_ppm),
      packet_jitter_(seed, sensor + "/faults/packet_jitter") {}

std::vector<std::int64_t> PointTimes::by_sensor(std::int64_t sweep_index, const SweepStamp& true_sweep,
                                                const Columns& columns, const std::vector<std::int32_t>& t_ns) const {
  const Time begin = clock_(true_sweep.begin);
  const auto packet_columns = static_cast<std::size_t>(options_.packet_columns);
  std::vector<std::int64_t> out(t_ns.size());
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    std::int32_t fired_ns = t_ns[i];
    Duration jitter{0};
    if (needs_columns()) {
      const std::size_t packet = columns.of(fired_ns) / packet_columns;
      if (options_.point_time_per_packet) fired_ns = columns.begin_ns[packet * packet_columns];
      if (options_.packet_jitter_ms > 0)
        jitter = duration_from_s(
            1e-3 * options_.packet_jitter_ms *
            packet_jitter_.normal(static_cast<std::uint64_t>(sweep_index), static_cast<std::uint32_t>(packet)));
    }
    out[i] = (clock_(true_sweep.begin + Duration(fired_ns)) - begin + jitter).count();
  }
  return out;
}

double PointTimes::by_driver(double t, std::int64_t span_ns, Time recorded_begin) const {
  const auto span = static_cast<double>(span_ns);
  if (options_.point_time_reversed) t = span - t;
  t *= options_.time_factor();
  if (options_.point_time_unit != "ns") t = std::floor(t);  // whole units are what the field held
  if (options_.point_time_origin == "mid") t -= span / 2;
  if (options_.point_time_origin == "end") t -= span;
  if (options_.point_time_step_ms > 0) {
    const double step = 1e6 * options_.point_time_step_ms;
    t = std::floor(t / step) * step;
  }
  if (options_.point_time_float32) t = through_float32(t, recorded_begin, options_.float32_epoch_s);
  return options_.point_time_missing ? 0 : t;
}

void PointTimes::apply(std::int64_t sweep_index, const SweepStamp& true_sweep, const SweepStamp& recorded,
                       const Columns& columns, std::vector<std::int32_t>& t_ns) const {
  const std::vector<std::int64_t> stamped = by_sensor(sweep_index, true_sweep, columns, t_ns);
  const std::int64_t span_ns = (clock_(true_sweep.end) - clock_(true_sweep.begin)).count();
  for (std::size_t i = 0; i < t_ns.size(); ++i)
    t_ns[i] = held(by_driver(static_cast<double>(stamped[i]), span_ns, recorded.begin));
}

}  // namespace tarmac::sim::faults
