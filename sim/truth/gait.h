/// How a device in the hands of somebody who walks swings about the person's path.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/truth/handheld_options.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

/// Displacements and turns: forward, left, up [m], roll, pitch, yaw [rad]; with derivatives by time.
using Swing = std::array<Jet, 6>;

/// Phase of the steps: (s + E(s)) / step length, where E's slope is the jitter of the step rate, sines of the distance.
/// One step is one cycle; at rest the phase stands still.
class StepPhase {
 public:
  StepPhase(const GaitOptions& gait, std::uint64_t seed);
  /// [cycles] with derivatives by time.
  Jet at(const Jet& s) const;

 private:
  double step_length_m_;
  Waves drift_m_;
};

/// Steps and strides: sines of the phase and its harmonics, times how much of the gait the speed calls for, and no step
/// like the other: all of it swells and fades by 15 % rms over 5 to 30 steps.
class Gait {
 public:
  Gait(const GaitOptions& gait, std::uint64_t seed);
  /// 0 at rest, 1 from full_speed_m_s on, with derivatives by time. `v` with two.
  Jet share(const Jet& v_m_s) const;
  Swing at(const Jet& phase, const Jet& share) const;

 private:
  struct Tone {
    double cycles;  ///< per step
    std::array<double, 6> sine, cosine;
  };
  double full_speed_m_s_;
  std::vector<Tone> tones_;
  Waves uneven_;
};

/// What is left of the heels' strikes at the device: after each, a ringing that swells by smooth_step within 15 ms, and
/// is exactly over after half a second. Infinitely differentiable.
class Strikes {
 public:
  Strikes(const GaitOptions& gait, std::uint64_t seed);
  /// A strike at t; in order of time. `share` is how much of the gait there is.
  void add(double t_s, double share);
  Swing at(double t_s) const;
  const std::vector<double>& times_s() const { return times_s_; }

 private:
  Jet ringing(double since_s) const;  ///< of peak acceleration 1, once scale_ is known
  double rate_, damping_, scale_ = 1, peak_m_s2_;
  std::uint64_t seed_;
  std::vector<double> times_s_, strengths_;
};

/// Tremor of the hands and slow changes of posture: sines of the time.
class Unrest {
 public:
  Unrest(const HoldOptions& hold, std::uint64_t seed);
  Swing at(double t_s, const Jet& share) const;

 private:
  std::array<Waves, 6> tremor_, posture_;
};

}  // namespace tarmac::sim::truth
