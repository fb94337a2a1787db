#include "core/parametric_trajectory.h"

#include <stdexcept>

namespace tarmac::core {

void ParametricTrajectory::poses(std::span<const Time> ascending, std::span<SE3> T_world_body) const {
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    T_world_body[i] = i > 0 && ascending[i] == ascending[i - 1] ? T_world_body[i - 1] : pose(ascending[i]);
  }
}

Eigen::MatrixXd ParametricTrajectory::conditional_covariance(Time, Derivative upto) const {
  return Eigen::MatrixXd::Zero(state_row::filled(upto), state_row::filled(upto));
}

void ParametricTrajectory::prior(int, PriorJet&) const {
  throw std::logic_error("this trajectory has no priors of its own");
}

}  // namespace tarmac::core
