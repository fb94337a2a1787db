/// The planned flight of a drone as series of the time.
#pragma once

#include <array>

#include "sim/truth/course.h"
#include "sim/truth/drone.h"
#include "sim/truth/series.h"

namespace tarmac::sim::truth {

using Vector3Series = std::array<Series<4>, 3>;

struct Planned {
  Vector3Series xyz_m;  ///< world
  Series<3> heading;
  Series<4> airborne;  ///< 0 on the ground, 1 at the path's height
};

/// The path's place from the distance, with the fourth derivative that a Jet does not have.
class FlightPlan {
 public:
  /// `ground_m` is the ground's height where the drone stands.
  FlightPlan(const DroneOptions& options, CoursePlan course, double ground_m);
  Planned at(double t_s) const;
  /// From the end of the rest to the path's height.
  static double take_off_s(const TakeOffOptions& options);

 private:
  Series<4> distance(double t_s) const;
  DroneOptions options_;
  CoursePlan course_;
  double ground_m_, lift_off_s_, ripple_at_start_m_;
};

/// Sum of a_k sin(k_k x + phase_k) as a series of x(t).
template <int N>
Series<N> wave_sum(const Waves& waves, const Series<N>& x) {
  Series<N> sum;
  for (const Waves::Wave& w : waves.waves()) {
    Series<N> angle = w.wavenumber * x;
    angle.c[0] += w.phase;
    sum += w.amplitude * sin_cos(angle).sin;
  }
  return sum;
}

}  // namespace tarmac::sim::truth
