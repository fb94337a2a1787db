/// A residual as the record wants it.
#pragma once

#include "core/diagnostics.h"
#include "core/measurements.h"

namespace tarmac::estimators {

/// `point`: index into the sweep; `J`: by the pose at the point's own time (core/diagnostics.h).
inline core::ResidualRow residual_row(const core::LidarSweep& sweep, std::size_t point, double value, double weight,
                                      const core::Row6& J) {
  core::ResidualRow row;
  row.t_ns = sweep.t_ns[point];
  row.value = static_cast<float>(value);
  row.weight = static_cast<float>(weight);
  for (int k = 0; k < 6; ++k) row.jacobian[k] = static_cast<float>(J[k]);
  row.sensor = sweep.sensor_of(point);
  row.point = static_cast<std::uint32_t>(point);
  return row;
}

}  // namespace tarmac::estimators
