#include "sim/faults/lidar_faults.h"

namespace tarmac::sim::faults {

using namespace core;

namespace {

template <class T>
void keep_only(std::vector<T>& values, const std::vector<std::size_t>& kept) {
  for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
  values.resize(kept.size());
}

void keep_only(LidarSweep& sweep, truth::PointLabels& labels, const std::vector<std::size_t>& kept) {
  keep_only(sweep.x_m, kept);
  keep_only(sweep.y_m, kept);
  keep_only(sweep.z_m, kept);
  keep_only(sweep.t_ns, kept);
  keep_only(sweep.ring, kept);
  keep_only(sweep.intensity, kept);
  labels.keep_only(kept);
}

}  // namespace

LidarFaults::LidarFaults(const LidarFaultOptions& options, const std::vector<SweepStamp>& true_sweeps,
                         std::uint64_t seed, const std::string& sensor)
    : options_(options),
      true_(true_sweeps),
      recorded_(faulty_stamps(options, true_sweeps, seed, sensor)),
      point_times_(options, seed, sensor),
      losses_(options, seed, sensor) {}

bool LidarFaults::lost(std::int64_t index) const {
  return losses_.sweep_lost(index, true_.at(static_cast<std::size_t>(index)).begin);
}

std::size_t LidarFaults::lost_packets(std::int64_t index, std::size_t columns) const {
  const auto size = static_cast<std::size_t>(options_.packet_columns);
  std::size_t lost = 0;
  for (std::size_t packet = 0; packet * size < columns; ++packet) lost += losses_.packet_lost(index, packet);
  return lost;
}

void LidarFaults::apply(LidarSweep& sweep, truth::PointLabels& labels, const Columns& columns) const {
  const SweepStamp& true_sweep = true_.at(static_cast<std::size_t>(sweep.index));
  const SweepStamp& recorded = recorded_.at(static_cast<std::size_t>(sweep.index));
  if (losses_.needs_columns()) {
    const std::vector<std::uint8_t> lost = losses_.lost_columns(sweep.index, true_sweep.begin, columns);
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < sweep.size(); ++i)
      if (!lost[columns.of(sweep.t_ns[i])]) kept.push_back(i);
    keep_only(sweep, labels, kept);
  }
  point_times_.apply(sweep.index, true_sweep, recorded, columns, sweep.t_ns);
  sweep.begin = recorded.begin;
  sweep.end = recorded.end;
}

}  // namespace tarmac::sim::faults
