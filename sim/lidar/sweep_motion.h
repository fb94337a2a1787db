/// A motion over one sweep, cheap to ask thousands of times.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/time.h"
#include "core/trajectory.h"

namespace tarmac::sim::lidar {

/// Where a rigid body is and how it moves on at one instant.
struct BodyState {
  Eigen::Matrix3d R_world_body;
  Eigen::Vector3d p_world, v_world;
  Eigen::Vector3d omega_body;
};

/// Polynomials through exact states of a motion at a few instants: a closed-form drive takes microseconds to ask, and a
/// sweep asks for every column. Each piece was held against the motion between its nodes; where it was farther off than
/// `position_tolerance_m` or `angle_tolerance_rad` it was halved, down to pieces too short to be worth it, in which the
/// motion itself is asked.
class SweepMotion {
 public:
  static constexpr double position_tolerance_m = 1e-6;
  static constexpr double angle_tolerance_rad = 1e-8;

  /// Keeps a reference to `motion`. Throws OutOfSpan when it does not cover [begin, end].
  SweepMotion(const core::SmoothTrajectory& motion, core::Time begin, core::Time end);

  /// For begin <= t <= end.
  BodyState at(core::Time t) const;
  std::size_t pieces() const { return pieces_.size(); }

 private:
  static constexpr int nodes = 12;
  using Values = Eigen::Matrix<double, 12, 1>;  // position, rotation vector, velocity, rate
  struct Piece {
    core::Time begin, end;
    bool exact = false;  // ask the motion
    Eigen::Matrix3d R_world_middle;
    std::array<double, nodes> s;       // times of the nodes from the piece's begin [s]
    std::array<Values, nodes> newton;  // divided differences
  };
  Piece fit(core::Time begin, core::Time end) const;
  bool holds(const Piece& piece) const;
  void add(core::Time begin, core::Time end);
  static BodyState state(const Piece& piece, core::Time t);

  const core::SmoothTrajectory* motion_;
  std::vector<Piece> pieces_;
};

}  // namespace tarmac::sim::lidar
