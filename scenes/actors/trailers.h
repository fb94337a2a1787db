/// What is drawn behind something that moves: each link's axle does not slip sideways.
#pragma once

#include <functional>
#include <vector>

#include "scenes/actors/hermite_table.h"
#include "scenes/paths/jet.h"

namespace tarmac::scenes {

/// A body in the plane by the distance s that the leader has covered; d1 to d3 are derivatives by s.
struct PlanarJets {
  Jet x_m, y_m, heading;
};
struct PlanarPose {
  double x_m = 0, y_m = 0, heading_rad = 0;
};

/// Link i is coupled `hitch_m` behind the reference point of the body before it, its own axle `length_m` behind the
/// coupling H:
///
///   theta' = n(theta) . H' / L,   H = P_before - a u(theta_before),   P = H - L u(theta),   ' = d/ds
///
/// (u along the heading, n to the left of it; with P' = v u(theta_before) this is the trailer law
/// theta_i' = (v sin(d) - a theta_before' cos(d)) / L, d = theta_before - theta_i). No closed form exists. The equation
/// does not hold time: it is solved by distance, once, and whatever speed the leader has, theta(t) = theta(s(t)).
/// Nodes every 5 cm are joined by the two-point formula of order 6 (Obreshkov; three derivatives, all from the law
/// itself by the chain rule),
///
///   theta_1 - theta_0 = h/2 (theta_0' + theta_1') + h^2/10 (theta_0'' - theta_1'') + h^3/120 (theta_0''' +
///   theta_1'''),
///
/// and between them by polynomials of degree 7 (HermiteTable). Source of the formula: the Pade approximant (3, 3) of
/// exp. Function class: C3 by distance, C-infinity by time at a given distance; no spline of an estimator has its
/// knots.
class TrailerChain {
 public:
  struct Link {
    double hitch_m, length_m;
  };
  using Leader = std::function<PlanarJets(double s_m)>;

  /// All links begin in line with the leader. Covers [0, end_m].
  TrailerChain(const Leader& leader, const std::vector<Link>& links, double end_m, double spacing_m = 0.05);

  std::size_t size() const { return links_.size(); }
  /// Heading of a link, with derivatives by s.
  Jet heading(std::size_t link, double s_m) const { return headings_[link].at(s_m); }
  /// Where a link's axle is, given the leader at s.
  PlanarPose pose(std::size_t link, double s_m, const PlanarPose& leader) const;
  /// Largest angle between a link and the body before it, and where it is reached.
  struct Bend {
    double angle_rad = 0, s_m = 0;
    std::size_t link = 0;
  };
  const Bend& sharpest_bend() const { return sharpest_; }

 private:
  std::vector<Link> links_;
  std::vector<HermiteTable> headings_;
  Bend sharpest_;
};

}  // namespace tarmac::scenes
