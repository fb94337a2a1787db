#include "sim/lidar/sweep_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lie.h"

namespace tarmac::sim::lidar {
namespace {

using core::Duration;
using core::Kinematics;
using core::Time;

constexpr int first_pieces = 6;          // of a sweep: 17 ms at 10 Hz
constexpr Duration shortest{1'000'000};  // a piece; nothing that carries a sensor needs shorter ones

BodyState exact_state(const core::SmoothTrajectory& motion, Time t) {
  const Kinematics k = motion.at(t);
  return {k.T_world_body.linear(), k.T_world_body.translation(), k.v_world, k.omega_body};
}

/// Exp(phi). A vehicle turns by hundredths of a radian in a piece: there five terms of each series are exact.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& phi) {
  const double q = phi.squaredNorm();
  if (q > 0.01) return core::so3::exp(phi);
  const double a = 1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72)));           // sin x / x
  const double b = 0.5 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90))));  // (1 - cos x) / x^2
  const Eigen::Matrix3d hat = core::so3::hat(phi);
  return Eigen::Matrix3d::Identity() + a * hat + b * hat * hat;
}

}  // namespace

SweepMotion::SweepMotion(const core::SmoothTrajectory& motion, Time begin, Time end) : motion_(&motion) {
  const Duration span = end - begin;
  for (int k = 0; k < first_pieces; ++k) add(begin + k * span / first_pieces, begin + (k + 1) * span / first_pieces);
}

void SweepMotion::add(Time begin, Time end) {
  if (end - begin < shortest) {
    pieces_.emplace_back();
    pieces_.back().begin = begin;
    pieces_.back().end = end;
    pieces_.back().exact = true;
    return;
  }
  const Piece piece = fit(begin, end);
  if (holds(piece)) {
    pieces_.push_back(piece);
    return;
  }
  const Time middle = begin + (end - begin) / 2;
  add(begin, middle);
  add(middle, end);
}

// Newton's form through Chebyshev's nodes, as the clock's nanoseconds have them.
SweepMotion::Piece SweepMotion::fit(Time begin, Time end) const {
  // Far ones first: divided differences of neighbours would lose digits (each has the largest product of distances to
  // those before it).
  constexpr std::array<int, nodes> order{0, 11, 6, 3, 8, 4, 9, 1, 7, 10, 2, 5};
  Piece piece;
  piece.begin = begin;
  piece.end = end;
  const double half_ns = 0.5 * static_cast<double>((end - begin).count());
  piece.R_world_middle = motion_->pose(begin + (end - begin) / 2).linear();
  for (int k = 0; k < nodes; ++k) {
    const double u = -std::cos(std::numbers::pi * (order[static_cast<std::size_t>(k)] + 0.5) / nodes);
    const Duration from_begin(std::llround(half_ns * (1 + u)));
    const BodyState state = exact_state(*motion_, begin + from_begin);
    const auto at = static_cast<std::size_t>(k);
    piece.s[at] = core::to_s(from_begin);
    piece.newton[at] << state.p_world, core::so3::log(piece.R_world_middle.transpose() * state.R_world_body),
        state.v_world, state.omega_body;
  }
  for (std::size_t level = 1; level < nodes; ++level)
    for (std::size_t k = nodes - 1; k >= level; --k)
      piece.newton[k] = (piece.newton[k] - piece.newton[k - 1]) / (piece.s[k] - piece.s[k - level]);
  return piece;
}

BodyState SweepMotion::state(const Piece& piece, Time t) {
  const double s = core::to_s(t - piece.begin);
  Values value = piece.newton[nodes - 1];
  for (std::size_t k = nodes - 1; k-- > 0;) value = piece.newton[k] + (s - piece.s[k]) * value;
  return {piece.R_world_middle * rotation_of(value.segment<3>(3)), value.segment<3>(0), value.segment<3>(6),
          value.segment<3>(9)};
}

bool SweepMotion::holds(const Piece& piece) const {
  const Duration span = piece.end - piece.begin;
  // Between nodes, near the ends and the middle, where such polynomials are worst.
  for (const Time t : {piece.begin, piece.begin + span / 2, piece.end}) {
    const BodyState exact = exact_state(*motion_, t), fitted = state(piece, t);
    const double angle = core::so3::angle_rad(exact.R_world_body.transpose() * fitted.R_world_body);
    if ((exact.p_world - fitted.p_world).norm() > position_tolerance_m || angle > angle_tolerance_rad) return false;
  }
  return true;
}

BodyState SweepMotion::at(Time t) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                      [](Time time, const Piece& piece) { return time < piece.begin; });
  const Piece& piece = *(after - 1);
  return piece.exact ? exact_state(*motion_, t) : state(piece, t);
}

}  // namespace tarmac::sim::lidar
