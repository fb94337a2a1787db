#include "core/sweepwise_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/pose_numbers.h"

namespace tarmac::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void fill_twist_state(const Vector6& twist, Kinematics& state) {
  const Matrix3d R = state.T_world_body.linear();
  const Vector3d nu = twist.head<3>();
  state.omega_body = twist.tail<3>();
  state.v_world = R * nu;
  state.a_world = R * state.omega_body.cross(nu);
}

/// Rows of the world's velocity and acceleration of a body-centric twist (nu, omega) that does not change:
/// v = R nu, a = R (omega x nu); by the pose that R belongs to and by the twist.
void fill_twist_rows(const Kinematics& state, const Vector6& twist, const Eigen::Ref<const Eigen::MatrixXd>& pose_rows,
                     const Eigen::Ref<const Eigen::MatrixXd>& twist_rows, StateJet& jet) {
  const Matrix3d R = state.T_world_body.linear();
  const Vector3d nu = twist.head<3>(), omega = twist.tail<3>();
  const auto rotation = pose_rows.bottomRows<3>();
  jet.J.middleRows<3>(state_row::velocity) = -R * so3::hat(nu) * rotation + R * twist_rows.topRows<3>();
  jet.J.middleRows<3>(state_row::omega) = twist_rows.bottomRows<3>();
  jet.J.middleRows<3>(state_row::acceleration) =
      -R * so3::hat(omega.cross(nu)) * rotation +
      R * (so3::hat(omega) * twist_rows.topRows<3>() - so3::hat(nu) * twist_rows.bottomRows<3>());
}

}  // namespace

SweepwiseTrajectory::SweepwiseTrajectory(SweepwiseModel model, const SE3& T_start) : model_(model), T_start_(T_start) {}

Derivative SweepwiseTrajectory::has() const {
  return model_ == SweepwiseModel::rigid ? Derivative::pose : Derivative::velocity;
}

Time SweepwiseTrajectory::begin() const {
  if (sweeps_.empty()) throw OutOfSpan("a trajectory without a sweep has no begin");
  return sweeps_.front().begin;
}

Time SweepwiseTrajectory::end() const {
  if (sweeps_.empty()) throw OutOfSpan("a trajectory without a sweep has no end");
  return sweeps_.back().end;
}

const SweepwiseTrajectory::Sweep* SweepwiseTrajectory::find(Time t) const {
  const auto later = std::upper_bound(sweeps_.begin(), sweeps_.end(), t,
                                      [](Time time, const Sweep& sweep) { return time < sweep.begin; });
  if (later == sweeps_.begin()) return nullptr;
  const Sweep& sweep = *std::prev(later);
  return t <= sweep.end ? &sweep : nullptr;
}

const SweepwiseTrajectory::Sweep& SweepwiseTrajectory::found(Time t) const {
  const Sweep* sweep = find(t);
  if (sweep == nullptr) throw OutOfSpan(fmt::format("t = {} ns lies in no sweep of the trajectory", to_ns(t)));
  return *sweep;
}

SE3& SweepwiseTrajectory::block(int i) {
  Sweep& sweep = sweeps_[static_cast<std::size_t>(i / poses_a_sweep())];
  return poses_a_sweep() == 2 && i % 2 == 0 ? sweep.first : sweep.last;
}

const SE3& SweepwiseTrajectory::block(int i) const {
  const Sweep& sweep = sweeps_[static_cast<std::size_t>(i / poses_a_sweep())];
  return poses_a_sweep() == 2 && i % 2 == 0 ? sweep.first : sweep.last;
}

Kinematics SweepwiseTrajectory::at(Time t) const {
  StateJet jet_at_t;
  jet(t, Derivative::acceleration, jet_at_t);
  return jet_at_t.state;
}

void SweepwiseTrajectory::jet(Time t, Derivative upto, StateJet& jet) const {
  fill(found(t), t, upto, jet);
}

SE3 SweepwiseTrajectory::pose_in(const Sweep& sweep, Time t) const {
  StateJet jet_at_t;
  fill(sweep, t, Derivative::pose, jet_at_t);
  return jet_at_t.state.T_world_body;
}

