#include "core/trajectory.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/gp_segment.h"
#include "core/spline_segment.h"

namespace tarmac::core {
namespace {

[[noreturn]] void out_of_span(Time t, Time begin, Time end) {
  throw OutOfSpan(fmt::format("t = {} ns lies outside [{}, {}] ns", to_ns(t), to_ns(begin), to_ns(end)));
}

/// slerp of rotation, lerp of translation, s in [0, 1].
SE3 slerp_lerp(const SE3& T0, const SE3& T1, double s) {
  SE3 T = SE3::Identity();
  T.linear() = T0.linear() * so3::exp(s * so3::log(T0.linear().transpose() * T1.linear()));
  T.translation() = (1 - s) * T0.translation() + s * T1.translation();
  return T;
}

/// With R = R0 Exp(s w), w = Log(R0^T R1): a right perturbation of R1 moves w by Jr^-1(w) d1, one of R0 by -Jl^-1(w)
/// d0; so R's own right perturbation is s Jr(s w) Jr^-1(w) d1, and (Exp(-s w) - s Jr(s w) Jl^-1(w)) d0. Translations
/// are perturbed in their own pose's axes: p0 <- p0 + R0 rho0.
void slerp_lerp_jacobians(const SE3& T0, const SE3& T1, double s, const SE3& T, Matrix6& J0, Matrix6& J1) {
  const Eigen::Vector3d w = so3::log(T0.linear().transpose() * T1.linear());
  const Eigen::Matrix3d Jr_s = s * so3::right_jacobian(s * w);
  J0.setZero();
  J1.setZero();
  J0.topLeftCorner<3, 3>() = (1 - s) * T.linear().transpose() * T0.linear();
  J1.topLeftCorner<3, 3>() = s * T.linear().transpose() * T1.linear();
  J0.bottomRightCorner<3, 3>() = so3::exp(-s * w) - Jr_s * so3::left_jacobian_inverse(w);
  J1.bottomRightCorner<3, 3>() = Jr_s * so3::right_jacobian_inverse(w);
}

SE3 screw(const SE3& T0, const SE3& T1, double s) {
  return T0 * se3::exp(s * se3::log(T0.inverse() * T1));
}

/// The same chain as for slerp, with the Jacobians of SE(3).
void screw_jacobians(const SE3& T0, const SE3& T1, double s, Matrix6& J0, Matrix6& J1) {
  const Vector6 xi = se3::log(T0.inverse() * T1);
  const Matrix6 Jr_s = s * se3::right_jacobian(s * xi);
  J1 = Jr_s * se3::right_jacobian_inverse(xi);
  J0 = se3::adjoint(se3::exp(-s * xi)) - Jr_s * se3::left_jacobian_inverse(xi);
}

bool is_screw(SegmentModel m) {
  return m == SegmentModel::two_pose_screw || m == SegmentModel::sampled_screw;
}
bool is_held(SegmentModel m) {
  return m == SegmentModel::held || m == SegmentModel::sampled_hold;
}
bool is_sampled(SegmentModel m) {
  return m == SegmentModel::sampled_screw || m == SegmentModel::sampled_slerp || m == SegmentModel::sampled_hold;
}

/// The pair of poses around t, and where t lies between them.
struct Bracket {
  int first = 0, second = 0;
  double s = 0;
};

Bracket bracket(const Segment& segment, Time t) {
  if (t < segment.t0 || t > segment.t1) out_of_span(t, segment.t0, segment.t1);
  if (segment.model == SegmentModel::held) return {};
  if (!is_sampled(segment.model)) return {0, 1, ratio(t, segment.t0, segment.t1)};
  const auto& times = segment.times;
  const auto later = std::upper_bound(times.begin(), times.end(), t);
  if (later == times.end()) {
    const int last = static_cast<int>(times.size()) - 1;
    return {last, last, 0};
  }
  const int second = static_cast<int>(later - times.begin());
  return {second - 1, second, ratio(t, times[second - 1], times[second])};
}

}  // namespace

Segment Segment::two_pose(SegmentModel model, Time t0, const SE3& T0, Time t1, const SE3& T1) {
  if (model != SegmentModel::two_pose_slerp && model != SegmentModel::two_pose_screw) {
    throw std::invalid_argument("two_pose() makes two-pose segments only");
  }
  if (t1 < t0) throw InputError(fmt::format("a segment ends ({} ns) before it begins ({} ns)", to_ns(t1), to_ns(t0)));
  return {t0, t1, model, {T0, T1}, {}};
}

Segment Segment::hold(Time t0, Time t1, const SE3& T) {
  if (t1 < t0) throw InputError(fmt::format("a segment ends ({} ns) before it begins ({} ns)", to_ns(t1), to_ns(t0)));
  return {t0, t1, SegmentModel::held, {T}, {}};
}

Segment Segment::sampled(SegmentModel model, std::vector<Time> times, std::vector<SE3> poses) {
  if (!is_sampled(model)) throw std::invalid_argument("sampled() makes sampled segments only");
  if (times.empty() || times.size() != poses.size()) {
    throw InputError(
        fmt::format("a sampled segment needs as many poses as times, at least one; it has {} poses and {} times",
                    poses.size(), times.size()));
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] <= times[i - 1]) {
      throw InputError(fmt::format("sample {} at {} ns does not come after sample {} at {} ns", i, to_ns(times[i]),
                                   i - 1, to_ns(times[i - 1])));
    }
  }
  const Time first = times.front(), last = times.back();
  return {first, last, model, std::move(poses), std::move(times)};
}

