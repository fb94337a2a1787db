/// The path over ground: straights and turns whose curvature blends in and out, plus the driver's wander.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenes/paths/jet.h"
#include "scenes/paths/path_options.h"
#include "scenes/paths/waves.h"

namespace tarmac::scenes {

/// The heading is closed form: psi(s) = integral of the curvature's smooth_step blends, plus the wander's sines. The
/// position is the integral of (cos psi, sin psi) over s, which has no closed form: nodes every 5 cm, summed up once by
/// Gauss-Legendre quadrature, and a quadrature from the node to s. Its error is below 1e-12 m, and all its derivatives
/// follow from psi exactly.
class PlanarPath {
 public:
  struct Point {
    double x_m = 0, y_m = 0;
    Jet heading;  ///< [rad] by distance: d1 is the curvature
  };
  /// What is wrong with piece `piece`, counted from 0.
  struct Problem {
    std::size_t piece = 0;
    std::string message;
  };

  /// `wander` is the sideways displacement as a function of s [m].
  PlanarPath(const StartOptions& start, std::span<const PathPiece> pieces, const Waves& wander,
             std::vector<Problem>& problems);

  /// Sum of the pieces' lengths; the path goes on straight after it.
  double length_m() const { return length_m_; }
  /// Tabulates up to s; call once, before at().
  void tabulate(double s_max_m);
  /// At s >= 0.
  Point at(double s_m) const;
  /// Heading [rad] by distance.
  Jet heading(double s_m) const;
  /// Curvature by distance: the heading's derivative, with one derivative more than heading() knows.
  Jet curvature(double s_m) const;

 private:
  /// From s_m on the curvature is `curvature` plus `change` blended in over `blend_m`.
  struct Segment {
    double s_m, heading, curvature, change, blend_m;
  };
  void append(double length_m, double curvature_change);
  double heading_value(double s_m) const;
  const Segment& segment(double s_m) const;

  std::vector<Segment> segments_;
  Waves heading_wander_;
  double length_m_ = 0;
  struct Node {
    double x_m, y_m;
  };
  std::vector<Node> nodes_;
  double x0_m_ = 0, y0_m_ = 0;
};

}  // namespace tarmac::scenes