void SweepwiseTrajectory::fill(const Sweep& sweep, Time t, Derivative upto, StateJet& jet) const {
  jet.first = 6 * poses_a_sweep() * static_cast<int>(&sweep - sweeps_.data());
  jet.state = {};
  jet.J.setZero(state_row::count, 6 * poses_a_sweep());
  switch (model_) {
    case SweepwiseModel::rigid:
      jet.state.T_world_body = sweep.last;
      jet.J.topRows<6>().setIdentity();
      return;
    case SweepwiseModel::constant_velocity:
      return fill_constant_velocity(sweep, t, upto, jet);
    case SweepwiseModel::two_pose_screw:
      return fill_screw(sweep, t, upto, jet);
    case SweepwiseModel::two_pose_slerp:
      return fill_slerp(sweep, t, jet);
  }
}

void SweepwiseTrajectory::fill_constant_velocity(const Sweep& sweep, Time t, Derivative upto, StateJet& jet) {
  const SE3 step = se3::exp(to_s(t - sweep.end) * sweep.twist);
  jet.state.T_world_body = sweep.last * step;
  jet.J.topRows<6>() = se3::adjoint(step.inverse());
  fill_twist_state(sweep.twist, jet.state);
  if (upto != Derivative::pose)
    fill_twist_rows(jet.state, sweep.twist, Matrix6(jet.J.topRows<6>()), Matrix6::Zero(), jet);
}

void SweepwiseTrajectory::fill_screw(const Sweep& sweep, Time t, Derivative upto, StateJet& jet) {
  const double s = ratio(t, sweep.begin, sweep.end);
  const double per_s = sweep.end > sweep.begin ? 1 / to_s(sweep.end - sweep.begin) : 0;
  const Vector6 xi = se3::log(sweep.first.inverse() * sweep.last);
  const SE3 step = se3::exp(s * xi);
  jet.state.T_world_body = sweep.first * step;
  const Matrix6 Jr_s = s * se3::right_jacobian(s * xi);
  const Matrix6 by_last = se3::right_jacobian_inverse(xi), by_first = -se3::left_jacobian_inverse(xi);
  jet.J.topLeftCorner<6, 6>() = se3::adjoint(step.inverse()) + Jr_s * by_first;
  jet.J.topRightCorner<6, 6>() = Jr_s * by_last;
  fill_twist_state(per_s * xi, jet.state);
  if (upto == Derivative::pose) return;
  Eigen::Matrix<double, 6, 12> twist_rows;
  twist_rows << per_s * by_first, per_s * by_last;
  fill_twist_rows(jet.state, per_s * xi, Eigen::Matrix<double, 6, 12>(jet.J.topRows<6>()), twist_rows, jet);
}

void SweepwiseTrajectory::fill_slerp(const Sweep& sweep, Time t, StateJet& jet) {
  const double per_s = sweep.end > sweep.begin ? 1 / to_s(sweep.end - sweep.begin) : 0;
  std::vector<BlockJacobian> by_pose;
  jet.state.T_world_body =
      Segment::two_pose(SegmentModel::two_pose_slerp, sweep.begin, sweep.first, sweep.end, sweep.last).pose(t, by_pose);
  jet.J.topLeftCorner<6, 6>() = by_pose[0].jacobian;
  jet.J.topRightCorner<6, 6>() = by_pose[1].jacobian;
  const Vector3d w = so3::log(sweep.first.linear().transpose() * sweep.last.linear());
  jet.state.omega_body = per_s * w;
  jet.state.v_world = per_s * (sweep.last.translation() - sweep.first.translation());
  jet.J.block<3, 3>(state_row::velocity, 0) = -per_s * sweep.first.linear();
  jet.J.block<3, 3>(state_row::velocity, 6) = per_s * sweep.last.linear();
  jet.J.block<3, 3>(state_row::omega, 3) = -per_s * so3::left_jacobian_inverse(w);
  jet.J.block<3, 3>(state_row::omega, 9) = per_s * so3::right_jacobian_inverse(w);
}

StateVector SweepwiseTrajectory::rate(Time t, Derivative) const {
  const Kinematics k = at(t);
  StateVector rate = StateVector::Zero();
  if (model_ == SweepwiseModel::rigid) return rate;
  const Matrix3d R = k.T_world_body.linear();
  rate.segment<3>(state_row::pose) = R.transpose() * k.v_world;
  rate.segment<3>(state_row::pose + 3) = k.omega_body;
  rate.segment<3>(state_row::velocity) = k.a_world;
  // Body-centric acceleration omega x nu does not change: the world's turns with the body.
  rate.segment<3>(state_row::acceleration) = R * k.omega_body.cross(R.transpose() * k.a_world);
  return rate;
}

