/// Two wedges that turn in front of a fixed beam: a Risley scanner.
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// Where a beam along sensor +x goes behind two turning wedges: Snell's law in vector form at each of the four faces,
///   d' = r d + (r c - sqrt(1 - r^2 (1 - c^2))) n,   r = n_before / n_after,  c = -n.d,  n against the light,
/// not the first-order sum of deviations (n - 1) wedge, which is 0.4 degrees short at the rim of the Mid-40's pattern.
/// Each wedge has its slanted face towards the light and its square face behind it: of the four ways to mount two
/// wedges this one gives the Mid-40's circle of 38.4 degrees, and leaves no hole in its middle. The wedges are thin:
/// all beams leave from the sensor frame's origin.
class Prism {
 public:
  /// Throws InputError when some position of the wedges lets no light out (total reflection) or turns it backwards.
  explicit Prism(const Profile& profile);

  /// Unit vector in the sensor frame (x forward, y left, z up), `t_ns` after the recording's begin. Wedge i bends the
  /// beam towards angle start_i + 360 hz_i t, counted from y to z.
  Eigen::Vector3d direction(double t_ns) const;

 private:
  struct Wedge {
    double hz, start_turns, cos_slant, sin_slant;
  };
  Eigen::Vector3d behind(const std::array<double, 2>& turns) const;
  double index_;
  std::array<Wedge, 2> wedges_;
};

}  // namespace tarmac::sim::lidar
