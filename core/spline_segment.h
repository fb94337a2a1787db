/// Segments that are splines (trajectory.h): their pose, and its Jacobian by their control points.
#pragma once

#include <vector>

#include "core/trajectory.h"

namespace tarmac::core {

inline bool is_spline(SegmentModel model) {
  return model == SegmentModel::spline_split || model == SegmentModel::spline_se3;
}
/// The same bits as SplineTrajectory::pose. Throws OutOfSpan outside [t0, t1], InputError where the segment's knots and
/// control points do not make a spline that covers t.
SE3 spline_segment_pose(const Segment& segment, Time t);
/// Translations of control points are perturbed in their own pose's axes.
SE3 spline_segment_pose(const Segment& segment, Time t, std::vector<BlockJacobian>& jacobians);

}  // namespace tarmac::core
