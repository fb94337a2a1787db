/// Headings of a train's links as functions of the distance that the tug drives.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// Axles do not slip sideways. With psi the heading of what pulls, theta that of a link of length L whose hitch is `a`
/// behind the axle before it, d = psi - theta, and everything by the tug's distance s (v = 1 for the tug itself):
///
///   theta' = (v_before sin d - a psi' cos d) / L        v = v_before cos d + a psi' sin d
///
/// The speed has left the equations, so that they are solved once over s: Gauss' collocation with three stages (order
/// 6), every 2 cm, and again every 1 cm; what the two differ by is the certificate. Between nodes stands the polynomial
/// of degree 7 that has the heading and its first three derivatives, which the equations give, at both ends.
class Train {
 public:
  struct Link {
    double hitch_m, length_m;
  };
  struct Problem {
    double s_m = 0;
    std::string message;  ///< empty: none
  };
  static constexpr int max_links = 2;
  static constexpr double node_spacing_m = 0.02;

  /// The tug's [rad] by distance. Kept, and called from several threads.
  using Heading = std::function<Jet(double s_m)>;

  /// All links begin in line with the tug. Covers [0, s_max]. Angles are kept every 128 nodes; what lies between is
  /// made again when it is asked for, so that memory hardly grows with the way.
  Train(const std::vector<Link>& links, Heading heading, double s_max_m, Problem& problem);

  /// Headings of the links [rad], by the tug's distance. Safe from several threads.
  std::array<Jet, max_links> headings(double s_m) const;
  /// Speed of the last link's axle against the tug's, by the tug's distance; two derivatives.
  Jet speed_ratio(const Jet& tug_heading, const std::array<Jet, max_links>& headings) const;

  const std::vector<Link>& links() const;
  /// Largest difference of the two solutions [rad].
  double certificate_rad() const;

 private:
  class Solution;
  std::shared_ptr<const Solution> solution_;
};

}  // namespace tarmac::sim::truth
