/// The centre line of a taxiway, road or tunnel, and coordinates along and across it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenes/paths/planar_path.h"

namespace tarmac::scenes {

/// Straights and turns whose curvature blends in and out (PlanarPath without wander), going on straight at both ends.
/// Coordinates of a point of the plane: `s_m` along, `d_m` to the left of the line.
class CentreLine {
 public:
  struct Point {
    Eigen::Vector2d p_m, tangent, left;
    double heading_rad, curvature_per_m, curvature_change_per_m2;  ///< the last: derivative of the curvature by s
  };
  struct Place {
    double s_m, d_m;
    Point foot;  ///< the line's point nearest to the place
  };

  /// Throws std::invalid_argument for pieces that do not fit together (a turn too short for its blends).
  CentreLine(const StartOptions& start, const std::vector<PathPiece>& pieces);
  static CentreLine straight(double x_m, double y_m, double heading_deg, double length_m);

  double length_m() const { return length_m_; }
  Point at(double s_m) const;
  /// Point at (s, d).
  Eigen::Vector2d place(double s_m, double d_m) const;
  /// Points at distance d to the left, from s0 to s1 (either way), at most `step_m` apart: a line to paint.
  std::vector<Eigen::Vector2d> offset_line(double s0_m, double s1_m, double d_m, double step_m) const;
  /// The nearest point of the line, the straights beyond its ends included, however far out. Smooth where the point is
  /// nearer to the line than its radius of curvature and no other part of the line is as near.
  Place project(const Eigen::Vector2d& p_m) const;

 private:
  double length_m_ = 0;
  bool is_straight_ = true;
  PlanarPath path_;
  Point first_{}, last_{};
  static constexpr double sample_m = 4;
  std::vector<Eigen::Vector2d> samples_;  ///< every sample_m: where the search for the nearest point begins
};

}  // namespace tarmac::scenes
