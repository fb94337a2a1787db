/// Unevenness under the four wheels as a function of the distance driven.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/truth/bumps.h"
#include "sim/truth/drive_options.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// What the four contacts do to the body together.
enum Mode : int { heave = 0, pitch = 1, roll = 2 };

/// Roughness: sines with log-spaced wave numbers from 0.01 to 10 cycles/m and seeded phases, amplitudes by ISO 8608
/// G(n) = G(0.1) (0.1/n)^2, averaged over the contact patch; left and right tracks with a coherence of
/// exp(-1.5 n track); the rear axle meets what the front axle met. Slab joints: dips of the form cos^4, across both
/// tracks; `bumps` come on top. Source: ISO 8608; tyre and coherence figures in sim/truth/README.md.
class Road {
 public:
  Road(const RoadOptions& options, double wheelbase_m, double track_m, std::uint64_t seed,
       const std::vector<BumpOptions>& bumps = {});

  /// Heave [m], pitch [rad, nose down positive] and roll [rad, left up positive] that a massless vehicle would follow,
  /// with the first two derivatives by distance. `s_m` is that of the rear axle.
  std::array<Jet, 3> at(double s_m) const;

 private:
  void add_waves(const RoadOptions& options, double track_m, std::uint64_t seed);
  Jet joint(double s_m) const;
  /// Per mode sum of a sin(2 pi n s) + b cos(2 pi n s): the contacts' phases are folded into a and b.
  std::vector<double> cycles_per_m_;
  std::array<std::vector<double>, 3> sine_, cosine_;
  void add_bumps(double s_m, std::array<Jet, 3>& sum) const;
  double wheelbase_m_, track_m_;
  Bumps bumps_;
  double joint_spacing_m_, joint_depth_m_, joint_length_m_;
};

}  // namespace tarmac::sim::truth
