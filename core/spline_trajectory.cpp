#include "core/spline_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/pose_numbers.h"

namespace tarmac::core {
namespace {

void check_ascending(std::span<const Time> knots) {
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] <= knots[i - 1]) {
      throw InputError(
          fmt::format("a spline's knots must ascend: knot {} at {} ns does not come after the one at {} ns", i,
                      to_ns(knots[i]), to_ns(knots[i - 1])));
    }
  }
}

void check(int order, const std::vector<SE3>& control, const std::vector<Time>& knots) {
  if (order < kMinSplineOrder || order > kMaxSplineOrder) {
    throw InputError(fmt::format("a spline's order is {} to {}, not {}", kMinSplineOrder, kMaxSplineOrder, order));
  }
  const auto k = static_cast<std::size_t>(order);
  if (control.size() < k || knots.size() != control.size() + k) {
    throw InputError(
        fmt::format("a spline of order {} needs at least {} control points and {} more knots than those; it has {} "
                    "control points and {} knots",
                    order, order, order, control.size(), knots.size()));
  }
  check_ascending(knots);
  for (std::size_t i = 0; i < control.size(); ++i) {
    if (!se3::all_finite(control[i])) throw InputError(fmt::format("control point {} is not finite", i));
  }
}

/// The motion from one control point to the next, gone on with `ratio` times as far.
SE3 continued(SplineKind kind, const SE3& before, const SE3& last, double ratio) {
  if (kind == SplineKind::se3) return se3::normalized(last * se3::exp(ratio * se3::log(before.inverse() * last)));
  SE3 T = SE3::Identity();
  T.linear() = last.linear() * so3::exp(ratio * so3::log(before.linear().transpose() * last.linear()));
  T.translation() = last.translation() + ratio * (last.translation() - before.translation());
  return se3::normalized(T);
}

SE3 retracted(SplineKind kind, const SE3& T, const Vector6& step) {
  if (kind == SplineKind::se3) return se3::normalized(T * se3::exp(step));
  SE3 moved = SE3::Identity();
  moved.linear() = T.linear() * so3::exp(step.tail<3>());
  moved.translation() = T.translation() + step.head<3>();
  return se3::normalized(moved);
}

}  // namespace

double greville_ns_after(Time origin, std::span<const Time> knots, int order, int control_point) {
  double sum_ns = 0;
  for (int i = 1; i < order; ++i) {
    sum_ns += static_cast<double>((knots[static_cast<std::size_t>(control_point + i)] - origin).count());
  }
  return sum_ns / (order - 1);
}

SplineTrajectory::SplineTrajectory(SplineKind kind, int order, std::vector<SE3> control_points, std::vector<Time> knots)
    : kind_(kind), order_(order), control_(std::move(control_points)), knots_(std::move(knots)) {
  check(order_, control_, knots_);
  for (SE3& T : control_) T = se3::normalized(T);
  refresh(0);
}

SplineTrajectory SplineTrajectory::at_rest(SplineKind kind, int order, const SE3& T_world_body,
                                           std::vector<Time> knots) {
  const std::size_t margin = static_cast<std::size_t>(std::max(order, 0));
  const std::size_t n = knots.size() > margin ? knots.size() - margin : 0;
  return {kind, order, std::vector<SE3>(n, T_world_body), std::move(knots)};
}

/// Everything that depends on the control points from `first_control` on, or on knots that came with them.
void SplineTrajectory::refresh(std::size_t first_control) {
  const std::size_t n = control_.size(), k = static_cast<std::size_t>(order_);
  steps_.resize(n - 1);
  step_jacobians_.resize(n - 1);
  for (std::size_t i = first_control > 0 ? first_control - 1 : 0; i + 1 < n; ++i) {
    steps_[i] = spline_step(kind_, control_[i], control_[i + 1]);
    step_jacobians_[i] = spline_step_jacobians(kind_, control_[i], control_[i + 1]);
  }
  intervals_.resize(n - k + 1);
  const std::span<const Time> knots(knots_);
  const std::span<const SE3> control(control_);
  for (std::size_t i = first_control >= k ? first_control - k + 1 : 0; i < intervals_.size(); ++i) {
    intervals_[i] = spline_interval(kind_, order_, knots.subspan(i + 1, 2 * k - 2), control.subspan(i, k));
  }
}

int SplineTrajectory::interval_at(Time t) const {
  if (!covers(t)) {
    throw OutOfSpan(
        fmt::format("t = {} ns lies outside the spline's span [{}, {}] ns", to_ns(t), to_ns(begin()), to_ns(end())));
  }
  const auto first = knots_.begin() + order_ - 1;
  return static_cast<int>(std::upper_bound(first, knots_.end(), t) - first) - 1;
}

SplineView SplineTrajectory::view(int interval) const {
  const auto i = static_cast<std::size_t>(interval);
  return {kind_, order_, &intervals_[i], &steps_[i], &step_jacobians_[i]};
}

SE3 SplineTrajectory::pose(Time t) const {
  const int i = interval_at(t);
  return spline_pose(view(i), intervals_[static_cast<std::size_t>(i)].u(t));
}

