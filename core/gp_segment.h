/// Segments of Gaussian processes: parameters out of a trajectory's knots, and poses out of a segment's.
#pragma once

#include <vector>

#include "core/trajectory.h"

namespace tarmac::core {

constexpr bool is_gp(SegmentModel m) {
  return m == SegmentModel::gp_wnoa || m == SegmentModel::gp_wnoj || m == SegmentModel::gp_singer;
}

/// The pose at t within the segment's knots. Jacobians by the poses of the two knots around t, velocities and their
/// derivatives held; at a knot by that knot alone.
SE3 gp_segment_pose(const Segment& segment, Time t);
SE3 gp_segment_pose(const Segment& segment, Time t, std::vector<BlockJacobian>& jacobians);

}  // namespace tarmac::core
