#include "core/spline_segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/error.h"
#include "core/spline_interval.h"

namespace tarmac::core {
namespace {

/// The interval of a segment that a time falls into.
struct Piece {
  SplineKind kind;
  int order = 0;
  int first = 0;  ///< its first control point
  std::span<const SE3> control;
  SplineInterval interval;
  SplineStep steps[kMaxSplineOrder - 1];
};

Piece piece_at(const Segment& segment, Time t) {
  if (t < segment.t0 || t > segment.t1) {
    throw OutOfSpan(fmt::format("t = {} ns lies outside [{}, {}] ns", to_ns(t), to_ns(segment.t0), to_ns(segment.t1)));
  }
  const auto n = static_cast<std::ptrdiff_t>(segment.poses.size());
  const auto k = static_cast<std::ptrdiff_t>(segment.times.size()) - n;
  if (k < kMinSplineOrder || k > kMaxSplineOrder || n < k) {
    throw InputError(
        fmt::format("a spline segment has {} control points and {} knots; it needs 4 to 6 more knots than "
                    "control points, and as many control points as that",
                    segment.poses.size(), segment.times.size()));
  }
  const auto knots = segment.times.begin();
  if (t < knots[k - 1] || t >= knots[n]) {
    throw InputError(fmt::format("a spline segment over [{}, {}] ns has knots for [{}, {}) ns only", to_ns(segment.t0),
                                 to_ns(segment.t1), to_ns(knots[k - 1]), to_ns(knots[n])));
  }
  Piece piece;
  piece.kind = segment.model == SegmentModel::spline_split ? SplineKind::split : SplineKind::se3;
  piece.order = static_cast<int>(k);
  const auto first = static_cast<std::size_t>(std::upper_bound(knots + k, knots + n, t) - (knots + k));
  piece.first = static_cast<int>(first);
  const auto count = static_cast<std::size_t>(k);
  piece.control = std::span<const SE3>(segment.poses).subspan(first, count);
  piece.interval = spline_interval(
      piece.kind, piece.order, std::span<const Time>(segment.times).subspan(first + 1, 2 * count - 2), piece.control);
  for (std::size_t j = 0; j + 1 < count; ++j) {
    piece.steps[j] = spline_step(piece.kind, piece.control[j], piece.control[j + 1]);
  }
  return piece;
}

}  // namespace

SE3 spline_segment_pose(const Segment& segment, Time t) {
  const Piece piece = piece_at(segment, t);
  return spline_pose({piece.kind, piece.order, &piece.interval, piece.steps}, piece.interval.u(t));
}

SE3 spline_segment_pose(const Segment& segment, Time t, std::vector<BlockJacobian>& jacobians) {
  const Piece piece = piece_at(segment, t);
  SplineStepJacobians step_jacobians[kMaxSplineOrder - 1];
  const auto count = static_cast<std::size_t>(piece.order);
  for (std::size_t j = 0; j + 1 < count; ++j) {
    step_jacobians[j] = spline_step_jacobians(piece.kind, piece.control[j], piece.control[j + 1]);
  }
  StateJet jet;
  spline_jet({piece.kind, piece.order, &piece.interval, piece.steps, step_jacobians}, piece.interval.u(t),
             Derivative::pose, jet);
  jacobians.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Matrix6& J = jacobians[i].jacobian;
    jacobians[i].block = piece.first + static_cast<int>(i);
    J = jet.J.block<6, 6>(state_row::pose, 6 * static_cast<Eigen::Index>(i));
    // The spline moves positions along the world's axes.
    if (piece.kind == SplineKind::split) J.leftCols<3>() *= piece.control[i].linear();
  }
  return jet.state.T_world_body;
}

}  // namespace tarmac::core