void SweepwiseTrajectory::retract(const Eigen::Ref<const Eigen::VectorXd>& step) {
  if (step.size() != parameters()) throw std::invalid_argument("a step must have as many entries as parameters");
  for (int i = 0; i < blocks(); ++i) {
    SE3& T = block(i);
    T = se3::normalized(T * se3::exp(step.segment<6>(6 * i)));
  }
  if (poses_a_sweep() == 1)
    for (Sweep& sweep : sweeps_) sweep.first = sweep.last;
}

Eigen::VectorXd SweepwiseTrajectory::value(int i) const {
  return numbers_of(block(i));
}

void SweepwiseTrajectory::difference(int i, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const {
  const Vector6 xi = se3::log(pose_of(base).inverse() * block(i));
  d = xi;
  J = se3::right_jacobian_inverse(xi);
}

Vector6 SweepwiseTrajectory::last_twist() const {
  // The last two sweeps, dropped ones included.
  std::vector<const Sweep*> known;
  for (const Sweep& sweep : before_) known.push_back(&sweep);
  for (const Sweep& sweep : sweeps_) known.push_back(&sweep);
  if (known.empty()) return Vector6::Zero();
  const Sweep& last = *known.back();
  if (poses_a_sweep() == 2) {
    const double span_s = to_s(last.end - last.begin);
    return span_s > 0 ? Vector6(se3::log(last.first.inverse() * last.last) / span_s) : Vector6(Vector6::Zero());
  }
  if (known.size() < 2) return Vector6::Zero();
  const Sweep& earlier = *known[known.size() - 2];
  const double span_s = to_s(last.end - earlier.end);
  return span_s > 0 ? Vector6(se3::log(earlier.last.inverse() * last.last) / span_s) : Vector6(Vector6::Zero());
}

void SweepwiseTrajectory::extend(Time begin, Time end, std::span<const Time>) {
  const Sweep* last = !sweeps_.empty() ? &sweeps_.back() : (!before_.empty() ? &before_.back() : nullptr);
  if (end < begin || (last != nullptr && begin < last->end)) {
    throw InputError(fmt::format("a sweep from {} to {} ns does not follow the one before", to_ns(begin), to_ns(end)));
  }
  const Vector6 twist = last_twist();
  const SE3 T_last = last != nullptr ? last->last : T_start_;
  const Time t_last = last != nullptr ? last->end : begin;
  Sweep sweep{begin, end, SE3::Identity(), se3::normalized(T_last * se3::exp(to_s(end - t_last) * twist)), twist};
  sweep.first = poses_a_sweep() == 2 ? se3::normalized(T_last * se3::exp(to_s(begin - t_last) * twist)) : sweep.last;
  sweeps_.push_back(sweep);
}

int SweepwiseTrajectory::first_block_at(Time t) const {
  std::size_t gone = 0;
  for (; gone < sweeps_.size(); ++gone) {
    // A boundary instant belongs to the later sweep, where there is one that begins there.
    const bool next_begins = gone + 1 < sweeps_.size() && sweeps_[gone + 1].begin == t;
    if (sweeps_[gone].end > t || (sweeps_[gone].end == t && !next_begins)) break;
  }
  return static_cast<int>(gone) * poses_a_sweep();
}

void SweepwiseTrajectory::drop(int count) {
  if (count % poses_a_sweep() != 0) throw std::invalid_argument("only whole sweeps may be dropped");
  for (int i = 0; i < count / poses_a_sweep(); ++i) {
    before_.push_back(sweeps_.front());
    sweeps_.erase(sweeps_.begin());
    if (before_.size() > 2) before_.erase(before_.begin());
  }
}

Segment SweepwiseTrajectory::segment(Time t0, Time t1) const {
  const Sweep& sweep = found(t0);
  if (t1 > sweep.end) throw OutOfSpan(fmt::format("the sweep of {} ns ends before {} ns", to_ns(t0), to_ns(t1)));
  if (model_ == SweepwiseModel::rigid) return Segment::hold(t0, t1, sweep.last);
  const SegmentModel model =
      model_ == SweepwiseModel::two_pose_slerp ? SegmentModel::two_pose_slerp : SegmentModel::two_pose_screw;
  // At t1 the next sweep may begin: asked is this one's end.
  return Segment::two_pose(model, t0, pose_in(sweep, t0), t1, pose_in(sweep, t1));
}

std::unique_ptr<ParametricTrajectory> SweepwiseTrajectory::clone() const {
  return std::make_unique<SweepwiseTrajectory>(*this);
}

}  // namespace tarmac::core
