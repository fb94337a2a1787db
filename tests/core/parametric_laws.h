/// What holds for every trajectory with parameters, tested by numeric differentiation.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/parametric_trajectory.h"

namespace tarmac::core {

/// The difference of two states in the tangent of the first: b = a (+) d.
inline StateVector state_difference(const Kinematics& a, const Kinematics& b) {
  StateVector d;
  d << se3::log(a.T_world_body.inverse() * b.T_world_body), b.v_world - a.v_world, b.omega_body - a.omega_body,
      b.a_world - a.a_world, b.alpha_body - a.alpha_body;
  return d;
}

/// Every column of the jet at t against central differences, and columns outside its run against zero.
inline void expect_exact_jet(const ParametricTrajectory& trajectory, Time t, double tolerance = 1e-6) {
  StateJet jet;
  trajectory.jet(t, trajectory.has(), jet);
  const int rows = state_row::filled(trajectory.has());
  const double h = 1e-5;
  EXPECT_LT(state_difference(jet.state, trajectory.at(t)).norm(), 1e-9);
  for (int j = 0; j < trajectory.parameters(); ++j) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(trajectory.parameters());
    const auto plus = trajectory.clone(), minus = trajectory.clone();
    step[j] = h;
    plus->retract(step);
    step[j] = -h;
    minus->retract(step);
    const StateVector numeric =
        (state_difference(jet.state, plus->at(t)) - state_difference(jet.state, minus->at(t))) / (2 * h);
    const int column = j - jet.first;
    const bool inside = column >= 0 && column < jet.columns();
    for (int r = 0; r < rows; ++r) {
      const double analytic = inside ? jet.J(r, column) : 0.0;
      EXPECT_NEAR(analytic, numeric[r], tolerance * std::max(1.0, std::abs(analytic)))
          << "row " << r << " by parameter " << j << " at " << to_ns(t) << " ns";
    }
  }
}

/// d(state)/dt by central differences.
inline void expect_exact_rate(const ParametricTrajectory& trajectory, Time t, double tolerance = 1e-5) {
  const Duration h(100'000);
  const Kinematics k = trajectory.at(t);
  const StateVector numeric =
      (state_difference(k, trajectory.at(t + h)) - state_difference(k, trajectory.at(t - h))) / (2 * to_s(h));
  const StateVector rate = trajectory.rate(t, trajectory.has());
  for (int r = 0; r < state_row::filled(trajectory.has()); ++r)
    EXPECT_NEAR(rate[r], numeric[r], tolerance * std::max(1.0, std::abs(rate[r]))) << "row " << r;
}

/// value/difference/retract belong together.
inline void expect_consistent_difference(const ParametricTrajectory& trajectory) {
  const int n = trajectory.block_size();
  const auto moved = trajectory.clone();
  Eigen::VectorXd step(trajectory.parameters());
  for (Eigen::Index i = 0; i < step.size(); ++i) step[i] = 0.1 * std::sin(1.7 * static_cast<double>(i) + 0.3);
  moved->retract(step);
  for (int block = 0; block < trajectory.blocks(); ++block) {
    const Eigen::VectorXd base = trajectory.value(block);
    Eigen::VectorXd d;
    Eigen::MatrixXd J;
    moved->difference(block, base, d, J);
    EXPECT_LT((d - step.segment(n * block, n)).norm(), 1e-10) << "block " << block;
    for (int j = 0; j < n; ++j) {
      const double h = 1e-5;
      Eigen::VectorXd plus_d, minus_d, further = Eigen::VectorXd::Zero(trajectory.parameters());
      Eigen::MatrixXd unused;
      const auto plus = moved->clone(), minus = moved->clone();
      further[n * block + j] = h;
      plus->retract(further);
      further[n * block + j] = -h;
      minus->retract(further);
      plus->difference(block, base, plus_d, unused);
      minus->difference(block, base, minus_d, unused);
      EXPECT_LT((J.col(j) - (plus_d - minus_d) / (2 * h)).norm(), 1e-7) << "block " << block << ", column " << j;
    }
  }
}

}  // namespace tarmac::core
