/// Sweeps of a sensor with 1024 columns at 10 Hz and two channels, without a ray being traced.
#pragma once

#include <cmath>
#include <vector>

#include "core/config.h"
#include "sim/faults/fault_log.h"
#include "sim/faults/lidar_faults.h"

namespace tarmac::tests {

constexpr std::int64_t column_count = 1024;

inline std::int32_t column_ns(std::int64_t column) {
  return static_cast<std::int32_t>(std::llround(static_cast<double>(column) * 1e8 / column_count));
}

inline sim::faults::Columns columns() {
  sim::faults::Columns columns;
  for (std::int64_t c = 0; c < column_count; ++c) {
    columns.begin_ns.push_back(column_ns(c));
    columns.azimuth_deg.push_back(std::fmod(180 + 360.0 * static_cast<double>(c) / column_count, 360));
  }
  return columns;
}

inline std::vector<sim::faults::SweepStamp> true_sweeps(std::int64_t count) {
  std::vector<sim::faults::SweepStamp> sweeps;
  for (std::int64_t k = 0; k < count; ++k) {
    const core::Time begin = core::time_from_ns(k * 100'000'000);
    sweeps.push_back({begin, begin + core::Duration(column_ns(column_count - 1))});
  }
  return sweeps;
}

/// A sweep whose points say where they came from: x = column, y = channel; every seventh firing has no return.
struct LabelledSweep {
  core::LidarSweep sweep;
  sim::truth::PointLabels labels;
};

inline LabelledSweep labelled_sweep(std::int64_t index) {
  LabelledSweep out;
  const sim::faults::SweepStamp span = true_sweeps(index + 1).back();
  out.sweep.index = index;
  out.sweep.begin = out.labels.begin = span.begin;
  out.sweep.end = out.labels.end = span.end;
  for (std::int64_t firing = 0; firing < 2 * column_count; ++firing) {
    if (firing % 7 == 6) continue;
    const std::int64_t column = firing / 2, channel = firing % 2;
    out.sweep.push_back({static_cast<float>(column), static_cast<float>(channel), 0}, column_ns(column),
                        static_cast<std::uint16_t>(channel), 1);
    out.labels.label.push_back(scenes::Label::pavement);
    out.labels.instance.push_back(static_cast<std::uint32_t>(firing));
    out.labels.moving.push_back(0);
    out.labels.t_ns.push_back(column_ns(column));
  }
  return out;
}

/// Options as a scenario gives them.
inline sim::faults::FaultOptions faults_of(const std::string& yaml) {
  return sim::faults::read_faults(core::ConfigNode::parse(yaml, "drive.yaml").child("faults"), true, {10.0});
}

}  // namespace tarmac::tests
