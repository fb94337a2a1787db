#include "core/gp_segment.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/gp_trajectory.h"

namespace tarmac::core {
namespace {

GpPrior prior_of(const Segment& s) {
  GpPrior prior;
  prior.model = s.model == SegmentModel::gp_wnoa   ? GpModel::wnoa
                : s.model == SegmentModel::gp_wnoj ? GpModel::wnoj
                                                   : GpModel::singer;
  if (s.model == SegmentModel::gp_singer) prior.rate = s.twists.back();
  return prior;
}

GpKnot knot_of(const Segment& s, std::size_t i) {
  GpKnot knot{s.times[i], s.poses[i], s.twists[i]};
  if (s.model != SegmentModel::gp_wnoa) knot.dvarpi = s.twists[s.poses.size() + i];
  return knot;
}

/// The knot at or before t; the last one only where t is at it or beyond.
std::size_t knot_before(const Segment& s, Time t) {
  if (t < s.t0 || t > s.t1 || t < s.times.front() || t > s.times.back()) {
    throw OutOfSpan(fmt::format("t = {} ns lies outside [{}, {}] ns", to_ns(t), to_ns(s.t0), to_ns(s.t1)));
  }
  return static_cast<std::size_t>(std::upper_bound(s.times.begin(), s.times.end(), t) - s.times.begin()) - 1;
}

GpInterval interval_of(const Segment& s, std::size_t i) {
  const GpPrior prior = prior_of(s);
  return {prior.model, group_axes(prior), knot_of(s, i), knot_of(s, i + 1)};
}

}  // namespace

SE3 gp_segment_pose(const Segment& s, Time t) {
  const std::size_t i = knot_before(s, t);
  return t == s.times[i] ? s.poses[i] : interval_of(s, i).pose(to_s(t - s.times[i]));
}

SE3 gp_segment_pose(const Segment& s, Time t, std::vector<BlockJacobian>& jacobians) {
  const std::size_t i = knot_before(s, t);
  const int block = static_cast<int>(i);
  if (t == s.times[i]) {
    jacobians = {{block, Matrix6::Identity()}};
    return s.poses[i];
  }
  const GpInterval interval = interval_of(s, i);
  const double d = to_s(t - s.times[i]);
  GpKnot state;
  const GpJacobian J = GpIntervalJacobian(interval, knot_of(s, i + 1)).state(interval, d, Derivative::pose, state);
  jacobians = {{block, J.topLeftCorner<6, 6>()}, {block + 1, J.block<6, 6>(0, J.cols() / 2)}};
  return state.T_world_body;
}

GpTrajectory GpTrajectory::from_segment(const Segment& segment, const Vector6& qc) {
  if (!is_gp(segment.model)) throw std::invalid_argument("from_segment() takes segments of Gaussian processes only");
  GpPrior prior = prior_of(segment);
  prior.qc = qc;
  std::vector<GpKnot> knots;
  for (std::size_t i = 0; i < segment.poses.size(); ++i) knots.push_back(knot_of(segment, i));
  return {prior, std::move(knots)};
}

Segment GpTrajectory::segment(Time t0, Time t1) const {
  check_span(t0);
  check_span(t1);
  if (t1 < t0) throw InputError(fmt::format("a segment ends ({} ns) before it begins ({} ns)", to_ns(t1), to_ns(t0)));
  if (blocks() < 2) throw std::logic_error("a segment of a Gaussian process needs two knots");
  // The last interval holds at the last knot too.
  const std::size_t first = std::min(interval_at(t0), intervals_.size() - 1);
  std::size_t last = interval_at(t1);
  if (knots_[last].t < t1 || last == first) ++last;
  Segment s;
  s.t0 = t0;
  s.t1 = t1;
  s.model = prior_.model == GpModel::wnoa   ? SegmentModel::gp_wnoa
            : prior_.model == GpModel::wnoj ? SegmentModel::gp_wnoj
                                            : SegmentModel::gp_singer;
  for (std::size_t i = first; i <= last; ++i) {
    s.poses.push_back(knots_[i].T_world_body);
    s.times.push_back(knots_[i].t);
    s.twists.push_back(knots_[i].varpi);
  }
  if (prior_.model != GpModel::wnoa) {
    for (std::size_t i = first; i <= last; ++i) s.twists.push_back(knots_[i].dvarpi);
  }
  if (prior_.model == GpModel::singer) s.twists.push_back(prior_.rate);
  return s;
}

}  // namespace tarmac::core
