/// What the stamps of points look like by themselves: span, order, and how many points share one.
#pragma once

#include <vector>

#include "core/measurements.h"
#include "metrics/sweep_source.h"

namespace tarmac::metrics {

/// Medians over sweeps.
struct StampFacts {
  std::size_t sweeps = 0;       ///< looked at
  double span_share = 0;        ///< last minus first stamp, over the sweep's duration
  double distinct = 0;          ///< different stamps a sweep
  double gap_s = 0;             ///< median step from one stamp to the next larger one
  double descending_share = 0;  ///< of steps from point to point that are not 0, those downwards
  /// How far the head turns within one stamp, over how far it turns from one stamp to the next: near 1 where stamps
  /// stand still while the sensor goes on (quantised), 0 where points that share a stamp were fired together.
  double turn_share = 0;
  bool quantised() const { return turn_share > 0.3; }
};
StampFacts stamp_facts(const SweepSource& sweeps);

/// Per finite point, in order: its place among the points with the same stamp, in (0, 1) by order of firing.
std::vector<float> place_within_stamp(const core::LidarSweep& sweep);

}  // namespace tarmac::metrics
