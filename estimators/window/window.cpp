#include "estimators/window/window.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

namespace tarmac::estimators {

using Eigen::MatrixXd;

void check(const WindowModel& model, const core::ParametricTrajectory& trajectory) {
  const bool accelerometer = model.accel_sigma_m_s2 > 0 && !model.accel_as_increments;
  const bool smoothness = model.smoothness_translation > 0 || model.smoothness_rotation > 0;
  if ((accelerometer || smoothness) && trajectory.has() != core::Derivative::acceleration)
    throw std::invalid_argument("an accelerometer and smoothness need a trajectory that has an acceleration");
  if ((model.gyro_sigma_rad_s > 0 || model.accel_sigma_m_s2 > 0) && trajectory.has() == core::Derivative::pose)
    throw std::invalid_argument("an IMU needs a trajectory that has a velocity");
  if (model.sum_stamp_residuals && model.lidar_loss.kind != Loss::standard)
    throw std::invalid_argument("summed residuals have no robust loss");
}

Window::Window(WindowModel model, WindowState start) : model_(std::move(model)), state_(std::move(start)) {
  check(model_, *state_.trajectory);
  data_.gravity_start = state_.gravity_map;
}

void Window::add(const ImuReading& reading) {
  if (!data_.readings.empty() && reading.t < data_.readings.back().t)
    throw std::invalid_argument(fmt::format("an IMU reading at {} ns came after one at {} ns", core::to_ns(reading.t),
                                            core::to_ns(data_.readings.back().t)));
  data_.readings.push_back(reading);
}

void Window::add_bias_knot(core::Time t) {
  if (state_.biases.empty()) {
    state_.biases.push_back({t, core::Vector6::Zero()});
    return;
  }
  if (t < state_.biases.back().t)
    throw std::invalid_argument(fmt::format("a bias knot at {} ns came after one at {} ns", core::to_ns(t),
                                            core::to_ns(state_.biases.back().t)));
  if (t > state_.biases.back().t) state_.biases.push_back({t, state_.biases.back().gyro_accel});
}

void Window::set_lidar(std::int64_t sweep, LidarFactors factors) {
  if (factors.first.size() != factors.stamps.size() + 1 || factors.first.back() > factors.factors.size())
    throw std::invalid_argument("LiDAR factors whose stamps do not fit them");
  data_.lidar.insert_or_assign(sweep, std::move(factors));
}

const LidarFactors* Window::lidar(std::int64_t sweep) const {
  const auto found = data_.lidar.find(sweep);
  return found == data_.lidar.end() ? nullptr : &found->second;
}

void Window::add_anchor(core::Time t, const core::Kinematics& mean, const core::StateVector& sigma) {
  if (!trajectory().covers(t)) throw core::OutOfSpan("an anchor outside the trajectory");
  data_.anchors.push_back({t, mean, sigma});
}

void Window::add_bias_anchor(int knot, const core::Vector6& mean, const core::Vector6& sigma) {
  if (knot < 0 || knot >= static_cast<int>(state_.biases.size()))
    throw std::invalid_argument(fmt::format("no bias knot {} of {}", knot, state_.biases.size()));
  data_.bias_anchors.push_back({knot, mean, sigma});
}

double Window::cost() const {
  return problem().cost(state_, true);
}

void Window::assemble(BandedSystem* lidar, BandedSystem* rest) const {
  const WindowProblem now = problem();
  for (BandedSystem* system : {lidar, rest})
    if (system != nullptr) *system = now.system(state_);
  now.assemble(state_, lidar, rest);
}

BandedSystem Window::normal_equations(bool lidar) const {
  const WindowProblem now = problem();
  BandedSystem system = now.system(state_);
  now.assemble(state_, lidar ? &system : nullptr, &system);
  hold_untouched(system);
  return system;
}

MatrixXd Window::covariance(core::Time t, core::Derivative upto) const {
  return covariance(normal_equations(), t, upto);
}

MatrixXd Window::covariance(const BandedSystem& equations, core::Time t, core::Derivative upto) const {
  core::StateJet jet;
  trajectory().jet(t, upto, jet);
  const MatrixXd parameters = equations.covariance(jet.first, jet.columns());
  if (parameters.size() == 0) return {};
  const MatrixXd J = jet.J.topRows(core::state_row::filled(upto));
  return J * parameters * J.transpose() + trajectory().conditional_covariance(t, upto);
}

MatrixXd Window::border_covariance() const {
  const WindowProblem now = problem();
  BandedSystem system = now.system(state_);
  now.assemble(state_, &system, &system);
  std::vector<int> unknown;
  for (int i = 0; i < system.border(); ++i)
    if (system.diagonal(system.band() + i) == 0) unknown.push_back(i);
  hold_untouched(system);
  MatrixXd covariance = system.covariance(system.band(), system.border());
  if (covariance.size() == 0) return {};
  for (const int i : unknown) covariance(i, i) = std::numeric_limits<double>::infinity();
  return covariance;
}

int Window::border_size() const {
  return BorderLayout(state_, model_.free_gravity, model_.free_imu_offset).size();
}

int Window::gravity_column() const {
  return BorderLayout(state_, model_.free_gravity, model_.free_imu_offset).gravity;
}

int Window::offset_column() const {
  return BorderLayout(state_, model_.free_gravity, model_.free_imu_offset).offset;
}

}  // namespace tarmac::estimators