SE3 Segment::pose(Time t) const {
  if (is_spline(model)) return spline_segment_pose(*this, t);
  if (is_gp(model)) return gp_segment_pose(*this, t);
  const Bracket b = bracket(*this, t);
  if (is_held(model) || b.first == b.second) return poses[b.first];
  return is_screw(model) ? screw(poses[b.first], poses[b.second], b.s)
                         : slerp_lerp(poses[b.first], poses[b.second], b.s);
}

SE3 Segment::pose(Time t, std::vector<BlockJacobian>& jacobians) const {
  if (is_spline(model)) return spline_segment_pose(*this, t, jacobians);
  if (is_gp(model)) return gp_segment_pose(*this, t, jacobians);
  const Bracket b = bracket(*this, t);
  jacobians.clear();
  if (is_held(model) || b.first == b.second) {
    jacobians.push_back({b.first, Matrix6::Identity()});
    return poses[b.first];
  }
  const SE3 T = pose(t);
  jacobians.resize(2);
  jacobians[0].block = b.first;
  jacobians[1].block = b.second;
  const SE3 &T0 = poses[b.first], &T1 = poses[b.second];
  if (is_screw(model)) {
    screw_jacobians(T0, T1, b.s, jacobians[0].jacobian, jacobians[1].jacobian);
  } else {
    slerp_lerp_jacobians(T0, T1, b.s, T, jacobians[0].jacobian, jacobians[1].jacobian);
  }
  return T;
}

PiecewiseTrajectory::PiecewiseTrajectory(std::vector<Segment> segments) {
  segments_.reserve(segments.size());
  for (Segment& segment : segments) append(std::move(segment));
}

void PiecewiseTrajectory::append(Segment segment) {
  if (!segments_.empty() && segment.t0 < segments_.back().t1) {
    throw InputError(fmt::format("segment {} begins at {} ns, before its predecessor's end at {} ns", segments_.size(),
                                 to_ns(segment.t0), to_ns(segments_.back().t1)));
  }
  segments_.push_back(std::move(segment));
}

Time PiecewiseTrajectory::begin() const {
  if (segments_.empty()) throw OutOfSpan("an empty trajectory has no begin");
  return segments_.front().t0;
}

Time PiecewiseTrajectory::end() const {
  if (segments_.empty()) throw OutOfSpan("an empty trajectory has no end");
  return segments_.back().t1;
}

const Segment* PiecewiseTrajectory::find(Time t) const {
  auto later = std::upper_bound(segments_.begin(), segments_.end(), t,
                                [](Time time, const Segment& segment) { return time < segment.t0; });
  if (later == segments_.begin()) return nullptr;
  const Segment& segment = *std::prev(later);
  return t <= segment.t1 ? &segment : nullptr;
}

SE3 PiecewiseTrajectory::pose(Time t) const {
  const Segment* segment = find(t);
  if (!segment) {
    throw OutOfSpan(empty() ? std::string("an empty trajectory has no pose")
                            : fmt::format("t = {} ns lies in a gap or outside [{}, {}] ns", to_ns(t), to_ns(begin()),
                                          to_ns(end())));
  }
  return segment->pose(t);
}

}  // namespace tarmac::core
