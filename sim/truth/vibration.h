/// Engine and tyres: what shakes the body beside the suspension, as sums of sines.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/truth/drive_options.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// Engine lines: orders of the firing frequency f = idle + rise * v. Their phase is the integral of f, idle t + rise
/// s(t), so it is closed form and keeps running at rest. Tyre lines: waves of the distance, silent at rest.
/// Displacements are constant, so accelerations grow with the square of the frequency.
class Vibration {
 public:
  Vibration(const VibrationOptions& options, std::uint64_t seed);

  struct Shake {
    std::array<Jet, 3> xyz_m;    ///< forward, left, up
    std::array<Jet, 3> rpy_rad;  ///< roll, pitch, yaw
  };
  /// With derivatives by time; `s` is the driven distance as a function of time.
  Shake at(double t_s, const Jet& s) const;

 private:
  /// Phase 2 pi (cycles_per_s t + cycles_per_m s); each axis follows with an amplitude and a phase of its own.
  struct Line {
    double cycles_per_s, cycles_per_m;
    std::array<double, 6> sine, cosine;
  };
  std::vector<Line> lines_;
};

}  // namespace tarmac::sim::truth
