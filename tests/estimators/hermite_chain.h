/// A trajectory whose states are linear in its parameters, so that answers are known in closed form.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/parametric_trajectory.h"

namespace tarmac::estimators {

/// Knots of position and velocity, cubic between, the rotation always the identity; the prior is white noise on
/// acceleration (power density q, [m^2/s^3]), and its mean between knots is that cubic.
class HermiteChain final : public core::ParametricTrajectory {
 public:
  HermiteChain(core::Time begin, core::Duration spacing, int knots, double q)
      : begin_(begin), spacing_(spacing), q_(q), knots_(static_cast<std::size_t>(knots), core::Vector6::Zero()) {}

  core::Time begin() const override { return begin_; }
  core::Time end() const override { return begin_ + (blocks() - 1) * spacing_; }
  core::Kinematics at(core::Time t) const override {
    core::StateJet jet;
    this->jet(t, core::Derivative::acceleration, jet);
    return jet.state;
  }
  int block_size() const override { return 6; }
  int blocks() const override { return static_cast<int>(knots_.size()); }
  int reach() const override { return 2; }
  core::Derivative has() const override { return core::Derivative::acceleration; }

  void jet(core::Time t, core::Derivative upto, core::StateJet& jet) const override {
    if (!covers(t)) throw core::OutOfSpan("outside the chain");
    namespace row = core::state_row;
    const int i = std::min(first_block_at(t), blocks() - 2);
    jet.first = 6 * i;
    jet.J.setZero(row::count, 12);
    const auto k = static_cast<std::size_t>(i);
    for (int order = 0; order <= static_cast<int>(upto); ++order) {
      const Eigen::Vector4d w = weights(t, i, order);
      const int rows[] = {row::pose, row::velocity, row::acceleration};
      for (int axis = 0; axis < 3; ++axis) {
        const int r = rows[order] + axis;
        jet.J(r, axis) = w[0];
        jet.J(r, 3 + axis) = w[1];
        jet.J(r, 6 + axis) = w[2];
        jet.J(r, 9 + axis) = w[3];
      }
      const Eigen::Vector3d value = w[0] * knots_[k].head<3>() + w[1] * knots_[k].tail<3>() +
                                    w[2] * knots_[k + 1].head<3>() + w[3] * knots_[k + 1].tail<3>();
      if (order == 0) jet.state.T_world_body = core::SE3(Eigen::Translation3d(value));
      if (order == 1) jet.state.v_world = value;
      if (order == 2) jet.state.a_world = value;
    }
  }
  core::StateVector rate(core::Time t, core::Derivative upto) const override {
    namespace row = core::state_row;
    const int i = std::min(first_block_at(t), blocks() - 2);
    const auto k = static_cast<std::size_t>(i);
    core::StateVector rate = core::StateVector::Zero();
    const int rows[] = {row::pose, row::velocity, row::acceleration};
    for (int order = 0; order <= static_cast<int>(upto); ++order) {
      const Eigen::Vector4d w = weights(t, i, order + 1);
      rate.segment<3>(rows[order]) = w[0] * knots_[k].head<3>() + w[1] * knots_[k].tail<3>() +
                                     w[2] * knots_[k + 1].head<3>() + w[3] * knots_[k + 1].tail<3>();
    }
    return rate;
  }
  void retract(const Eigen::Ref<const Eigen::VectorXd>& step) override {
    for (std::size_t i = 0; i < knots_.size(); ++i) knots_[i] += step.segment<6>(6 * static_cast<Eigen::Index>(i));
  }
  Eigen::VectorXd value(int block) const override { return knots_[static_cast<std::size_t>(block)]; }
  void difference(int block, const Eigen::VectorXd& base, Eigen::VectorXd& d, Eigen::MatrixXd& J) const override {
    d = value(block) - base;
    J = Eigen::MatrixXd::Identity(6, 6);
  }
  int priors() const override { return q_ > 0 ? blocks() - 1 : 0; }
  void prior(int i, core::PriorJet& jet) const override {
    const double h = core::to_s(spacing_);
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    jet.first = 6 * i;
    jet.J.setZero(6, 12);
    jet.J << -I, -h * I, I, 0 * I, 0 * I, -I, 0 * I, I;
    Eigen::VectorXd both(12);
    both << knots_[static_cast<std::size_t>(i)], knots_[static_cast<std::size_t>(i) + 1];
    jet.e = jet.J * both;
    jet.information.resize(6, 6);
    jet.information << 12 / (h * h * h) * I, -6 / (h * h) * I, -6 / (h * h) * I, 4 / h * I;
    jet.information /= q_;
  }
  void extend(core::Time, core::Time end, std::span<const core::Time>) override {
    while (this->end() < end) {
      core::Vector6 next = knots_.back();
      next.head<3>() += core::to_s(spacing_) * next.tail<3>();
      knots_.push_back(next);
    }
  }
  int first_block_at(core::Time t) const override { return static_cast<int>((t - begin_) / spacing_); }
  void drop(int count) override {
    knots_.erase(knots_.begin(), knots_.begin() + count);
    begin_ += count * spacing_;
  }
  core::Segment segment(core::Time, core::Time) const override { throw std::logic_error("a test's trajectory"); }
  std::unique_ptr<core::ParametricTrajectory> clone() const override { return std::make_unique<HermiteChain>(*this); }

 private:
  /// Of (p, v) of both knots, for a derivative by time.
  Eigen::Vector4d weights(core::Time t, int i, int order) const {
    const double h = core::to_s(spacing_), u = core::to_s(t - (begin_ + i * spacing_)) / h;
    Eigen::Vector4d w;
    if (order == 0)
      w << 1 - 3 * u * u + 2 * u * u * u, u - 2 * u * u + u * u * u, 3 * u * u - 2 * u * u * u, u * u * u - u * u;
    if (order == 1) w << -6 * u + 6 * u * u, 1 - 4 * u + 3 * u * u, 6 * u - 6 * u * u, 3 * u * u - 2 * u;
    if (order == 2) w << -6 + 12 * u, -4 + 6 * u, 6 - 12 * u, 6 * u - 2;
    if (order == 3) w << 12, 6, -12, 6;
    w[1] *= h;
    w[3] *= h;
    for (int k = 0; k < order; ++k) w /= h;
    return w;
  }

  core::Time begin_;
  core::Duration spacing_;
  double q_;
  std::vector<core::Vector6> knots_;
};

}  // namespace tarmac::estimators
