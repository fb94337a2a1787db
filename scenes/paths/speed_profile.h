/// Distance driven as a function of time, in closed form.
#pragma once

#include <string>
#include <vector>

#include "scenes/paths/jet.h"
#include "scenes/paths/path_options.h"
#include "scenes/paths/waves.h"

namespace tarmac::scenes {

/// The planned distance S(t) is the integral of speeds that change by smooth_step; a ramp from v0 to v1 over T has the
/// peak acceleration 2 |v1 - v0| / T and covers T (v0 + v1) / 2. With an onset time tau it is the acceleration that
/// comes and goes by smooth_step within tau, and stays at its peak between: T = |v1 - v0| / peak + tau, the same
/// distance. The ripple of anti-lock brakes is a sine's displacement that swells and fades with the change; it moves
/// nothing for good. The driven distance adds the driver's ripple,
///   s(t) = S(t) + b(S(t)) - b(0),   hence   v = S' (1 + b'(S)),
/// which is always on while the vehicle moves and is exactly nothing at rest.
class SpeedProfile {
 public:
  /// What is wrong with event `event`, counted from 0; `events.size()` stands for the stop at the end.
  struct Problem {
    std::size_t event = 0;
    std::string message;
  };

  /// `path_length_m` is where the stop at the end comes to rest. Problems are added to `problems`.
  SpeedProfile(const SpeedPlan& plan, double path_length_m, Waves ripple, std::vector<Problem>& problems);

  /// Driven distance [m] with derivatives by time.
  Jet at(double t_s) const;

  struct Ramp {
    double t_s, planned_m, v_m_s, change_m_s, duration_s;
    double onset_s = 0, abs_m_s2 = 0, abs_hz = 6;
    double end_s() const { return t_s + duration_s; }
    double end_m() const { return planned_m + duration_s * (v_m_s + change_m_s / 2); }
    double end_m_s() const { return v_m_s + change_m_s; }
  };
  /// S(t) with derivatives by time.
  Jet planned(double t_s) const;
  /// The changes of speed in order; the first has no change and stands for the beginning.
  const std::vector<Ramp>& ramps() const { return ramps_; }

 private:
  void add(const SpeedEvent& event, std::size_t index, std::vector<Problem>& problems);
  std::vector<Ramp> ramps_;
  Waves ripple_;  ///< b(S) [m]
  double ripple_at_start_m_ = 0;
};

}  // namespace tarmac::scenes
