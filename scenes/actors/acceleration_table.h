/// Upper bounds of the acceleration of a motion that has no simple ones in closed form.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/lie.h"
#include "scenes/actors/course.h"

namespace tarmac::scenes {

/// Second differences of the exact pose every 10 ms, once, over all times at which the motion moves: of the origin
/// (|a_0|) and of the rotation (|alpha| + |omega|^2), so that |a_0| + (|alpha| + |omega|^2) r bounds every point within
/// r of the origin, v times omega included. What happens between samples is covered by half the second difference of
/// the samples themselves and 5 per cent: motions here take at least tenths of a second for what they do.
class AccelerationTable {
 public:
  using Pose = std::function<core::SE3(double t_s)>;
  /// `moves`: ordered; outside of it the pose is constant.
  AccelerationTable(const Pose& pose, std::span<const Course::Span> moves);
  /// Over [t0_s, t1_s]; 0 where it stands still.
  double bound_m_s2(double t0_s, double t1_s, double radius_m) const;

 private:
  struct Cell {
    float origin_m_s2, rotation_1_s2;
  };
  struct Stretch {
    double begin_s, end_s;
    std::vector<Cell> cells;  ///< of cell_s each
  };
  Stretch sampled(const Pose& pose, const Course::Span& span) const;
  std::vector<Stretch> stretches_;
};

}  // namespace tarmac::scenes
