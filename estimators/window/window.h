/// A stretch of continuous-time motion with everything that is known of it: the problem that all sliding-window and
/// batch methods of this folder's users solve.
///
/// Unknowns: the trajectory's parameters (a band), and a border of what acts on all of it: IMU biases at bias knots,
/// gravity's direction, the IMU's time offset. Residuals know their Jacobian by the state at their time
/// (core/parametric_trajectory.h); the window chains the two.
#pragma once

#include <cstdint>
#include <vector>

#include "estimators/window/banded_system.h"
#include "estimators/window/lidar_factors.h"
#include "estimators/window/window_model.h"
#include "estimators/window/window_problem.h"
#include "estimators/window/window_state.h"

namespace tarmac::estimators {

/// How tightly Marginalisation::fix holds, in each parameter's own unit.
inline constexpr double kFixedSigma = 1e-5;

enum class Marginalisation : std::uint8_t {
  plain,       ///< Schur complement as it stands
  eigenvalue,  ///< directions with an eigenvalue below a threshold carry no information
  fix,         ///< what leaves the window is held where it is: no information goes on but the states' values. Blocks
               ///< that shared a residual with those that left are held there by a prior of deviation kFixedSigma, and
               ///< so is the first bias knot that stays, if others left; the rest of the border goes on free
};

struct SolveSettings {
  bool levenberg_marquardt = false;  ///< else Gauss-Newton
  int max_iterations = 5;
  double initial_lambda = 1e-4;
  bool line_search = false;  ///< Gauss-Newton: halve a step up to three times where the cost does not fall; if it
                             ///< does not fall then either, stay and end
  double relative_decrease = 1e-4, absolute_decrease = 1e-4;  ///< of the cost, below which it ends
  bool lidar = true;                                          ///< false: IMU and priors alone, for a prediction
};

/// Gauss-Newton takes every step whose cost is finite (halving it up to three times until it is); Levenberg-Marquardt
/// those whose cost falls, and raises lambda by 10 else.
struct SolveReport {
  int iterations = 0;  ///< steps worked out
  double initial_cost = 0, final_cost = 0;
  bool ok = true;     ///< false: singular or not finite; the state is what it was
  int left_out = 0;   ///< readings that the time offset has moved out of the trajectory's span, at the end
  int uncovered = 0;  ///< LiDAR stamps and anchors at times that the trajectory does not cover
};

class Window {
 public:
  /// Throws std::invalid_argument where the model asks for derivatives that the trajectory does not have. Where the
  /// direction of gravity has a prior, it is about the start's.
  Window(WindowModel model, WindowState start);

  const WindowModel& model() const { return model_; }
  WindowModel& model() { return model_; }
  const WindowState& state() const { return state_; }
  WindowState& state() { return state_; }
  core::ParametricTrajectory& trajectory() { return *state_.trajectory; }
  const core::ParametricTrajectory& trajectory() const { return *state_.trajectory; }

  /// Readings in time order (throws std::invalid_argument else); those that the trajectory does not cover yet wait
  /// until it does.
  void add(const ImuReading& reading);
  /// A bias knot with the last one's value. After the last; where the last one stands, nothing happens.
  void add_bias_knot(core::Time t);
  /// The LiDAR residuals of a sweep; given again they take the place of those before.
  void set_lidar(std::int64_t sweep, LidarFactors factors);
  const LidarFactors* lidar(std::int64_t sweep) const;

  /// A Gaussian prior on the whole state at one time: what a start is known to. `sigma`: rows of core::state_row; 0 or
  /// less: nothing known of that row. Throws OutOfSpan where the trajectory does not cover t.
  void add_anchor(core::Time t, const core::Kinematics& mean, const core::StateVector& sigma);
  /// A Gaussian prior on a bias knot (index), an axis of gyro and accelerometer.
  void add_bias_anchor(int knot, const core::Vector6& mean, const core::Vector6& sigma);

  SolveReport solve(const SolveSettings& settings);
  /// Half the sum of weighted squares of everything at the present state.
  double cost() const;

  /// The residuals at the present state, for other solvers.
  WindowProblem problem() const { return {model_, data_, state_}; }
  /// Normal equations at the present state, data (LiDAR) and all the rest apart; either may be null. What is there is
  /// overwritten. Border unknowns of which nothing is known have a zero row.
  void assemble(BandedSystem* lidar, BandedSystem* rest) const;
  /// Of everything, with ones on the diagonal of border unknowns of which nothing is known: they stay where they are.
  BandedSystem normal_equations(bool lidar = true) const;
  /// Covariance of the state at t (rows of core::state_row up to `upto`), by the inverse of the normal equations. Empty
  /// where they are singular.
  Eigen::MatrixXd covariance(core::Time t, core::Derivative upto) const;
  /// The same from normal equations that are at hand.
  Eigen::MatrixXd covariance(const BandedSystem& equations, core::Time t, core::Derivative upto) const;
  /// Covariance of the border: biases, gravity (2), offset (1), as far as they are unknowns. Empty where singular;
  /// infinite variance where nothing is known.
  Eigen::MatrixXd border_covariance() const;
  int border_size() const;
  int gravity_column() const;  ///< within the border; -1: not an unknown
  int offset_column() const;   ///< within the border; -1: not an unknown

  /// Takes out everything before t that the states from t on do not depend on: parameters, bias knots but the last one
  /// before, residuals. What they say of the rest stays as a prior, linearised at the present state.
  void marginalise_before(core::Time t, Marginalisation rule, double eigenvalue_threshold = 1e-6);

 private:
  void forget_before(core::Time begin, int bias_knots);

  WindowModel model_;
  WindowState state_;
  WindowData data_;
};

}  // namespace tarmac::estimators
