/// A person on foot whose parts move with the gait.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/actors/timetabled.h"
#include "scenes/equipment/person.h"

namespace tarmac::scenes {

/// The gait's phase advances with the distance walked, its size with the speed (none at rest): steps neither slide much
/// nor go on while the person stands. Arms are raised and lowered by smooth_step; all functions of time are C-infinity.
class Walker {
 public:
  struct Gesture {
    double from_s = -1, until_s = -1;  ///< -1: none
    double beckon_hz = 0.8;
  };
  Walker(Course course, const Gesture& gesture, std::shared_ptr<const Ground> ground);

  /// Ground point between the feet; upright whatever the slope.
  core::SE3 T_world_person(double t_s) const;
  PersonPosture posture(double t_s) const;
  /// T_world_part of every part. The last few answers are kept for each thread: a sweep asks for the same times part
  /// after part.
  const std::vector<core::SE3>& T_world_parts(double t_s) const;
  /// When any part of it moves.
  std::vector<Course::Span> moves() const;

 private:
  Course course_;
  Gesture gesture_;
  std::shared_ptr<const Ground> ground_;
  double stride_m_;
  std::uint64_t id_;  ///< no two walkers of a program have the same
};

/// One part of the person.
class WalkerPart final : public TimetabledMotion {
 public:
  WalkerPart(std::shared_ptr<const Walker> walker, std::size_t part);

 private:
  core::SE3 pose(double t_s) const override;
  std::shared_ptr<const Walker> walker_;
  std::size_t part_;
};

}  // namespace tarmac::scenes
