/// Where an actor is over ground, as a function of time: a path and a timetable that have been checked against each
/// other.
#pragma once

#include <vector>

#include "core/config.h"
#include "scenes/actors/options.h"
#include "scenes/paths/planar_path.h"
#include "scenes/paths/speed_profile.h"

namespace tarmac::scenes {

/// Function class: path and speeds are those of a drive (PlanarPath, SpeedProfile) without wander and ripple: heading
/// by distance and distance by time are closed forms made of smooth_step, C-infinity; the position is the integral of
/// the heading.
class Course {
 public:
  /// What its kind can do; what asks for more is an error.
  struct Limits {
    double speed_m_s, acceleration_m_s2;
    double sideways_m_s2;  ///< v^2 times curvature
    double min_radius_m;   ///< of the reference point's path
  };
  /// The path is tabulated.
  Course(PlanarPath path, SpeedProfile speed);

  const PlanarPath& path() const { return path_; }
  double length_m() const { return path_.length_m(); }
  /// Distance along the path, never beyond its end.
  double s_m(double t_s) const;
  double speed_m_s(double t_s) const { return speed_.at(t_s).d1; }
  double top_speed_m_s() const;
  struct Span {
    double begin_s, end_s;
  };
  /// When it moves; it stands at all other times.
  const std::vector<Span>& moves() const { return moves_; }

 private:
  PlanarPath path_;
  SpeedProfile speed_;
  std::vector<Span> moves_;
};

/// Throws InputError at the line of `node` (the actor's entry) that asks for what cannot be.
Course make_course(const core::ConfigNode& node, const ActorOptions& options, const Course::Limits& limits);

/// Straights and turns that pass the way points: each inner one is rounded by a turn of `radius_m`, or by the widest
/// one that fits and is not below a third of it. Throws InputError at the way point that leaves no room.
struct RoundedPath {
  StartOptions start;
  std::vector<PathPiece> pieces;
  std::vector<double> s_m;  ///< distance at which the path is beside each way point
};
RoundedPath round_corners(const core::ConfigNode& node, const std::vector<WayPoint>& points, double radius_m);

}  // namespace tarmac::scenes
