#include "sim/faults/losses.h"

#include <algorithm>

namespace tarmac::sim::faults {

using namespace core;

Losses::Losses(const LidarFaultOptions& options, std::uint64_t seed, const std::string& sensor)
    : options_(options),
      sweeps_(seed, sensor + "/faults/lost_sweeps"),
      packets_(seed, sensor + "/faults/lost_packets") {}

bool Losses::sweep_lost(std::int64_t index, Time true_begin) const {
  if (options_.lost_sweeps > 0 && sweeps_.uniform(static_cast<std::uint64_t>(index)) < options_.lost_sweeps)
    return true;
  return std::any_of(options_.sweep_gaps.begin(), options_.sweep_gaps.end(),
                     [&](const Interval& gap) { return gap.holds(to_s(true_begin)); });
}

bool Losses::packet_lost(std::int64_t sweep_index, std::size_t packet) const {
  return options_.lost_packets > 0 && packets_.uniform(static_cast<std::uint64_t>(sweep_index),
                                                       static_cast<std::uint32_t>(packet)) < options_.lost_packets;
}

std::vector<std::uint8_t> Losses::lost_columns(std::int64_t sweep_index, Time true_begin,
                                               const Columns& columns) const {
  const auto packet_columns = static_cast<std::size_t>(options_.packet_columns);
  std::vector<std::uint8_t> lost(columns.size(), 0);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double t_s = to_s(true_begin + Duration(columns.begin_ns[c]));
    const bool in_sector =
        std::any_of(options_.lost_sectors.begin(), options_.lost_sectors.end(),
                    [&](const Sector& s) { return s.when.holds(t_s) && s.holds(columns.azimuth_deg[c]); });
    lost[c] = in_sector || packet_lost(sweep_index, c / packet_columns);
  }
  return lost;
}

}  // namespace tarmac::sim::faults