Kinematics SplineTrajectory::at(Time t) const {
  const int i = interval_at(t);
  return spline_kinematics(view(i), intervals_[static_cast<std::size_t>(i)].u(t));
}

void SplineTrajectory::jet(Time t, Derivative upto, StateJet& jet) const {
  const int i = interval_at(t);
  jet.first = 6 * i;
  spline_jet(view(i), intervals_[static_cast<std::size_t>(i)].u(t), upto, jet);
}

StateVector SplineTrajectory::rate(Time t, Derivative upto) const {
  const int i = interval_at(t);
  return spline_rate(view(i), intervals_[static_cast<std::size_t>(i)].u(t), upto);
}

void SplineTrajectory::poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const {
  if (ascending.empty()) return;
  const int i = interval_at(ascending.front());
  interval_at(ascending.back());
  spline_poses(view(i), &intervals_.back(), ascending, T_world_body);
}

void SplineTrajectory::retract(const Eigen::Ref<const Eigen::VectorXd>& step) {
  if (step.size() != parameters()) {
    throw std::invalid_argument(fmt::format("a step of {} for {} parameters", step.size(), parameters()));
  }
  if (!step.allFinite()) throw std::domain_error("a step of a spline's control points is not finite");
  for (std::size_t i = 0; i < control_.size(); ++i) {
    const Vector6 own = step.segment<6>(6 * static_cast<Eigen::Index>(i));
    // Normalising moves last digits; what does not move keeps all of them.
    if (!own.isZero(0)) control_[i] = retracted(kind_, control_[i], own);
  }
  refresh(0);
}

Eigen::VectorXd SplineTrajectory::value(int block) const {
  return numbers_of(control_.at(static_cast<std::size_t>(block)));
}

void SplineTrajectory::difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d,
                                  Eigen::MatrixXd& J) const {
  const SE3& T = control_.at(static_cast<std::size_t>(block));
  const SE3 T_base = pose_of(base);
  d.resize(6);
  J.setZero(6, 6);
  if (kind_ == SplineKind::se3) {
    const Vector6 xi = se3::log(T_base.inverse() * T);
    d = xi;
    J = se3::right_jacobian_inverse(xi);
    return;
  }
  const Eigen::Vector3d phi = so3::log(T_base.linear().transpose() * T.linear());
  d << T.translation() - T_base.translation(), phi;
  J.topLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<3, 3>() = so3::right_jacobian_inverse(phi);
}

void SplineTrajectory::extend(Time begin, Time end, std::span<const Time> knots) {
  if (begin < this->begin()) {
    throw InputError(fmt::format("a spline that begins at {} ns cannot be extended to begin at {} ns",
                                 to_ns(this->begin()), to_ns(begin)));
  }
  check_ascending(knots);
  for (const Time t : knots) {
    if (t > knots_.back()) knots_.push_back(t);
  }
  const std::size_t before = control_.size(), k = static_cast<std::size_t>(order_);
  while (knots_[knots_.size() - k] <= end)
    knots_.push_back(knots_.back() + (knots_.back() - knots_[knots_.size() - 2]));
  while (control_.size() + k < knots_.size()) {
    const int n = blocks();
    const Time origin = knots_[control_.size()];
    const auto greville = [&](int i) { return greville_ns_after(origin, knots_, order_, i); };
    const double ratio = (greville(n) - greville(n - 1)) / (greville(n - 1) - greville(n - 2));
    control_.push_back(continued(kind_, control_[control_.size() - 2], control_.back(), ratio));
  }
  refresh(before);
}

int SplineTrajectory::first_block_at(Time t) const {
  const int last_knot_at = static_cast<int>(std::upper_bound(knots_.begin(), knots_.end(), t) - knots_.begin()) - 1;
  return std::clamp(last_knot_at - order_ + 1, 0, blocks());
}

void SplineTrajectory::drop(int count) {
  if (count < 0 || count > blocks() - order_) {
    throw std::invalid_argument(
        fmt::format("cannot drop {} of {} control points of a spline of order {}", count, blocks(), order_));
  }
  control_.erase(control_.begin(), control_.begin() + count);
  knots_.erase(knots_.begin(), knots_.begin() + count);
  steps_.erase(steps_.begin(), steps_.begin() + count);
  step_jacobians_.erase(step_jacobians_.begin(), step_jacobians_.begin() + count);
  intervals_.erase(intervals_.begin(), intervals_.begin() + count);
}

Segment SplineTrajectory::segment(Time t0, Time t1) const {
  if (t1 < t0) throw InputError(fmt::format("a segment ends ({} ns) before it begins ({} ns)", to_ns(t1), to_ns(t0)));
  const int first = interval_at(t0), last = interval_at(t1);
  Segment segment;
  segment.t0 = t0;
  segment.t1 = t1;
  segment.model = kind_ == SplineKind::split ? SegmentModel::spline_split : SegmentModel::spline_se3;
  segment.poses.assign(control_.begin() + first, control_.begin() + last + order_);
  segment.times.assign(knots_.begin() + first, knots_.begin() + last + 2 * order_);
  return segment;
}

}  // namespace tarmac::core
