/// A beam's cross-section as a few rays, and which beams are neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/lidar/aim.h"
#include "sim/lidar/firing.h"
#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// Sides of a beam, as bits.
namespace side {
inline constexpr std::uint8_t left = 1, right = 2, above = 4, below = 8, all = 15;
}

/// The centre ray and the rays around it. Intensity over the cross-section is Gaussian, `divergence_mrad` its full
/// width at half maximum; every ray stands for the same area, so its weight is the intensity where it points:
///   w(a) ~ exp(-ln 2 a^2),   a = offset / half width.
/// 7: six around the centre at a = 0.6, from the horizontal on every 60 degrees; 3: one on either side at a = 0.6.
class Footprint {
 public:
  static constexpr double offset = 0.6;
  /// `rays`: 1, 3 or 7. The profile's divergence is needed for more than 1.
  Footprint(const Profile& profile, int rays);
  std::size_t rays() const { return weight_.size(); }
  std::size_t around() const { return weight_.size() - 1; }
  /// Of the centre, then of those around it; their sum is 1.
  const std::vector<double>& weight() const { return weight_; }
  /// The k-th of those around each of the beams.
  BeamTable table(const BeamTable& centre, std::size_t k) const;
  /// Sides of the centre that the k-th of those around it lies on.
  std::uint8_t sides(std::size_t k) const;

 private:
  std::vector<double> weight_, horizontal_rad_, vertical_rad_;
};

/// The next beam upwards of every channel: one of the next elevation, in the cycle in which it looks where this one
/// does.
struct Above {
  std::int64_t cycles = 0;
  std::int32_t channel = -1;  ///< -1: there is none
};
std::vector<Above> beams_above(const FiringTable& firing, const BeamTable& beams);

/// A beam that light meant for another reaches.
struct Beside {
  std::int64_t cycles = 0;   ///< from the other's cycle
  std::int32_t channel = 0;  ///< its own
  float share = 0;           ///< of the other's signal
};
/// For every channel the beams within 1.5 widths of it and 2 channels above or below; what reaches them is
///   0.01 exp(-ln 2 (2 angle / width)^2).
std::vector<std::vector<Beside>> beams_beside(const FiringTable& firing, const BeamTable& beams,
                                              const Profile& profile);

}  // namespace tarmac::sim::lidar
