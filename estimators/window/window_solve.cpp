#include <cmath>

#include "estimators/window/window.h"

namespace tarmac::estimators {
namespace {

using Eigen::VectorXd;

constexpr int kMostHalvings = 3;
constexpr double kLeastLambda = 1e-12, kMostLambda = 1e12;

/// A state and its cost, moved step by step; the problem's residuals stay the same ones.
class Descent {
 public:
  Descent(const WindowProblem& problem, WindowState& state, const SolveSettings& settings)
      : problem_(problem), state_(state), settings_(settings), cost_(problem.cost(state, settings.lidar)) {}

  double cost() const { return cost_; }

  bool step(double lambda, VectorXd& x) const {
    BandedSystem system = problem_.system(state_);
    problem_.assemble(state_, settings_.lidar ? &system : nullptr, &system);
    hold_untouched(system);
    return system.solve(lambda, x);
  }

  /// Moves by x where the new cost is finite and, if it has to, below the present one.
  bool move(const VectorXd& x, bool must_fall) {
    WindowState moved_state(state_);
    retract(moved_state, problem_.layout(), x);
    const double moved_cost = problem_.cost(moved_state, settings_.lidar);
    if (!std::isfinite(moved_cost) || (must_fall && !(moved_cost < cost_))) return false;
    state_ = std::move(moved_state);
    cost_ = moved_cost;
    return true;
  }

  bool settled(double before) const {
    const double fall = std::abs(before - cost_);
    return fall <= settings_.absolute_decrease || fall <= settings_.relative_decrease * std::abs(before);
  }

 private:
  const WindowProblem& problem_;
  WindowState& state_;
  const SolveSettings& settings_;
  double cost_;
};

/// False: singular or not finite.
bool gauss_newton(Descent& descent, const SolveSettings& settings, int& iterations) {
  VectorXd x;
  while (iterations < settings.max_iterations) {
    ++iterations;
    if (!descent.step(0, x)) return false;
    const double before = descent.cost();
    bool moved = descent.move(x, settings.line_search);
    for (int halving = 0; !moved && halving < kMostHalvings; ++halving) {
      x /= 2;
      moved = descent.move(x, settings.line_search);
    }
    if (!moved) return settings.line_search;
    if (descent.settled(before)) break;
  }
  return true;
}

/// False: singular whatever the damping, or not finite.
bool levenberg_marquardt(Descent& descent, const SolveSettings& settings, int& iterations) {
  VectorXd x;
  double lambda = settings.initial_lambda;
  bool solved_once = settings.max_iterations == 0;
  while (iterations < settings.max_iterations) {
    ++iterations;
    const double before = descent.cost();
    const bool solved = descent.step(lambda, x);
    solved_once |= solved;
    if (solved && descent.move(x, true)) {
      lambda = std::max(kLeastLambda, lambda / 10);
      if (descent.settled(before)) break;
      continue;
    }
    lambda *= 10;
    if (lambda > kMostLambda) break;
  }
  return solved_once;
}

}  // namespace

SolveReport Window::solve(const SolveSettings& settings) {
  check(model_, *state_.trajectory);
  const WindowProblem now = problem();
  const WindowState start(state_);
  Descent descent(now, state_, settings);
  SolveReport report;
  report.initial_cost = descent.cost();
  report.ok = std::isfinite(descent.cost()) &&
              (settings.levenberg_marquardt ? levenberg_marquardt(descent, settings, report.iterations)
                                            : gauss_newton(descent, settings, report.iterations));
  report.final_cost = report.ok ? descent.cost() : report.initial_cost;
  if (!report.ok) state_ = start;
  report.left_out = now.left_out(state_);
  report.uncovered = now.uncovered();
  return report;
}

}  // namespace tarmac::estimators
