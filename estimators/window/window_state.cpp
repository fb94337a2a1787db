#include "estimators/window/window_state.h"

#include <algorithm>

#include "estimators/window/gravity_direction.h"

namespace tarmac::estimators {

WindowState::WindowState(const WindowState& other)
    : trajectory(other.trajectory ? other.trajectory->clone() : nullptr),
      biases(other.biases),
      gravity_map(other.gravity_map),
      imu_offset_s(other.imu_offset_s) {}

WindowState& WindowState::operator=(const WindowState& other) {
  if (this != &other) *this = WindowState(other);
  return *this;
}

BorderLayout::BorderLayout(const WindowState& state, bool free_gravity, bool free_offset)
    : biases(static_cast<int>(state.biases.size())) {
  int at = 6 * biases;
  if (free_gravity) {
    gravity = at;
    at += 2;
  }
  if (free_offset) offset = at;
}

void retract(WindowState& state, const BorderLayout& layout, const Eigen::Ref<const Eigen::VectorXd>& step) {
  const int band = state.trajectory->parameters();
  state.trajectory->retract(step.head(band));
  for (int k = 0; k < layout.biases; ++k) {
    state.biases[static_cast<std::size_t>(k)].gyro_accel += step.segment<6>(band + 6 * k);
  }
  if (layout.gravity >= 0)
    state.gravity_map = gravity_direction::moved(state.gravity_map, step.segment<2>(band + layout.gravity));
  if (layout.offset >= 0) state.imu_offset_s += step[band + layout.offset];
}

BiasPlace bias_place(const std::vector<BiasKnot>& biases, core::Time t) {
  const auto after =
      std::upper_bound(biases.begin(), biases.end(), t, [](core::Time a, const BiasKnot& b) { return a < b.t; });
  if (after == biases.begin()) return {0, 0};
  const auto k = static_cast<int>(after - biases.begin()) - 1;
  if (after == biases.end()) return {k, 0};
  return {k, core::ratio(t, (after - 1)->t, after->t)};
}

core::Vector6 bias_at(const std::vector<BiasKnot>& biases, core::Time t) {
  if (biases.empty()) return core::Vector6::Zero();
  const BiasPlace place = bias_place(biases, t);
  const auto k = static_cast<std::size_t>(place.knot);
  if (place.share == 0) return biases[k].gyro_accel;
  return (1 - place.share) * biases[k].gyro_accel + place.share * biases[k + 1].gyro_accel;
}

}  // namespace tarmac::estimators
