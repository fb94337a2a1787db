/// One residual, linearised: what any of them looks like to a solver.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/parametric_trajectory.h"
#include "estimators/blocks/robust_loss.h"

namespace tarmac::estimators {

/// A whitened residual e with its Jacobians by a run of the band and by a few columns of the border. Its cost is
/// rho(|e|^2) / 2 where it has a loss, |e|^2 / 2 else.
struct Term {
  static constexpr int kMaxRows = core::state_row::count;
  static constexpr int kMaxBorders = 4;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1>;
  using Band =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRows, core::StateJet::kMaxColumns>;
  using BorderColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRows, 6>;
  struct Border {
    int column = 0;
    BorderColumns J;
  };

  Rows e;
  int first = 0;
  Band J;  ///< no columns: nothing of the band
  int borders = 0;
  std::array<Border, kMaxBorders> border;
  const RobustLoss* loss = nullptr;

  void clear(int rows) {
    e.setZero(rows);
    first = 0;
    J.resize(rows, 0);
    borders = 0;
    loss = nullptr;
  }
  BorderColumns& add_border(int column, int columns) {
    Border& part = border[static_cast<std::size_t>(borders++)];
    part.column = column;
    part.J.setZero(e.size(), columns);
    return part.J;
  }
  RobustLoss::Value rho() const {
    const double s = e.squaredNorm();
    return loss == nullptr ? RobustLoss::Value{s, 1, 0} : (*loss)(s);
  }
};

}  // namespace tarmac::estimators
